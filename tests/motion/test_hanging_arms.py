"""An arm that hangs yields when the trunk leans to its side, and only then."""

from __future__ import annotations

import math

import numpy as np
import pytest

from azee.compilation import perform
from azee.lang.program import evaluate_expression
from azee.motion.keys.rest import rest_posture
from azee.motion.overlay.hanging_arms import yielding_to_leans
from azee_rig.load import load_rig, shipped_rigs
from azee_rig.rig import Rig
from azee_solver.geometry import Side

MILLIMETRE = 1e-3


@pytest.mark.parametrize("side", ["L", "R"])
def test_the_arm_towards_the_lean_goes_out(side: str, signer: Rig) -> None:
    rest = rest_posture(signer, "hanging", Side.RIGHT)
    index = signer.coordinates.index
    lean = index["back_1.lateral"]
    q = np.tile(rest, (2, 1))
    q[1, lean] += math.radians(6.0 if side == "L" else -6.0)
    found = np.degrees(yielding_to_leans(signer, q, rest))
    np.testing.assert_allclose(found[0], 0.0, atol=1e-9)
    other = "R" if side == "L" else "L"
    assert 1.0 < found[1, index[f"arm_{side}.abduction"]] < 7.0
    assert abs(found[1, index[f"arm_{other}.abduction"]]) < 0.3
    moved = q + np.radians(found)
    hand = signer.bones[f"palm_{side}"].node
    x = [signer.chain.frames(posture).positions[hand, 0] for posture in moved]
    assert abs(x[1] - x[0]) < 4 * MILLIMETRE
    found[1, [index[f"arm_{s}.abduction"] for s in "LR"]] = 0.0
    assert not found.any()


def test_a_raised_arm_stays_where_it_is(signer: Rig) -> None:
    rest = rest_posture(signer, "hanging", Side.RIGHT)
    q = rest[None].copy()
    q[0, signer.coordinates.index["back_1.lateral"]] += math.radians(6.0)
    q[0, signer.coordinates.index["arm_L.flexion"]] += math.radians(45.0)
    found = np.degrees(yielding_to_leans(signer, q, rest))
    assert abs(found[0, signer.coordinates.index["arm_L.abduction"]]) < 0.01


@pytest.mark.long
@pytest.mark.parametrize(
    "body",
    ["signer", *(pytest.param(b, marks=pytest.mark.slow) for b in shipped_rigs() if b != "signer")],
)
@pytest.mark.parametrize("text", [":about-ref(:hier, ^Lssp)", ":about-ref(:Irak, ^Rssp)"])
def test_no_hand_enters_the_hip_towards_which_the_trunk_leans(text: str, body: str) -> None:
    report = perform(evaluate_expression(text).score, load_rig(body)).report
    assert [c.subject for c in report.constraints if c.missed] == []
    deep = [p for p in report.clip_penetration if not p.intended and p.depth_m > 3 * MILLIMETRE]
    assert deep == []
