"""How deep a thumb is in fingers, on the skin, for many postures at once."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_rig.skin_part import SkinPart
from azee_solver.digit_skin import digit_skin
from azee_solver.penetration import mesh_penetration

BODIES = ("signer", "child", "heavy", "game")
FINGERS = ("index", "middle", "ring", "little")


THUMB = ("1.flexion", "1.abduction", "1.roll", "2.flexion", "3.flexion")
ON_THUMB = ((14, 100, 45), (28, 100, 47), (15, 100, 50), (20, 97, 48), (-32, 35, 2, 54, 52))
CLOSED = ((73, 84, 38), (76, 89, 42), (77, 86, 42), (5, 8, 5), (-52, 59, -15, 60, 25))
"""Joints of index, middle, ring and little finger and of the thumb, degrees."""


def closing(rig: Rig, side: str) -> NDArray[np.float64]:
    """Fingertips that close from the thumb past it, (T, V)."""
    c = rig.coordinates
    ends = []
    for *fingers, thumb in (ON_THUMB, CLOSED):
        q = c.idle.copy()
        for finger, angles in zip(FINGERS, fingers, strict=True):
            for phalanx, angle in enumerate(angles, start=1):
                q[c.index[f"{finger}_{side}_{phalanx}.flexion"]] = math.radians(angle)
        for name, angle in zip(THUMB, thumb, strict=True):
            q[c.index[f"thumb_{side}_{name}"]] = math.radians(angle)
        ends.append(np.clip(q, c.lower, c.upper))
    first, last = ends
    return np.linspace(first, last, 9)


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("side", ["L", "R"])
def test_the_depth_is_that_of_the_skin(body: str, side: str) -> None:
    rig = load_rig(body)
    q, skin = closing(rig, side), digit_skin(rig, side)
    found = skin.depths(q)
    assert found.max() > 0.002
    for posture, depths in zip(q, found, strict=True):
        exact = dict.fromkeys(skin.fingers, 0.0)
        for each in mesh_penetration(rig, posture, (), {*skin.fingers, f"thumb_{side}"}):
            finger = each.limb if each.limb in exact else each.body
            if f"thumb_{side}" in (each.limb, each.body):
                exact[finger] = max(exact[finger], each.depth_m)
        assert depths == pytest.approx(list(exact.values()), abs=0.0012)


def test_only_where_is_asked_for_is_looked() -> None:
    rig = load_rig()
    q, skin = closing(rig, "R"), digit_skin(rig, "R")
    everywhere = skin.depths(q)
    near = np.zeros(everywhere.shape, dtype=np.bool_)
    t, k = np.unravel_index(int(everywhere.argmax()), everywhere.shape)
    near[t, k] = True
    assert skin.depths(q, near) == pytest.approx(np.where(near, everywhere, 0.0), abs=0)


@pytest.mark.parametrize("body", BODIES)
def test_a_part_of_the_skin_is_as_in_the_whole(body: str) -> None:
    rig = load_rig(body)
    q = closing(rig, "R")
    whole = np.stack([rig.skin(rig.pose(posture)) for posture in q])
    rows = np.flatnonzero(np.any(np.abs(whole[-1] - whole[0]) > 0.005, axis=1))
    part = SkinPart(rig, rows).skin(q, rig.chain.frames(q).rotations)
    between = part - part[:, :1]
    assert between == pytest.approx(whole[:, rows] - whole[:, rows[:1]], abs=1e-9)
