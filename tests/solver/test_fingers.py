"""Fingers beside, across and apart from each other, on the bodies that ship, by their skin."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from test_comfort import run
from tree_sign import S

from azee_rig.load import load_rig, shipped_rigs
from azee_rig.rig import Rig
from azee_solver.constraint import Constraint, Morph
from azee_solver.penetration import mesh_penetration

FINGERS = ("index", "middle", "ring", "little")
CLOSED = {f"{f}_{kind}": 1.0 for f in ("ring", "little") for kind in ("bend", "hook")}
STRAIGHT = {f"{f}_{kind}": 0.0 for f in FINGERS for kind in ("bend", "hook")}
TOUCHING_M, DEEPEST_M = 0.004, 0.003
"""Vertices of the hands are 3 mm apart, so that skins that touch have some no farther than 4 mm."""


def shown(rig: Rig, **weights: float) -> NDArray[np.float64]:
    report = run(rig, *[Morph(name, S, weight) for name, weight in weights.items()])
    assert report.met, [(c.kind, c.residual, c.reason) for c in report.constraints if not c.met]
    return report.coordinates


def degrees(rig: Rig, q: NDArray[np.float64], name: str) -> float:
    return math.degrees(q[rig.coordinates.index[name]])


def outer_skin(rig: Rig, q: NDArray[np.float64], finger: str) -> NDArray[np.float64]:
    """Vertices of a finger's two outer phalanges, (n, 3)."""
    vertices = rig.skin(rig.pose(q))
    capsules = rig.capsules
    frames = rig.chain.frames(q)
    found = []
    for phalanx in (2, 3):
        i = capsules.names.index(f"{finger}_R_{phalanx}")
        node = capsules.node[i]
        a, b = (
            frames.positions[node] + frames.rotations[node] @ end[i]
            for end in (capsules.a, capsules.b)
        )
        along = (vertices - a) @ (b - a) / ((b - a) @ (b - a))
        away = np.linalg.norm(vertices - a - np.clip(along, 0, 1)[:, None] * (b - a), axis=1)
        near = (along > 0.1) & (along < 0.95) & (away < 1.25 * capsules.radius[i])
        found.append(vertices[near])
    return np.vstack(found)


def gap_m(rig: Rig, q: NDArray[np.float64], one: str, other: str) -> float:
    a, b = outer_skin(rig, q, one), outer_skin(rig, q, other)
    return float(np.linalg.norm(a[:, None] - b[None], axis=-1).min())


def deepest_m(rig: Rig, q: NDArray[np.float64]) -> float:
    fingers = tuple(f"{finger}_R" for finger in FINGERS)
    found = (p for p in mesh_penetration(rig, q) if p.limb in fingers and p.body in fingers)
    return max((p.depth_m for p in found), default=0.0)


@pytest.mark.parametrize("body", shipped_rigs())
def test_fingers_together_touch_and_do_not_enter_each_other(body: str) -> None:
    rig = load_rig(body)
    q = shown(rig, fingers_together=1.0, **STRAIGHT)
    for one, other in pairwise(FINGERS):
        assert gap_m(rig, q, one, other) < TOUCHING_M, (one, other)
    assert deepest_m(rig, q) < DEEPEST_M


def test_without_it_straight_fingers_stand_apart(signer: Rig) -> None:
    q = shown(signer, **STRAIGHT)
    assert gap_m(signer, q, "index", "middle") > TOUCHING_M


@pytest.mark.parametrize("body", shipped_rigs())
def test_crossed_fingers_lie_on_each_other(body: str) -> None:
    """Seen from the back the middle finger's tip is beyond the index, on the thumb's side."""
    rig = load_rig(body)
    q = shown(rig, fingers_crossed=1.0, **(STRAIGHT | CLOSED))
    frames = rig.chain.frames(q)
    palm = frames.rotations[rig.bones["palm_R"].node]
    index, middle = (rig.sites[f"{tip}_TIP_R"].point(frames) for tip in "IM")
    thumbwards = (palm.T @ (middle - index))[0]
    apart = shown(rig, **(STRAIGHT | CLOSED))
    before = rig.chain.frames(apart)
    index, middle = (rig.sites[f"{tip}_TIP_R"].point(before) for tip in "IM")
    was = (before.rotations[rig.bones["palm_R"].node].T @ (middle - index))[0]
    assert np.sign(thumbwards) == -np.sign(was)
    beside, joints = (
        frames.positions[rig.bones[f"index_R_{k}"].node]
        - frames.positions[rig.bones[f"middle_R_{k}"].node]
        for k in (1, 3)
    )
    tips = rig.sites["M_TIP_R"].point(frames) - rig.sites["I_TIP_R"].point(frames)
    assert tips @ beside > 0.45 * (beside @ beside)  # as people's, along the line of the knuckles
    assert -(palm.T @ joints)[2] > 0.004  # in front of the index, on the palm's side
    assert gap_m(rig, q, "index", "middle") < 2 * TOUCHING_M
    assert deepest_m(rig, q) < DEEPEST_M


@pytest.mark.parametrize("finger", FINGERS)
@pytest.mark.parametrize("weight", [-0.25, 0.4, 1.0])
def test_a_finger_deviates_by_its_weight(signer: Rig, finger: str, weight: float) -> None:
    full = {"index": 15.0, "middle": 14.0, "ring": -16.0, "little": -34.0}[finger]
    morph: Constraint = Morph(f"{finger}_spread", S, weight)
    found = degrees(signer, run(signer, morph).coordinates, f"{finger}_R_1.deviation")
    assert found == pytest.approx(weight * full, abs=0.5)


def test_bent_fingers_are_not_rolled(signer: Rig) -> None:
    bent = {f"{f}_bend": 1.0 for f in FINGERS}
    q = shown(signer, fingers_together=1.0, **bent)
    assert all(abs(degrees(signer, q, f"{f}_R_1.deviation")) < 4 for f in FINGERS)
