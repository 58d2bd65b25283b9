"""What a file of motion is, by its suffix and its first bytes: some lie, some have no suffix."""

from __future__ import annotations

from pathlib import Path

LOOKED_AT = 4096
"""Bytes from the start that tell."""
OTHERS = {
    ".fbx": "FBX", ".c3d": "C3D", ".trc": "TRC", ".amc": "AMC", ".asf": "ASF",
    ".dae": "COLLADA", ".usd": "USD", ".usda": "USD", ".usdc": "USD", ".usdz": "USD",
    ".abc": "Alembic", ".blend": "a Blender file", ".vmd": "a MikuMikuDance motion",
    ".json": "JSON", ".mp4": "a film", ".webm": "a film",
}  # fmt: skip
"""Formats of motion that azee does not read, by suffix."""
GLTF = (".glb", ".gltf", ".vrm", ".vrma")
"""Suffixes of files of glTF, whose animations are read."""


def motion_kind(path: Path) -> str:
    """Return "bvh", "clip", "gltf", what else the file is in words, or "" where nothing tells.

    Raises: OSError: it cannot be read.
    """
    with path.open("rb") as file:
        start = file.read(LOOKED_AT)
    suffix = path.suffix.lower()
    if start.startswith((b"Kaydara FBX Binary", b"; FBX")):
        return "FBX"
    if start.startswith(b"glTF") or suffix in GLTF:
        return "gltf"
    if suffix in (".bvh", ".npz"):
        return "bvh" if suffix == ".bvh" else "clip"
    text = start.replace(b"\0", b"").lstrip(b"\xef\xbb\xbf\xff\xfe \t\r\n")
    if text[:9].upper() == b"HIERARCHY":
        return "bvh"
    if start.startswith(b"PK\x03\x04") and suffix not in OTHERS:
        return "clip"
    return OTHERS.get(suffix, "")
