"""Reads the table of joint coordinates: limits, idle posture, stiffness."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from azee_rig.build.anatomy import SIDES
from azee_rig.coordinates import Coordinates


def coordinate_names(path: Path) -> tuple[str, ...]:
    """Names in the order of the table: the trunk, then all of the left, then all of the right."""
    return tuple(_rows(path))


def read_coordinates(path: Path, bind: Mapping[str, float]) -> Coordinates:
    """Coordinates of a body whose mesh stands in posture `bind`, radians.

    Limits count from the zero pose, or, where the table says so, from the body's bind posture.
    """
    rows = _rows(path)
    from_bind = np.array([rows[n]["from"] == "bind" for n in rows])
    at_bind = np.array([bind[n] for n in rows])
    start = np.where(from_bind, at_bind, 0.0)

    def radians(column: str) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        return np.radians([float(row[column]) for row in rows.values()])

    return Coordinates(
        names=tuple(rows),
        lower=radians("lower_deg") + start,
        upper=radians("upper_deg") + start,
        idle=radians("idle_deg") + start,
        bind=at_bind,
        stiffness=np.array([float(row["stiffness"]) for row in rows.values()]),
    )


def _rows(path: Path) -> dict[str, Mapping[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        table = list(csv.DictReader(file))
    middle: dict[str, Mapping[str, str]] = {
        row["coordinate"]: row for row in table if "{S}" not in row["coordinate"]
    }
    sided: dict[str, Mapping[str, str]] = {
        row["coordinate"].format(S=side): row
        for side in SIDES
        for row in table
        if "{S}" in row["coordinate"]
    }
    return middle | sided
