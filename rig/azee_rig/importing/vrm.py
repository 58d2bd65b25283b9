"""What a VRM file says about itself: which nodes are bones, and which targets its words move.

VRM 0.x and 1.0 say the same in two ways; both are read, and nothing else of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from azee_rig.importing.container import GltfFile, label
from azee_rig.importing.scene import Target

PERCENT = 100.0
"""Weights of VRM 0.x count to this."""
MOST_WEIGHT = 100.0
"""A bind with a larger weight is none."""
OLD_WORDS = {
    "a": "aa",
    "i": "ih",
    "u": "ou",
    "e": "ee",
    "o": "oh",
    "blink_l": "blinkLeft",
    "blink_r": "blinkRight",
}
"""Words of VRM 0.x that 1.0 has changed."""


def humanoid(file: GltfFile) -> dict[str, int]:
    """Nodes by VRM's names of bones, such as `leftUpperArm`; empty for what is no VRM."""
    new = _extension(file, "VRMC_vrm").get("humanoid", {})
    bones = new.get("humanBones", {}) if isinstance(new, dict) else {}
    if isinstance(bones, dict) and bones:
        rows = [(name, row.get("node")) for name, row in bones.items() if isinstance(row, dict)]
    else:
        old = _extension(file, "VRM").get("humanoid", {})
        listed = old.get("humanBones", []) if isinstance(old, dict) else []
        rows = [
            (label(row.get("bone")), row.get("node"))
            for row in (listed if isinstance(listed, list) else [])
            if isinstance(row, dict)
        ]
    count = len(file.all("nodes"))
    return {
        label(name): node
        for name, node in rows
        if isinstance(node, int) and not isinstance(node, bool) and 0 <= node < count
    }


def expressions(file: GltfFile, targets: Sequence[Target]) -> dict[str, dict[str, float]]:
    """Weights of targets, by name, of each expression."""
    names = {(t.mesh, t.number): t.name for t in targets}
    found: dict[str, dict[str, float]] = {}
    for word, mesh, number, weight in (*_new(file), *_old(file)):
        if (mesh, number) in names:
            found.setdefault(word, {})[names[mesh, number]] = weight
    return found


def _new(file: GltfFile) -> Iterator[tuple[str, int, int, float]]:
    groups = _extension(file, "VRMC_vrm").get("expressions", {})
    for kind in ("preset", "custom"):
        rows = groups.get(kind, {}) if isinstance(groups, dict) else {}
        for word, row in rows.items() if isinstance(rows, dict) else ():
            for bind in _list(row, "morphTargetBinds"):
                node = bind.get("node")
                if isinstance(node, int) and 0 <= node < len(file.all("nodes")):
                    mesh = file.one("nodes", node).get("mesh")
                    yield from _bind(word, {**bind, "mesh": mesh}, 1.0)


def _old(file: GltfFile) -> Iterator[tuple[str, int, int, float]]:
    master = _extension(file, "VRM").get("blendShapeMaster", {})
    for row in _list(master, "blendShapeGroups"):
        word = label(row.get("presetName")).lower()
        if word in ("", "unknown"):
            word = label(row.get("name"))
        for bind in _list(row, "binds"):
            yield from _bind(OLD_WORDS.get(word, word), bind, PERCENT)


def _bind(
    word: str, bind: Mapping[str, Any], whole: float
) -> Iterator[tuple[str, int, int, float]]:
    mesh, number, weight = bind.get("mesh"), bind.get("index"), bind.get("weight", whole)
    sound = isinstance(weight, int | float) and abs(weight) <= MOST_WEIGHT * whole
    if isinstance(mesh, int) and isinstance(number, int) and sound:
        yield word, mesh, number, float(weight) / whole


def _list(row: object, key: str) -> list[dict[str, Any]]:
    found = row.get(key) if isinstance(row, dict) else None
    return [x for x in found if isinstance(x, dict)] if isinstance(found, list) else []


def _extension(file: GltfFile, name: str) -> Mapping[str, Any]:
    extensions = file.document.get("extensions")
    found = extensions.get(name) if isinstance(extensions, dict) else None
    return found if isinstance(found, dict) else {}
