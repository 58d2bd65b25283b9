"""Ways that are gone again, and how far each differs from the one before."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from movements import ARM_R, drawn, moves, span, still, then

from azee.quality.repetitions import repetitions
from azee.quality.task_spans import TaskSpan
from azee_rig.rig import Rig
from azee_solver.constraint import Place, Transpath
from azee_solver.geometry import Circle, Side, Site, Straight, Vec, WorldPoint

CIRCLE = Transpath(Site("PA", Side.RIGHT), Circle(Vec(1, 0, 0), 0.1, 1))


STRAIGHT = Transpath(Site("PA", Side.RIGHT), Straight())


@pytest.mark.parametrize("percent", [0.0, 5.0])
def test_a_way_gone_again_differs_by_what_was_planted(signer: Rig, percent: float) -> None:
    """Twice to and fro; the second time 5 % farther: the ends are 5 % of the mean way apart."""
    farther = 0.3 * (1.0 + percent / 100.0)
    course = then(
        moves(0.3, 0.5, 0.5), moves(-0.3, 1.2, 0.5), moves(farther, 2.0, 0.5), moves(-0.3, 3.0, 0.5)
    )
    k = drawn(signer, 4.0, wrists={"R": course, "L": still()})
    spans = [
        span(start, start + 0.5, limbs=ARM_R, moving=True, constraint=STRAIGHT)
        for start in (0.5, 1.2, 2.0)
    ]
    (found,) = repetitions(k, spans)
    assert (found.side, found.first_s, found.second_s) == ("R", 0.5, 2.0)
    wanted = 100.0 * (farther - 0.3) / ((farther + 0.3) / 2.0)
    assert found.difference_percent == pytest.approx(wanted, abs=0.02)


def test_each_way_is_compared_with_the_next(signer: Rig) -> None:
    k = drawn(signer, 4.0, wrists={"R": then(*(moves(0.2, n, 0.5) for n in (0.5, 1.5, 2.5)))})
    spans = [
        span(n, n + 0.5, limbs=ARM_R, moving=True, constraint=STRAIGHT) for n in (0.5, 1.5, 2.5)
    ]
    found = repetitions(k, spans)
    assert [(r.first_s, r.second_s) for r in found] == [(0.5, 1.5), (1.5, 2.5)]


def test_another_way_is_no_repetition(signer: Rig) -> None:
    """Back again on a straight path too; a path of another kind is not compared at all."""
    k = drawn(signer, 3.0, wrists={"R": then(moves(0.3, 0.5, 0.5), moves(-0.3, 1.5, 0.5))})
    back = [
        span(0.5, 1.0, limbs=ARM_R, moving=True, constraint=STRAIGHT),
        span(1.5, 2.0, limbs=ARM_R, moving=True, constraint=STRAIGHT),
    ]
    assert repetitions(k, back) == ()
    same = drawn(signer, 3.0, wrists={"R": then(moves(0.3, 0.5, 0.5), moves(0.3, 1.5, 0.5))})
    assert len(repetitions(same, back)) == 1
    other = [back[0], span(1.5, 2.0, limbs=ARM_R, moving=True, constraint=CIRCLE)]
    assert repetitions(same, other) == ()


@pytest.mark.parametrize(("apart", "same"), [(0.24, True), (0.26, False)])
def test_ways_apart_by_a_quarter_of_their_length_are_two(
    signer: Rig, apart: float, same: bool
) -> None:
    """Of their mean length, which is .4 m."""
    less, more = 0.4 * (1.0 - apart / 2.0), 0.4 * (1.0 + apart / 2.0)
    k = drawn(signer, 3.0, wrists={"R": then(moves(less, 0.5, 0.5), moves(more, 1.5, 0.5))})
    ways = [
        span(start, start + 0.5, limbs=ARM_R, moving=True, constraint=STRAIGHT)
        for start in (0.5, 1.5)
    ]
    assert len(repetitions(k, ways)) == same


def test_a_way_to_another_place_is_no_repetition(signer: Rig) -> None:
    """As when a score damps what it repeats: the second goes less far because it is told to."""
    course = then(moves(0.3, 0.5, 0.5), moves(-0.3, 1.2, 0.5), moves(0.25, 2.0, 0.5))
    k = drawn(signer, 3.0, wrists={"R": course, "L": still()})
    ways = [
        span(start, start + 0.5, limbs=ARM_R, moving=True, constraint=STRAIGHT)
        for start in (0.5, 2.0)
    ]

    def ends(*left_m: float) -> list[TaskSpan]:
        return [
            span(start, start + 0.1, constraint=Place(STRAIGHT.site, WorldPoint(x, 1.0, 0.0)))
            for start, x in zip((1.0, 2.5), left_m, strict=True)
        ]

    assert len(repetitions(k, ways)) == 1
    assert len(repetitions(k, [*ways, *ends(0.3, 0.3)])) == 1
    assert repetitions(k, [*ways, *ends(0.3, 0.25)]) == ()
    begins = [replace(s, start_s=s.start_s - 0.6, end_s=s.end_s - 0.6) for s in ends(0.0, 0.1)]
    assert repetitions(k, [*ways, *begins]) == ()


def is_repeated(signer: Rig, *places: tuple[tuple[float, float], float, float]) -> bool:
    """Whether two equal ways, of half a second each, are one that is gone again.

    places: where the site is asked to be at the first way and at the second, and from when to when
    after the way's start.
    """
    k = drawn(signer, 3.0, wrists={"R": then(moves(0.3, 0.5, 0.5), moves(0.3, 2.0, 0.5))})
    spans = []
    for number, start in enumerate((0.5, 2.0)):
        spans.append(span(start, start + 0.5, limbs=ARM_R, moving=True, constraint=STRAIGHT))
        for x, begins, ends in places:
            place = Place(STRAIGHT.site, WorldPoint(x[number], 1.0, 0.0))
            spans.append(span(start + begins, start + ends, constraint=place))
    return len(repetitions(k, spans)) == 1


@pytest.mark.parametrize(
    ("begins", "ends", "is_end"),
    [
        (-0.2, -0.045, True),
        (-0.2, -0.055, False),
        (0.0, 0.2, True),
        (0.1, 0.4, False),
        (0.3, 0.5, True),
        (0.545, 0.7, True),
        (0.555, 0.7, False),
    ],
)
def test_a_place_at_a_way_or_within_a_twentieth_of_a_second_of_it_is_its_end(
    signer: Rig, begins: float, ends: float, is_end: bool
) -> None:
    assert is_repeated(signer, ((0.1, 0.1), begins, ends))
    assert is_repeated(signer, ((0.1, 0.2), begins, ends)) == (not is_end)


def test_a_way_is_between_the_last_place_before_it_and_the_first_after_it(signer: Rig) -> None:
    before, after = ((0.1, 0.1), -0.4, 0.0), ((0.1, 0.1), 0.5, 0.9)
    assert is_repeated(signer, before, after)
    assert not is_repeated(signer, before, ((0.1, 0.2), -0.2, 0.0))
    assert not is_repeated(signer, after, ((0.1, 0.2), 0.5, 0.7))
    assert is_repeated(signer, ((0.1, 0.2), -0.4, 0.0), ((0.1, 0.1), -0.2, 0.0))
    assert is_repeated(signer, ((0.1, 0.2), 0.5, 0.9), ((0.1, 0.1), 0.5, 0.7))


def test_a_way_is_the_same_on_a_trunk_that_leans_forward_meanwhile(signer: Rig) -> None:
    k = drawn(signer, 3.0, {"back_1.flexion": moves(15.0, 0.4, 2.0)})
    course = then(moves(0.2, 0.5, 0.5), moves(-0.2, 1.2, 0.5), moves(0.2, 2.0, 0.5))
    along = np.stack([course(k.times_s), *np.zeros((2, len(k.times_s)))], axis=1)
    carried = k.scale * k.joint("back_2") + np.einsum("tij,tj->ti", k.rotation("back_2"), along)
    ways = [
        span(start, start + 0.5, limbs=ARM_R, moving=True, constraint=STRAIGHT)
        for start in (0.5, 2.0)
    ]
    (found,) = repetitions(replace(k, ways={"R": carried}), ways)
    assert found.difference_percent == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("bone", ["head", "back_2"])
def test_a_way_is_the_same_on_a_part_that_turned(signer: Rig, bone: str) -> None:
    """A hand that strokes the cheek again goes the same way, though the head is turned now."""
    turns = {f"{bone}.axial": moves(15.0, 1.2, 0.6)}
    k = drawn(signer, 3.0, turns)
    course = then(moves(0.2, 0.5, 0.5), moves(-0.2, 1.2, 0.5), moves(0.2, 2.0, 0.5))
    along = np.stack([course(k.times_s), *np.zeros((2, len(k.times_s)))], axis=1)
    carried = k.scale * k.joint(bone) + np.einsum("tij,tj->ti", k.rotation(bone), along)
    ways = [
        span(start, start + 0.5, limbs=ARM_R, moving=True, constraint=STRAIGHT)
        for start in (0.5, 2.0)
    ]
    (found,) = repetitions(replace(k, ways={"R": carried}), ways)
    assert found.difference_percent == pytest.approx(0.0, abs=1e-6)
    (still_there,) = repetitions(drawn(signer, 3.0, wrists={"R": course}), ways)
    assert still_there.difference_percent == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(("way_m", "compared"), [(0.0195, False), (0.0205, True)])
def test_a_way_of_two_centimetres_is_compared(signer: Rig, way_m: float, compared: bool) -> None:
    course = then(moves(way_m, 0.5, 0.5), moves(way_m, 1.5, 0.5))
    k = drawn(signer, 2.5, wrists={"R": course, "L": still()})
    ways = [
        span(start, start + 0.5, limbs=ARM_R, moving=True, constraint=STRAIGHT)
        for start in (0.5, 1.5)
    ]
    assert len(repetitions(k, ways)) == compared


def test_repetitions_are_told_in_the_order_of_their_time(signer: Rig) -> None:
    """Of both arms; the left one first where both begin at once; however the spans are ordered."""
    k = drawn(
        signer, 4.0, wrists=dict.fromkeys("RL", then(*(moves(0.2, n, 0.5) for n in (1, 2, 3))))
    )
    ways = [
        span(n, n + 0.5, limb=f"arm_{side}", moving=True, constraint=STRAIGHT)
        for side, times in (("R", (1.0, 2.0, 3.0)), ("L", (2.0, 3.0)))
        for n in times
    ]
    for spans in (ways, ways[::-1]):
        found = [(r.side, r.first_s, r.second_s) for r in repetitions(k, spans)]
        assert found == [("R", 1.0, 2.0), ("L", 2.0, 3.0), ("R", 2.0, 3.0)]
