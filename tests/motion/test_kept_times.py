"""Times that performance keeps: of fixed parts and accents, in exact timing, at a tempo."""

from __future__ import annotations

import math

import pytest
from timed_scores import (
    FAR,
    LEFT,
    NEAR,
    RIGHT,
    SHAKE,
    UP,
    F,
    S,
    block,
    inside,
    largest,
    played,
    rig,
    sync,
    times,
    turned,
)

from azee.animation import animate
from azee.motion.timing.accents import is_accent
from azee.score.interval import Interval
from azee.score.score import Block, Group, Hold, Score, leaves
from azee_solver.constraint import (
    Morph,
    Rotate,
    Trill,
)
from azee_solver.evaluate import evaluator
from azee_solver.geometry import Bone, Side


def test_exact_timing_keeps_the_times_of_the_text() -> None:
    exact = played(FAR, "exact")
    assert exact.score is FAR
    assert exact.report.timing == "exact"
    assert exact.report.stretched == ()
    starts = {c.path: c.start_s for c in exact.report.constraints}
    assert starts == {("A",): 0.0, ("B",): 0.6}


def test_flat_mode_is_exact_unless_asked_otherwise() -> None:
    assert animate(FAR, rig(), fps=10, mode="flat").score == FAR
    performed = animate(FAR, rig(), fps=10, mode="flat", timing="performed")
    assert performed.score.duration > FAR.duration


def test_fixed_parts_keep_their_length() -> None:
    fixed = Group(FAR.duration, blocks=FAR.blocks, fixed=True)
    score = sync(inside("F", "0", fixed), block("C", "1.2", ".4", LEFT))
    animation = played(score)
    assert isinstance(animation.score, Group)
    assert animation.score.block("F").score == fixed
    assert {(s.way.source, s.way.target) for s in animation.report.stretched} == {
        (("F", "B"), ("C",))
    }


def test_a_head_shake_keeps_its_clock_and_its_start() -> None:
    score = sync(*FAR.blocks, inside("SHAKE", ".5", SHAKE))
    animation = played(score)
    assert isinstance(animation.score, Group)
    assert animation.score.duration > score.duration
    shaken = animation.score.block("SHAKE")
    assert shaken.score == SHAKE
    assert shaken.interval_in_parent.start > F(".5")


def test_a_nod_that_ends_a_group_ends_it_when_it_is_done() -> None:
    nod = sync(block("A", "0", ".1", turned(5)), block("B", ".4", ".7", turned(-5)))
    inner = sync(*FAR.blocks[:1], inside("NOD", ".3", nod))
    score = sync(inside("IN", "0", inner), *FAR.blocks[1:])
    performed = played(score).score
    for leaf in leaves(performed):
        for group in leaf.parents:
            assert group.duration == max(b.interval_in_parent.end for b in group.blocks)
            for b in group.blocks:
                assert b.interval_in_parent.duration == b.score.duration


@pytest.mark.parametrize(
    ("score", "expected"),
    [
        (SHAKE, True),
        (sync(inside("1", "0", SHAKE), block("2", ".5", ".1", Morph("AU1", None, 0.5))), True),
        (sync(block("A", "0", "1", Trill(Bone("head"), UP, 0.1, 3.0))), True),
        (sync(block("A", "0", "1", Rotate(Bone("back_1"), UP, 0.1))), True),
        (sync(block("A", "0", "1")), False),
        (block("A", "0", "1", turned(5)).score, False),
        (sync(block("A", "0", "1", turned(5), LEFT)), False),
        (sync(block("A", "0", "1", Rotate(Bone("palm", S), UP, 0.1))), False),
        (
            sync(
                block("A", "0", "1", turned(5)),
                Block("H", Interval(F(1), F(2)), Hold(F(1), block="A", channels=("head",))),
            ),
            False,
        ),
    ],
)  # fmt: skip
def test_accents_are_groups_of_turns_of_head_and_trunk_and_of_the_face(
    score: Score, *, expected: bool
) -> None:
    assert is_accent(score, evaluator(rig(), Side.RIGHT).binding) is expected


def test_tempo_scales_all_but_what_is_fixed() -> None:
    score = sync(block("A", "0", ".4", RIGHT), block("B", ".6", ".4", NEAR))
    assert played(score, "exact", 2.0).score.duration == F("1/2")
    fixed = Group(F(1), blocks=score.blocks, fixed=True)
    mixed = sync(inside("F", "0", fixed), block("C", "1.5", ".5", RIGHT))
    assert times(played(mixed, "exact", 0.5).score) == {
        "F/A": (0.0, 0.4), "F/B": (0.6, 1.0), "C": (2.0, 3.0),
    }  # fmt: skip
    assert played(score, "exact", 2.0).report.tempo == 2.0


def test_at_a_fast_tempo_ways_still_get_their_time() -> None:
    assert largest(played(FAR, None, 3.0))[0] < 2.1


@pytest.mark.parametrize("tempo", [0.0, -1.0, math.inf, math.nan])
def test_a_tempo_is_a_factor(tempo: float) -> None:
    with pytest.raises(ValueError, match="times as fast"):
        animate(FAR, rig(), tempo=tempo)


def test_an_unknown_timing_is_told() -> None:
    with pytest.raises(ValueError, match="there is no timing 'loose'; the timings are: performed"):
        animate(FAR, rig(), timing="loose")  # type: ignore[arg-type]
