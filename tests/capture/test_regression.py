"""Locally weighted regression, against what it must be, and the identity of its components."""

from __future__ import annotations

import numpy as np
import pytest

from azee.capture.components import principal_components
from azee.capture.evaluation import identity
from azee.capture.reconstruction import through_components
from azee.capture.regression import LocalRegression, nearest_rows
from azee.capture.smoothing import cone_filter, taps_at
from azee.capture.training import Poses

RANDOM = np.random.default_rng(1)
SAMPLES = 0.05 * RANDOM.normal(size=(80, 2, 3))
FRAMES = 0.05 * RANDOM.normal(size=(7, 2, 3))
WHOLE = np.ones((7, 2))


def foretold_by_hand(how: LocalRegression, frame: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Weighted ridge regression as a textbook has it."""
    apart = np.linalg.norm(SAMPLES - frame, axis=-1).sum(axis=1)
    w = apart**-how.exponent
    if how.nearest is not None:
        w = np.maximum(w - np.sort(w)[-how.nearest - 1], 0.0)
    w /= w.sum()
    X, x = SAMPLES.reshape(80, -1), frame.ravel()
    mean, middle = w @ X, w @ values
    A = (X - mean).T @ np.diag(w) @ (X - mean) + how.ridge_m**2 * np.eye(6)
    slope = np.linalg.solve(A, (X - mean).T @ np.diag(w) @ (values - middle))
    return np.asarray(middle + (x - mean) @ slope)


@pytest.mark.parametrize(
    "how", [LocalRegression(), LocalRegression(1.0, ridge_m=0.01), LocalRegression(nearest=20)]
)
def test_it_is_weighted_ridge_regression_with_a_free_intercept(how: LocalRegression) -> None:
    values = RANDOM.normal(size=(80, 4))
    found = how.foretell(SAMPLES, FRAMES, WHOLE, values)
    wanted = [foretold_by_hand(how, frame, values) for frame in FRAMES]
    np.testing.assert_allclose(found, wanted, atol=1e-9)


def test_what_is_linear_in_the_markers_comes_out_exactly() -> None:
    slope = RANDOM.normal(size=(6, 3))
    values = SAMPLES.reshape(80, -1) @ slope + 5.0
    found = LocalRegression(ridge_m=1e-8).foretell(SAMPLES, FRAMES, WHOLE, values)
    np.testing.assert_allclose(found, FRAMES.reshape(7, -1) @ slope + 5.0, atol=1e-8)


def test_a_marker_without_trust_is_as_if_it_were_not_there() -> None:
    values = RANDOM.normal(size=(80, 4))
    trust = WHOLE * [1.0, 0.0]
    lost = np.where(trust[:, :, None] > 0, FRAMES, np.nan)
    found = LocalRegression().foretell(SAMPLES, lost, trust, values)
    alone = LocalRegression().foretell(SAMPLES[:, :1], FRAMES[:, :1], WHOLE[:, :1], values)
    np.testing.assert_allclose(found, alone, atol=1e-9)


def test_trust_that_fades_moves_nothing_by_a_jump() -> None:
    values = RANDOM.normal(size=(80, 4))
    fade = np.linspace(1.0, 0.0, 400)
    frames = np.tile(FRAMES[:1], (400, 1, 1))
    trust = np.stack([np.ones(400), fade], axis=1)
    found = LocalRegression(nearest=30).foretell(SAMPLES, frames, trust, values)
    way = np.abs(found[-1] - found[0]).max()
    assert np.abs(np.diff(found, axis=0)).max() < 0.1 * way


def test_all_components_change_nothing_where_the_intercept_is_free(poses: Poses) -> None:
    samples, test = poses.positions[:500:2], poses.positions[600:640]
    off = identity(poses, samples, test, ("thumb_tip", "index_tip", "ring_tip"))
    assert off["intercept outside the ridge"] < 1e-12
    assert off["1/d over all samples, as published"] < 1e-12
    assert off["intercept inside a ridge of 10⁻³"] > 1e-5
    assert off["10 components"] > 1e-4


def test_components_may_be_smoothed_before_or_after() -> None:
    """The filter is linear too: a cone on components is the same cone on what they make."""
    values = RANDOM.normal(size=(80, 4))
    how = LocalRegression()
    (through,) = through_components(how, SAMPLES, FRAMES, WHOLE, [values], 3)
    straight = cone_filter(how.foretell(SAMPLES, FRAMES, WHOLE, values), 3)
    np.testing.assert_allclose(through, straight, atol=1e-12)


def test_the_nearest_pose_is_nearest_by_the_sum_over_markers() -> None:
    apart = np.linalg.norm(FRAMES[:, None] - SAMPLES, axis=-1).sum(axis=2)
    assert nearest_rows(SAMPLES, FRAMES, WHOLE).tolist() == apart.argmin(axis=1).tolist()


def test_components_are_the_eigenvectors_of_the_covariance() -> None:
    values = RANDOM.normal(size=(80, 4)) * [4, 3, 2, 1]
    found = principal_components(values)
    sizes, directions = np.linalg.eigh(np.cov(values.T))
    np.testing.assert_allclose(found.variances, sizes[::-1])
    np.testing.assert_allclose(np.abs(found.directions), np.abs(directions[:, ::-1]), atol=1e-9)
    np.testing.assert_allclose(found.back(found.of(values)), values)


def test_a_cone_has_weights_that_fall_evenly() -> None:
    values = np.zeros(21)
    values[10] = 1.0
    np.testing.assert_allclose(cone_filter(values, 5)[7:14], np.array([0, 1, 2, 3, 2, 1, 0]) / 9)
    np.testing.assert_allclose(cone_filter(np.ones(4), 15), 1.0)
    assert [taps_at(rate, 15) for rate in (120.0, 60.0, 20.0)] == [15, 7, 1]
