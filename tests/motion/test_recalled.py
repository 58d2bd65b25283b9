"""Points as they were, and directions on their way, in the movement of a body."""

from __future__ import annotations

import math

import numpy as np
import pytest

from azee.animation import Animation, animate
from azee.lang.program import evaluate_expression
from azee_grammar.diagnostic import AZeeError
from azee_rig.rig import Rig
from azee_solver.evaluate import evaluator
from azee_solver.geometry import Side, Site
from azee_solver.outcome import Outcome

PALM = Site("PA", Side.STRONG)
CHAIN = """\
sync
    'A
    key .3 (place @PA(s) @ST(s) 'dist .1)
    'B
    key .3 (shift @PA(s) (scale ^fwd .15) 'from 'A)
    'start 'A:end:.4
    'C
    key .3 (shift @PA(s) (scale ^up .1) 'from 'B)
    'start 'B:end:.4
"""
TURN = """\
sync
    'A
    key .3
        cstr
            place @WR(s) (point -.15 -.2 .3)
            orient 'nrm !palm(s) 'along ^down
    'T
    key .6
        cstr
            turning 'nrm !palm(s)
            place @WR(s) (point -.15 -.2 .3)
    'start 'A:end
    'B
    key .3
        cstr
            place @WR(s) (point -.15 -.2 .3)
            orient 'nrm !palm(s) 'along (in s)
    'start 'T:end
"""

SWEEP = """\
sync
    'A
    key .2
        cstr
            place @PA(s) (point -.25 -.1 .35)
            orient 'dir !palm(s) 'along {start_dir} 'within 15
            orient 'nrm !palm(s) 'along {start_nrm} 'within 15
    'T
    key .6
        cstr
            turning 'dir !palm(s)
            turning 'nrm !palm(s)
            place @PA(s) (point -.25 -.1 .35) 'within .02
    'start 'A:end
    'B
    key .2
        cstr
            place @PA(s) (point -.25 -.1 .35)
            orient 'dir !palm(s) 'along {end_dir} 'within 15
            orient 'nrm !palm(s) 'along {end_nrm} 'within 15
    'start 'T:end
"""


def made(text: str, rig: Rig, **options: float) -> Animation:
    return animate(evaluate_expression(text).score, rig, fps=60.0, life=False, **options)  # type: ignore[arg-type]


def middle(animation: Animation, block: str) -> int:
    """Return the frame in the middle of a block."""
    spans = {
        c.path: (c.start_s, c.end_s) for c in animation.report.constraints if c.path == (block,)
    }
    start, end = spans[block,]
    time = animation.lead_s + 0.5 * (start + end)
    return int(np.abs(animation.clip.times - time).argmin())


@pytest.mark.parametrize("mode", ["tracks", "flat"])
def test_a_shift_leads_on_from_where_the_site_was(signer: Rig, mode: str) -> None:
    found = made(CHAIN, signer, mode=mode)  # type: ignore[arg-type]
    assert all(c.met for c in found.report.constraints), found.report.constraints
    measure = evaluator(signer, Side.RIGHT)
    frames = signer.chain.frames(found.clip.coordinates)
    palm = measure.site(PALM, frames)
    a, b, c = (palm[middle(found, block)] for block in "ABC")
    np.testing.assert_allclose(b - a, [0.0, 0.0, 0.15 * measure.scale], atol=0.004)
    np.testing.assert_allclose(c - b, [0.0, 0.1 * measure.scale, 0.0], atol=0.004)


def test_the_report_names_the_point_as_the_text_does(signer: Rig) -> None:
    targets = [c.target for c in made(CHAIN, signer).report.constraints]
    assert targets[1].startswith("vtranslate(was('A, @PA(s)), ")


def test_a_block_around_may_be_named(signer: Rig) -> None:
    text = """\
sync
    'A
    key .3 (place @PA(s) @ST(s) 'dist .1)
    'B
    seq (list (blank .2) (key .3 (shift @PA(s) (scale ^fwd .15) 'from 'A)))
    'start 'A:end:.3
"""
    assert all(c.met for c in made(text, signer).report.constraints)


@pytest.mark.parametrize("block", ["B", "Z"])
def test_a_block_that_is_not_there_is_named(block: str) -> None:
    text = CHAIN.replace("(scale ^fwd .15) 'from 'A", f"(scale ^fwd .15) 'from '{block}")
    with pytest.raises(AZeeError, match=f"there is no block `{block}`"):
        evaluate_expression(text)


def test_blocks_that_wait_for_each_other_stay_unmet(signer: Rig) -> None:
    text = """\
sync
    'A
    key .3 (shift @PA(s) (scale ^fwd .1) 'from 'B)
    'B
    key .3 (shift @PA(s) (scale ^fwd .1) 'from 'A)
    'start 'A:end:.3
"""
    assert not any(c.met for c in made(text, signer).report.constraints)


def test_a_turn_goes_on_the_shorter_arc_between_its_ends(signer: Rig) -> None:
    found = made(TURN, signer)
    assert all(c.met for c in found.report.constraints), found.report.constraints
    frames = signer.chain.frames(found.clip.coordinates)
    normal = frames.rotations[:, signer.bones["palm_R"].node, :, 2]
    (turn,) = [c for c in found.report.constraints if "swing" in c.target]
    start, end = (found.lead_s + t for t in (turn.start_s, turn.end_s))
    inside = normal[(found.clip.times >= start) & (found.clip.times <= end)]
    assert len(inside) > 30
    off_plane = np.degrees(np.arcsin(np.abs(inside[:, 2])))
    assert off_plane.max() < 1.0
    halfway = inside[len(inside) // 2]
    assert math.degrees(math.atan2(halfway[0], -halfway[1])) == pytest.approx(45, abs=6)


def test_a_turn_without_ends_is_named() -> None:
    with pytest.raises(AZeeError, match="no block orients `'nrm !palm"):
        evaluate_expression("key 1 (turning 'nrm !palm(s))")


@pytest.mark.parametrize(
    ("start_dir", "start_nrm", "end_dir", "end_nrm"),
    [
        # Each on its shorter arc, both would point the opposite ways half-way.
        ("(vsum (in s) ^down)", "^back", "(vsum (scale (out s) .414) ^fwd)", "^up"),
        # Half a circle, which a forearm can do in one of two ways only.
        ("(vsum (in s) ^down)", "(vsum (scale (out s) .707) (vec 0 -.707 1))", "^fwd", "(in s)"),
    ],
)
def test_a_hand_turns_as_one_and_the_way_that_its_joints_can(
    start_dir: str, start_nrm: str, end_dir: str, end_nrm: str, signer: Rig
) -> None:
    text = SWEEP.format(start_dir=start_dir, start_nrm=start_nrm, end_dir=end_dir, end_nrm=end_nrm)
    found = made(text, signer)
    assert all(c.outcome is not Outcome.MISSED for c in found.report.constraints)
    fastest = found.report.likeness.arm_speed_deg_s
    assert fastest is not None
    assert fastest.value < 600.0
