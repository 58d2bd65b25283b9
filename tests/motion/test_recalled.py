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
