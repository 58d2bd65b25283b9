"""Rests: what the hands do while nothing is asked of them, on every body that ships."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from azee.motion.keys.rest import RESTS, Rest, rest_posture
from azee_rig.load import load_rig
from azee_rig.mirror import mirrored
from azee_rig.rig import Rig
from azee_solver.geometry import Side
from azee_solver.penetration import mesh_penetration

BODIES = ("signer", "child", "heavy", "game")
DEEPEST_M = 2e-3


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("rest", ["folded", "hanging"])
def test_nothing_penetrates_at_rest(body: str, rest: Rest) -> None:
    rig = load_rig(body)
    q = rest_posture(rig, rest, Side.RIGHT)
    c = rig.coordinates
    assert np.all((c.lower <= q) & (q <= c.upper))
    assert [p for p in mesh_penetration(rig, q) if p.depth_m > DEEPEST_M] == []
    still = [
        v for v, name in enumerate(c.names) if name.startswith(("back", "neck", "head", "clav"))
    ]
    assert q[still] == pytest.approx(c.idle[still])


def wrists(rig: Rig, rest: Rest) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """Right and left, relative to the middle of the shoulders, in lengths of an arm."""
    at = rig.chain.frames(rest_posture(rig, rest, Side.RIGHT)).positions
    both = at[[rig.bones[f"palm_{side}"].origin_node for side in "RL"]]
    return np.asarray((both - rig.landmarks.shoulder_middle) / rig.landmarks.arm_m)


@pytest.mark.parametrize("body", BODIES)
def test_folded_hands_lie_on_one_another_before_the_belly_and_arms_hang_at_the_sides(
    body: str,
) -> None:
    rig = load_rig(body)
    q = rest_posture(rig, "folded", Side.RIGHT)
    frames = rig.chain.frames(q)
    strong, weak = (rig.sites[name].point(frames) for name in ("PA_R", "H_BACK_L"))
    assert np.linalg.norm(strong - weak) < 0.18 * rig.landmarks.arm_m
    assert strong[2] > weak[2]
    bend = [np.degrees(q[rig.coordinates.index[f"palm_{side}.flexion"]]) for side in "LR"]
    assert max(map(abs, bend)) < 25.0
    folded, hanging = wrists(rig, "folded"), wrists(rig, "hanging")
    assert (folded[:, 2] > 0.2).all()
    assert (hanging[:, 1] < -0.75).all()
    assert hanging[0, 0] < -0.35 < 0.35 < hanging[1, 0]


def test_ready_is_the_neutral_posture_with_relaxed_fingers(signer: Rig) -> None:
    q, c = rest_posture(signer, "ready", Side.RIGHT), signer.coordinates
    arms = [
        v for v, name in enumerate(c.names) if name.startswith(("arm", "f_arm", "palm", "clav"))
    ]
    assert q[arms] == pytest.approx(c.idle[arms])
    for rest in RESTS:
        q = rest_posture(signer, rest, Side.RIGHT)
        apart = [q[c.index[f"{f}_R_1.deviation"]] for f in ("index", "middle", "ring", "little")]
        assert np.degrees(apart[0] - apart[-1]) < 6.0, "fingers lie together"
        bent = [q[c.index[f"{f}_R_2.flexion"]] for f in ("index", "middle", "ring", "little")]
        assert bent == sorted(bent), "and are more and more bent"


def test_a_left_handed_signer_rests_in_the_mirror(signer: Rig) -> None:
    right = rest_posture(signer, "folded", Side.RIGHT)
    left = rest_posture(signer, "folded", Side.LEFT)
    assert left == pytest.approx(mirrored(signer.coordinates, right), abs=0.01)
    assert not left.flags.writeable
    assert rest_posture(signer, "folded", Side.LEFT) is left, "found once"


@pytest.mark.parametrize("rest", RESTS)
def test_a_body_without_the_sites_has_rests_too(signer: Rig, rest: Rest) -> None:
    rig = replace(signer, sites={}, folder=signer.folder / "elsewhere")
    q = rest_posture(rig, rest, Side.RIGHT)
    assert np.all((rig.coordinates.lower <= q) & (q <= rig.coordinates.upper))
