"""Object code that a wheel brings along, compiled when the wheel was built.

`packaging/kernels.py` writes it into a folder of the package: a file for each kernel, and a
manifest that tells what it runs on, which sources it was made from and by which versions. Code is
taken from there only if this machine has every feature of the processor that it may use, if the
sources are the same byte for byte, and if its digest is right, which also covers the rest of the
manifest. Otherwise it is as if it were not there.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from azee_rig.object_code import Target, host

FOLDER = Path(__file__).parent / "compiled"
"""Where a wheel for a platform has it."""
MANIFEST = "manifest.json"
FORMAT = 1


@dataclass(frozen=True, slots=True)
class Entry:
    """What a manifest tells of a kernel: SHA-256 of its sources, and of its code with its target.

    Both in hexadecimal digits.
    """

    sources: str
    digest: str


@dataclass(frozen=True, slots=True)
class Manifest:
    """What a folder of object code holds. kernels: by module and name, `package.module.name`."""

    target: Target
    kernels: Mapping[str, Entry]


def digest(target: Target, name: str, sources: str, code: bytes) -> str:
    """Return the SHA-256 of a kernel's code and of all that it is chosen by."""
    told = [FORMAT, target.triple, target.cpu, sorted(target.features), name, sources]
    return hashlib.sha256(json.dumps(told).encode() + b"\0" + code).hexdigest()


def brought(name: str, sources: str) -> bytes | None:
    """Return the object code of a kernel, if the wheel brought some that is right for this machine.

    Args: name: its module and name. sources: SHA-256 of its sources, in hexadecimal digits.
    Raises: Unkept: LLVM cannot be asked what this machine is.
    """
    manifest = _manifest(FOLDER)
    entry = manifest.kernels.get(name) if manifest else None
    if manifest is None or entry is None or entry.sources != sources:
        return None
    if not manifest.target.runs_on(host()):
        return None
    try:
        found = (FOLDER / file_name(name)).read_bytes()
    except OSError:
        return None
    return found if digest(manifest.target, name, sources, found) == entry.digest else None


def file_name(name: str) -> str:
    """Return the name of the file with a kernel's code."""
    return f"{name}.o"


@lru_cache(maxsize=1)
def _manifest(folder: Path) -> Manifest | None:
    """Return the manifest of a folder; nothing if there is none or if it is damaged."""
    try:
        read = json.loads((folder / MANIFEST).read_bytes())
        return _understood(read) if read["format"] == FORMAT else None
    except (OSError, ValueError, LookupError, TypeError):
        return None


def _understood(read: Any) -> Manifest:
    target = read["target"]
    features = frozenset(map(str, target["features"]))
    return Manifest(
        Target(str(target["triple"]), str(target["cpu"]), features),
        {
            str(name): Entry(str(entry["sources"]), str(entry["digest"]))
            for name, entry in dict(read["kernels"]).items()
        },
    )


def write(
    folder: Path,
    target: Target,
    made: Mapping[str, tuple[str, bytes]],
    made_by: Mapping[str, str],
) -> None:
    """Write object code and its manifest into an empty folder.

    Args: made: SHA-256 of the sources and object code of each kernel, by module and name. made_by:
    versions of what compiled them, for the reader.
    """
    kernels = {}
    for name, (sources, found) in made.items():
        (folder / file_name(name)).write_bytes(found)
        kernels[name] = {"sources": sources, "digest": digest(target, name, sources, found)}
    document = {
        "format": FORMAT,
        "target": {
            "triple": target.triple,
            "cpu": target.cpu,
            "features": sorted(target.features),
        },
        "made_by": dict(made_by),
        "kernels": kernels,
    }
    text = json.dumps(document, indent=2) + "\n"
    (folder / MANIFEST).write_text(text, encoding="utf-8")
