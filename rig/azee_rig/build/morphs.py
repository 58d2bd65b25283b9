"""Reads the tables of AZee's morphs: skeletal presets and facial morphs."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path

from azee_rig.build.anatomy import SIDES

RENAMED = {"palm_l_closed": "palm_closed_L", "palm_r_closed": "palm_closed_R"}
"""Morphs whose published name has the side inside it."""


def read_skeletal_morphs(path: Path, coordinates: Sequence[str]) -> dict[str, dict[str, float]]:
    """Return radians per coordinate at weight 1; a name without its side moves both sides.

    The table is in degrees, counted from the zero pose, with `{S}` for the side.
    Raises: ValueError: a row names no coordinate of the rig.
    """
    table: Mapping[str, Mapping[str, float]] = json.loads(path.read_text(encoding="utf-8"))
    morphs: dict[str, dict[str, float]] = {}
    for name, moves in table.items():
        both: dict[str, float] = {}
        for side in SIDES:
            one = {c.format(S=side): math.radians(angle) for c, angle in moves.items()}
            unknown = one.keys() - set(coordinates)
            if unknown:
                raise ValueError(f"morph {name} moves {', '.join(sorted(unknown))}")
            both |= one
            if any("{S}" in c for c in moves):
                morphs[f"{name}_{side}"] = one
        morphs[name] = both
    return morphs | {name: morphs[given] for name, given in RENAMED.items()}


def read_face_morphs(
    path: Path, units: Sequence[str]
) -> tuple[dict[str, dict[str, float]], dict[str, str]]:
    """Return weights per face unit at weight 1, and reasons for morphs that cannot be shown.

    Raises: ValueError: a row names no unit of the face.
    """
    table = json.loads(path.read_text(encoding="utf-8"))
    for name, weights in table["expressed"].items():
        unknown = weights.keys() - set(units)
        if unknown:
            raise ValueError(f"morph {name} uses {', '.join(sorted(unknown))}")
    return table["expressed"], table["not_expressed"]


def read_lids(path: Path, units: Sequence[str]) -> dict[str, tuple[str, float]]:
    """Read how lids follow the turn of an eye: per face unit a coordinate and weight per radian.

    Raises: ValueError: a row names no unit of the face.
    """
    table: Mapping[str, tuple[str, float]] = json.loads(path.read_text(encoding="utf-8"))
    lids = {
        unit.format(Side=name): (coordinate.format(S=side), weight)
        for unit, (coordinate, weight) in table.items()
        for side, name in zip(SIDES, ("Left", "Right"), strict=True)
    }
    unknown = lids.keys() - set(units)
    if unknown:
        raise ValueError(f"lids use {', '.join(sorted(unknown))}")
    return lids
