"""Which markers to record: the printed algorithms written out, and ours against all choices."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from azee.capture.choosing import by_clusters, by_components, by_regression
from azee.capture.markers import MarkersError
from azee.capture.poses import marker_distances, representatives
from azee.capture.training import Poses, choose

RANDOM = np.random.default_rng(3)
POSES, SEQUENCE = RANDOM.normal(size=(12, 5, 3)), RANDOM.normal(size=(9, 5, 3))


def algorithm_1(count: int, *, printed: bool) -> tuple[tuple[int, ...], float]:
    """Algorithm 1 of Wheatland 2016, loop by loop."""
    best, least = (), np.inf
    for chosen in combinations(range(5), count):
        total = 0.0
        for frame in SEQUENCE:
            errors = [sum(np.linalg.norm(frame[m] - pose[m]) for m in chosen) for pose in POSES]
            pose = POSES[int(np.argmin(errors))]
            scored = chosen if printed else range(5)
            total += np.mean([np.linalg.norm(frame[m] - pose[m]) for m in scored])
        if total < least:
            best, least = chosen, total
    return best, least / len(SEQUENCE)


@pytest.mark.parametrize("printed", [True, False])
def test_algorithm_1_ranks_every_choice_by_its_nearest_poses(printed: bool) -> None:
    ranked = by_clusters(POSES, SEQUENCE, 2, range(5), printed=printed)
    chosen, error = algorithm_1(2, printed=printed)
    assert ranked[0].markers == chosen
    assert ranked[0].error_m == pytest.approx(error)
    assert len(ranked) == 10


def test_too_many_choices_are_refused() -> None:
    with pytest.raises(ValueError, match="choices of 12 of 30 markers"):
        by_clusters(RANDOM.normal(size=(2, 30, 3)), RANDOM.normal(size=(2, 30, 3)), 12, range(30))


def test_algorithm_2_adds_up_coefficients_times_eigenvalues() -> None:
    sizes, directions = np.linalg.eigh(np.cov(POSES.reshape(12, -1).T))
    influence = [
        sum(abs(directions[3 * m + k, j] * sizes[j]) for j in range(15) for k in range(3))
        for m in range(5)
    ]
    assert by_components(POSES, range(5)) == sorted(range(5), key=lambda m: -influence[m])
    strongest = directions[:, ::-1][:, :4]
    alike = [np.abs(strongest[3 * m : 3 * m + 3]).sum() for m in range(5)]
    assert by_components(POSES, range(5), top=4) == sorted(range(5), key=lambda m: -alike[m])


def test_algorithm_2_only_adds_markers_as_more_are_wanted(poses: Poses) -> None:
    ranked = by_components(poses.positions, poses.candidates)
    assert len(set(ranked)) == len(poses.candidates)
    assert choose(poses, 3, "components") == tuple(poses.names[m] for m in ranked[:3])


def test_regression_chooses_a_marker_as_good_as_the_best_single_one(poses: Poses) -> None:
    known, unknown = poses.positions[:500:5], poses.positions[600:800:10]
    some = poses.candidates[:5]
    alone = [by_regression(known, unknown, 1, [m]).error_m for m in some]
    best = by_regression(known, unknown, 1, some)
    assert best.error_m == min(alone)
    pair = by_regression(known, unknown, 2, some)
    assert pair.error_m < best.error_m


def test_more_markers_than_there_are_cannot_be_chosen(poses: Poses) -> None:
    with pytest.raises(MarkersError, match="11 of 10 markers"):
        choose(poses, 11)


def test_representatives_are_real_poses_and_the_same_every_time(poses: Poses) -> None:
    rows = representatives(poses.positions, 40)
    assert rows.tolist() == representatives(poses.positions, 40).tolist()
    assert 30 <= len(set(rows.tolist())) == len(rows) <= 40
    apart = marker_distances(poses.positions, poses.positions[rows]).sum(axis=0).min(axis=1)
    spaced = poses.positions[:: len(poses.positions) // 40]
    assert apart.mean() < marker_distances(poses.positions, spaced).sum(axis=0).min(axis=1).mean()
