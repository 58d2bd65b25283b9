"""Maps a body's morph targets onto the face units that AZee's morphs are made of.

Morphs are tables over the signer's units (data/face_morphs.json). Another face calls the same
units otherwise, has both sides in one target, or has none: data/face_units.json tells.
"""

from __future__ import annotations

import json
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee_rig.importing.scene import Target

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Weights = dict[str, float]
"""Weights of targets by name."""
Table = Mapping[str, Any]
"""face_morphs.json: `expressed` weights of units by morph, `not_expressed` reasons by morph."""

ENOUGH = 0.5
"""Share of a morph's units that a face must have to show it."""
SURE = 6
"""A shorter end of a name may well be something else."""
_BEGINS = re.compile(r"(?:(?<=[^A-Za-z])|^)[A-Za-z]|(?<=[a-z0-9])[A-Z]")
_SIDE = re.compile(r"[\W_](l|r)$", re.IGNORECASE)


@dataclass(frozen=True, eq=False)
class FaceMap:
    """What a face shows.

    expressed: AZee morphs as weights of targets. unexpressed: the others, with the reason.
    lids: targets that follow the eyes, as `Rig.lids`. partly: morphs that lack some units.
    """

    expressed: Mapping[str, Weights]
    unexpressed: Mapping[str, str]
    lids: Mapping[str, tuple[str, float]]
    partly: tuple[str, ...]

    @property
    def targets(self) -> tuple[str, ...]:
        """Targets that any morph or lid uses, in the order of first use."""
        used = [t for weights in self.expressed.values() for t in weights]
        return tuple(dict.fromkeys([*used, *self.lids]))


@dataclass(frozen=True, eq=False)
class _Face:
    """What of the signer's units a face has: single ones, and pairs of sides."""

    single: Mapping[str, Weights]
    both: Mapping[tuple[str, str], Weights]
    near: Mapping[str, Mapping[str, float]]

    def shown(self, units: Mapping[str, float]) -> tuple[Weights, float]:
        """Weights of targets that show a set of units, and the share of it that they show."""
        found: Weights = {}
        left = dict(units)
        have = 0.0
        for (a, b), targets in self.both.items():
            if a in left and left[a] == left.get(b) and not (a in self.single and b in self.single):
                _add(found, targets, left[a])
                have += 2 * abs(left.pop(a))
                left.pop(b)
        for unit, weight in left.items():
            if unit in self.single:
                _add(found, self.single[unit], weight)
                have += abs(weight)
            for near, share in self.near.get(unit, {}).items():
                if unit not in self.single and near in self.single and near not in units:
                    _add(found, self.single[near], weight * share)
                    have += abs(weight * share)
        total = sum(abs(w) for w in units.values())
        return found, min(1.0, have / total) if total else 0.0


def _add(found: Weights, targets: Weights, weight: float) -> None:
    for name, share in targets.items():
        found[name] = round(found.get(name, 0.0) + weight * share, 6)


def plain(name: str) -> str:
    """Return a name as it is compared: `eyeBlink_L` and `EyeBlinkLeft` are one."""
    name = name.removeprefix("mh_")
    name = _SIDE.sub(lambda m: "left" if m[1] in "lL" else "right", name.strip())
    return re.sub(r"[^a-z0-9]", "", name.split(".")[-1].lower())


def _word(name: str, words: Collection[str]) -> str:
    """Return what is known of a target's name: `Anna_Face_jawOpen` is `jawopen`."""
    whole = plain(name)
    if whole in words:
        return whole
    ends = [m.start() for m in _BEGINS.finditer(name)]
    ended = (plain(name[start:]) for start in ends[1:])
    return next((word for word in ended if word in words and len(word) >= SURE), whole)


def map_face(
    targets: Sequence[str],
    expressions: Mapping[str, Weights],
    data: Path,
    table: Table,
    lids: Mapping[str, tuple[str, float]],
) -> FaceMap:
    """Map a face.

    Args: targets: names of the morph targets. expressions: what a VRM calls, by its own words,
        such as `aa`. table: face_morphs.json. lids: the signer's.
    """
    face = _read(targets, expressions, data / "face_units.json", table, lids)
    expressed: dict[str, Weights] = {}
    unexpressed: dict[str, str] = dict(table["not_expressed"])
    partly = []
    for morph, units in table["expressed"].items():
        found, share = face.shown(units)
        if found and share >= ENOUGH:
            expressed[morph] = found
            if share < 0.999:
                partly.append(morph)
        else:
            absent = [u for u in units if u not in face.single]
            unexpressed[morph] = f"this body's face has no morph target for {', '.join(absent)}"
    moved = {
        target: (coordinate, weight * share)
        for unit, (coordinate, weight) in lids.items()
        for target, share in face.single.get(unit, {}).items()
    }
    return FaceMap(expressed, unexpressed, moved, tuple(partly))


def _read(
    targets: Sequence[str],
    expressions: Mapping[str, Weights],
    path: Path,
    table: Table,
    lids: Mapping[str, tuple[str, float]],
) -> _Face:
    known = json.loads(path.read_text(encoding="utf-8"))
    units = {u for weights in table["expressed"].values() for u in weights} | set(lids)
    units |= {u for near in known["near"].values() for u in near} | set(known["same"])
    words = {plain(word) for word in (*units, *known["pairs"])}
    words |= {word for aliases in known["same"].values() for word in aliases}
    called: dict[str, Weights] = {}
    for name in targets:
        called.setdefault(_word(name, words), {name: 1.0})
    # What a VRM declares counts more than what a target happens to be called.
    called |= {plain(word): dict(weights) for word, weights in expressions.items() if weights}
    single: dict[str, Weights] = {}
    for unit in sorted(units):
        # Its own name counts before what others call something like it.
        names = [plain(unit), *known["same"].get(unit, ())]
        named = next((word for word in names if word in called), None)
        if named is not None:
            single[unit] = called[named]
    both = {
        (pair[0], pair[1]): called[word] for word, pair in known["pairs"].items() if word in called
    }
    return _Face(single, both, known["near"])


@dataclass(frozen=True, eq=False)
class Units:
    """Face units as a mesh packs them: see `BodyMesh`."""

    names: tuple[str, ...]
    start: Ints
    rows: Ints
    deltas: Floats


def pack_units(targets: Sequence[Target], names: Sequence[str]) -> Units:
    """Join the targets of each name, from all meshes. Their deltas are the mesh's own metres."""
    rows: list[Ints] = []
    deltas: list[Floats] = []
    for name in names:
        own = [t for t in targets if t.name == name]
        where = np.concatenate([t.rows for t in own]) if own else np.zeros(0, np.int64)
        moved = np.concatenate([t.deltas for t in own]) if own else np.zeros((0, 3))
        order = np.argsort(where, kind="stable")
        rows.append(where[order])
        deltas.append(moved[order])
    return Units(
        tuple(names),
        np.cumsum([0, *(len(r) for r in rows)]),
        np.concatenate(rows) if rows else np.zeros(0, np.int64),
        np.concatenate(deltas) if deltas else np.zeros((0, 3)),
    )
