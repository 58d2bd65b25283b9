"""Blinks: how often, where, and from which seed."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.animation import Animation, animate
from azee.lang.program import evaluate_expression
from azee.motion.overlay.blinks import (
    CLOSE_S,
    JITTER_S,
    OPEN_S,
    SHORTEST_GAP_S,
    blink_times,
    blinks,
    boundaries,
    gaze_shifts,
)
from azee.motion.overlay.seed import seed_of
from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.limbs import Limbs
from azee.motion.tasks.schedule import bind
from azee.score.interval import Interval
from azee.score.score import Block, Call, Group, Key, Score
from azee_rig.rig import Rig
from azee_solver.constraint import Morph, Origin
from azee_solver.evaluate import evaluator
from azee_solver.geometry import Side

Array = NDArray[np.float64]
TIMES = np.arange(0.0, 60.0, 1.0 / 30.0)
FREE = np.zeros(len(TIMES), dtype=np.bool_)
ENDS = [*np.arange(1.0, 60.0, 1.3)]


def starts(seed: int, at: list[float] | None = None, busy: NDArray[np.bool_] = FREE) -> Array:
    return np.array(blink_times(busy, at or [], TIMES, np.random.default_rng(seed)))


@pytest.mark.parametrize("at", [None, ENDS])
def test_eyes_blink_ten_to_thirty_times_a_minute_at_uneven_intervals(
    at: list[float] | None,
) -> None:
    counts = []
    for seed in range(20):
        found = starts(seed, at)
        counts.append(len(found))
        gaps = np.diff(found)
        assert gaps.min() >= SHORTEST_GAP_S - 1e-9
        assert gaps.std() > 0.25 * gaps.mean()
    assert min(counts) >= 10
    assert max(counts) <= 30
    assert 17 <= np.mean(counts) <= 26, "people at rest and in conversation"


def test_most_blinks_are_at_boundaries_and_not_all() -> None:
    found = np.concatenate([starts(seed, ENDS) for seed in range(20)])
    near = np.abs(found[:, None] - np.array(ENDS)).min(axis=1) <= JITTER_S + 1e-9
    assert 0.7 < near.mean() < 0.95


def test_seeds_give_other_instants() -> None:
    assert starts(3, ENDS) == pytest.approx(starts(3, ENDS))
    assert len(set(starts(3, ENDS)) & set(starts(4, ENDS))) == 0


def test_a_blink_waits_until_the_face_needs_the_lids_no_more() -> None:
    busy = ((TIMES > 5.0) & (TIMES < 25.0)) | (TIMES > 40.0)
    found = starts(1, ENDS, busy)
    assert len(found) > 5
    for start in found:
        assert not busy[(start <= TIMES) & (start + CLOSE_S + OPEN_S >= TIMES)].any()
    assert np.any((found > 24.9) & (found < 25.0)), "one that waited"
    assert len(starts(1, ENDS, ~FREE)) == 0


def test_lids_close_and_open_again() -> None:
    rng = np.random.default_rng(2)
    out = blinks({"left": 1.0, "right": 0.5}, ("jaw", "left", "right"), FREE, [], TIMES, rng)
    assert not out[:, 0].any()
    assert out[:, 1] == pytest.approx(2.0 * out[:, 2])
    assert 0.8 < out[:, 1].max() <= 1.0
    closed = out[:, 1] > 0.0
    begins = np.flatnonzero(closed[1:] & ~closed[:-1])
    assert len(begins) == len(starts(2))
    assert closed.sum() / len(begins) / 30.0 == pytest.approx(CLOSE_S + OPEN_S, abs=0.04)


def test_a_large_shift_of_gaze_is_a_boundary_and_a_shake_is_none(signer: Rig) -> None:
    c = signer.coordinates
    q = np.tile(c.idle, (len(TIMES), 1))
    turn = np.clip((TIMES - 10.0) / 0.4, 0.0, 1.0)
    q[:, c.index["head.axial"]] += math.radians(20.0) * turn
    for eye in ("eye_L.yaw", "eye_R.yaw"):
        q[:, c.index[eye]] += math.radians(15.0) * turn
    shake = ((TIMES > 20.0) & (TIMES < 22.0)) | (TIMES > 45.0)
    q[:, c.index["neck.axial"]] += math.radians(10.0) * np.sin(8.0 * TIMES) * shake
    q[:, c.index["head.flexion"]] += math.radians(-28.0) * np.clip((TIMES - 15.0) / 0.5, 0, 1)
    q[:, c.index["back_2.axial"]] += math.radians(40.0) * np.clip((TIMES - 30.0) / 9.0, 0, 1)
    assert gaze_shifts(q, TIMES, c) == pytest.approx([10.0, 15.0], abs=0.05)


def test_signs_end_at_boundaries(signer: Rig) -> None:
    score = evaluate_expression("seq(list(:bonjour, :chat))").score
    tasks = bind(
        flatten(score), signer, evaluator(signer, Side.RIGHT).binding, Limbs.of(signer.coordinates)
    ).all
    still = np.tile(signer.coordinates.idle, (len(TIMES), 1))
    found = boundaries(score, tasks, still, TIMES, signer.coordinates)
    assert len(found) == 2
    assert found[-1] == pytest.approx(float(score.duration))


def face(weight: float, origin: Origin | None = None, seconds: str = "1") -> Score:
    key = Key(
        Fraction(seconds), calls=(Call("x", origin),),
        constraints=(Morph("AU1", None, weight, origin=origin),),
    )  # fmt: skip
    return Group(key.duration, blocks=(Block("A", Interval(Fraction(0), key.duration), key),))


def test_the_seed_is_of_what_is_asked_and_not_of_where_it_is_written() -> None:
    here, there = Origin("a.azee", 1, 1), Origin("/elsewhere/b.azee", 7, 3)
    assert seed_of(face(0.5, here)) == seed_of(face(0.5, there))
    assert len({seed_of(s) for s in (face(0.5), face(0.6), face(0.5, seconds="2"))}) == 3
    assert seed_of(face(0.5)) == 9731808755846253251, "the same in every run and release"


def weights(animation: Animation) -> Array:
    return np.asarray(animation.clip.unit_weights)


@pytest.mark.long
def test_scores_blink_at_instants_of_their_own(signer: Rig) -> None:
    def played(duration: str, seed: int | None = None) -> Animation:
        pause = Group(Fraction(duration), blocks=())
        return animate(pause, signer, seed=seed)

    one, again = played("20"), played("20")
    assert np.array_equal(weights(one), weights(again))
    assert np.array_equal(weights(played("20", 3)), weights(played("20", 3)))
    other = weights(played("20.5"))[: len(weights(one))]
    assert not np.array_equal(weights(one), other)
    assert not np.array_equal(weights(one), weights(played("20", 3)))
