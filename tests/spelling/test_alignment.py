"""Decomposition, alignment and warping, on hands whose times are known."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import check_grad

from azee.clip.clip import Clip, Label
from azee.spelling.timing.alignment import aligned
from azee.spelling.timing.decomposition import convex_weights, distinct, pseudo_inverse_weights
from azee.spelling.timing.drawn import drawn_words
from azee.spelling.timing.latent_space import (
    latent_distances,
    latent_points,
    negative_log_posterior,
)
from azee.spelling.timing.letter_poses import asl_poses, chebyshev, manhattan, rmsd
from azee.spelling.timing.moving_hand import spelled_angles
from azee.spelling.timing.schedule import LetterTime, schedule
from azee.spelling.timing.timed_word import TimedWord, TimesError
from azee.spelling.timing.warp import warped

POSES = asl_poses()
RATE = 120.0


def test_both_decompositions_find_the_letters_of_their_own_poses() -> None:
    word = "HEAVEN"
    frames = POSES.of(distinct(word))
    np.testing.assert_allclose(pseudo_inverse_weights(frames, POSES, word), np.eye(5), atol=1e-6)
    np.testing.assert_allclose(convex_weights(frames, POSES, word), np.eye(5), atol=1e-3)


def test_the_pseudo_inverse_is_least_squares_as_printed() -> None:
    rng = np.random.default_rng(0)
    frames = spelled_angles(drawn_words()[30], POSES, RATE, rng)
    word = drawn_words()[30].word
    wanted = np.linalg.lstsq(POSES.of(distinct(word)).T, frames.T, rcond=None)[0].T
    np.testing.assert_allclose(pseudo_inverse_weights(frames, POSES, word), wanted, atol=1e-6)


def test_convex_weights_stay_between_0_and_1_and_name_the_held_letter() -> None:
    rng = np.random.default_rng(1)
    word = next(w for w in drawn_words() if w.word == "ELEPHANT")
    frames = spelled_angles(word, POSES, RATE, rng)
    weights = convex_weights(frames, POSES, word.word)
    assert weights.min() >= 0
    np.testing.assert_allclose(weights.sum(axis=1), 1, atol=0.01)
    order = distinct(word.word)
    for letter, (start, end) in zip(word.word, word.hold_spans_s, strict=True):
        middle = round((start + end) / 2 * RATE)
        assert order[weights[middle].argmax()] == letter
    assert np.abs(pseudo_inverse_weights(frames, POSES, word.word)).max() > 1.2


def test_holds_are_found_to_a_frame_and_a_half() -> None:
    rng = np.random.default_rng(2)
    holds, ways = [], []
    words = drawn_words(3)[::4]
    for word in words:
        frames = spelled_angles(word, POSES, RATE, rng)
        found, start_s = aligned(word.word, frames, RATE, POSES)
        assert abs(start_s) < 0.03
        holds += [abs(a - b) for a, b in zip(found.holds_s, word.holds_s, strict=True)]
        ways += [abs(a - b) for a, b in zip(found.transitions_s, word.transitions_s, strict=True)]
    assert len(holds) > 60
    assert np.mean(holds) < 0.0125
    assert np.mean(ways) < 0.0125


def test_what_comes_before_and_after_a_word_is_no_letter() -> None:
    rng = np.random.default_rng(3)
    word = TimedWord("CAB", (0.1, 0.1, 0.15), (0.2, 0.25))
    hand = spelled_angles(word, POSES, RATE, rng)
    other = POSES.of("W")[0]
    s = np.linspace(0, 1, 40)[:, None]
    share = s**3 * (10 - 15 * s + 6 * s**2)  # the hand comes from another letter, and goes back
    still = np.repeat(other[None], 60, axis=0)
    come, go = other + share * (hand[0] - other), hand[-1] + share * (other - hand[-1])
    frames = np.vstack([still, come, hand, go, still])
    found, start_s = aligned("CAB", frames, RATE, POSES)
    assert start_s == pytest.approx(100 / RATE, abs=0.025)
    assert found.duration_s == pytest.approx(word.duration_s, abs=0.05)


def test_words_that_cannot_be_aligned_are_refused() -> None:
    with pytest.raises(TimesError, match="no pose of the letter `Ş`"):
        aligned("ŞAB", np.zeros((500, 18)), RATE, POSES)
    with pytest.raises(TimesError, match="cannot be spelled in 10 frames"):
        aligned("CAB", np.zeros((10, 18)), RATE, POSES)


@settings(max_examples=25)
@given(st.text("ABCDE", min_size=1, max_size=5), st.integers(0, 3), st.integers(0, 1000))
def test_any_movement_has_some_times(word: str, kind: int, seed: int) -> None:
    """A hand that stands still, jumps or wanders spells badly, but every hold has its place."""
    rng = np.random.default_rng(seed)
    frames = (
        np.zeros((150, 18)),
        rng.normal(0, 1, (150, 18)),
        np.cumsum(rng.normal(0, 0.1, (150, 18)), axis=0),
        np.repeat(POSES.of(rng.choice(list("ABCDE"), 15)), 10, axis=0),
    )[kind]
    found, start_s = aligned(word, frames, RATE, POSES)
    assert found.word == word
    assert -0.1 < start_s < start_s + found.duration_s < 150 / RATE + 0.1


def test_metrics_are_as_printed() -> None:
    a, b = np.array([0.0, 1.0, -1.0]), np.array([0.0, 3.0, 0.0])
    assert rmsd(a, b) == pytest.approx(np.sqrt(5 / 3))
    assert (manhattan(a, b), chebyshev(a, b)) == (3, 2)
    assert rmsd(b, a) == rmsd(a, b)


def test_latent_distances_are_0_of_a_pose_from_itself_and_1_at_most() -> None:
    poses = POSES.angles[:10]
    apart = latent_distances(poses)
    np.testing.assert_allclose(apart, apart.T)
    assert np.diag(apart).max() == 0
    assert apart.max() == 1
    points = latent_points(np.vstack([poses, poses[:1]]))
    assert np.linalg.norm(points[0] - points[-1]) < 0.05 * np.ptp(points)


def test_the_latent_space_climbs_along_its_gradient() -> None:
    rng = np.random.default_rng(0)
    poses = rng.normal(size=(6, 4))
    gram = poses @ poses.T

    def at(x: np.ndarray) -> tuple[float, np.ndarray]:
        return negative_log_posterior(x, gram, outputs=4, dimensions=2)

    x = rng.normal(size=14)
    assert check_grad(lambda x: at(x)[0], lambda x: at(x)[1], x) < 1e-5


TIMES = st.floats(0.05, 1.0)


@settings(max_examples=30)
@given(
    st.lists(TIMES, min_size=6, max_size=6), st.lists(TIMES, min_size=5, max_size=5), st.booleans()
)
def test_warping_moves_every_bound_to_its_new_time(
    holds: list[float], ways: list[float], smooth: bool
) -> None:
    word = TimedWord("GUITAR", (0.1, 0.08, 0.09, 0.07, 0.1, 0.15), (0.2, 0.3, 0.2, 0.25, 0.2))
    target = TimedWord("GUITAR", tuple(holds), tuple(ways))
    bounds = sorted({t for span in word.hold_spans_s for t in span})
    labels = tuple(Label(("x",), 0.5 + a, 0.5 + b) for a, b in word.hold_spans_s)
    even = np.arange(0, word.duration_s + 1, 1 / 60, dtype=np.float64)
    times = np.unique(np.concatenate([even, np.array(bounds, dtype=np.float64) + 0.5]))
    clip = Clip(
        times,
        np.arange(len(times), dtype=np.float64)[:, None],
        (),
        np.zeros((len(times), 0)),
        labels,
    )
    made = warped(clip, word, _as_times(target), 0.5, smooth=smooth)
    assert (np.diff(made.times) > 0).all()
    for label, (start, end) in zip(made.labels, target.hold_spans_s, strict=True):
        assert (label.start_s - 0.5, label.end_s - 0.5) == pytest.approx((start, end), abs=1e-9)
    longer = target.duration_s - word.duration_s
    assert made.duration_s == pytest.approx(clip.duration_s + longer, abs=1e-6)
    if not smooth:
        back = warped(made, target, _as_times(word), 0.5)
        np.testing.assert_allclose(back.times, clip.times, atol=1e-9)


def test_a_word_is_warped_only_to_its_own_letters_and_inside_its_clip() -> None:
    word = TimedWord("CAB", (0.1, 0.1, 0.1), (0.2, 0.2))
    clip = Clip(np.arange(31) / 30, np.zeros((31, 1)), (), np.zeros((31, 0)))
    with pytest.raises(ValueError, match="no times of `CAB`"):
        warped(clip, word, schedule("CAP"))
    with pytest.raises(ValueError, match="is held from"):
        warped(clip, word, schedule("CAB"), 0.8)


def _as_times(word: TimedWord) -> list[LetterTime]:
    rows = zip(word.word, word.holds_s, (*word.transitions_s, 0.0), strict=True)
    return [LetterTime(*row) for row in rows]
