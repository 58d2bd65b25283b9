"""Which markers to glue on: algorithms 1 and 2 of Wheatland 2016, and one of ours.

The root's markers are always there and are not chosen. All markers count where a choice is scored,
also those that it leaves out, unless the printed form is asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import comb

import numpy as np

from azee.capture.components import principal_components
from azee.capture.markers import Floats
from azee.capture.poses import marker_distances
from azee.capture.regression import LocalRegression

Told = Callable[[int, int], None]
"""Is told of parts of the work that are done, and all."""

MOST_SUBSETS = 20_000
"""More choices than this are not searched one by one."""


@dataclass(frozen=True, slots=True)
class Choice:
    """Some markers, by their columns, and the mean error that they were chosen for, metres.

    The error of one marker: over all markers, or over those chosen as algorithm 1 prints it. NaN
    where nothing is measured, as in algorithm 2.
    """

    markers: tuple[int, ...]
    error_m: float


def by_clusters(
    poses: Floats,
    sequence: Floats,
    count: int,
    candidates: Sequence[int],
    *,
    printed: bool = False,
    told: Told | None = None,
) -> list[Choice]:
    """Algorithm 1: rank all choices of so many markers by the pose nearest to each frame.

    Args: poses: (P, M, 3) that stand for the database. sequence: (T, M, 3) of another part of the
        recording. candidates: columns to choose from. printed: whether the error is of the chosen
        markers only, as the algorithm is printed, instead of all.
    Returns: choices, the best first.
    Raises: ValueError: there are more than `MOST_SUBSETS`.
    """
    total = comb(len(candidates), count)
    if not 0 < total <= MOST_SUBSETS:
        raise ValueError(f"{total} choices of {count} of {len(candidates)} markers")
    apart = marker_distances(sequence, poses)
    every = apart.mean(axis=0)
    rows = np.arange(len(sequence))
    found = []
    for n, chosen in enumerate(combinations(candidates, count)):
        summed = apart[list(chosen)].sum(axis=0)
        nearest = summed.argmin(axis=1)
        error = summed[rows, nearest] / count if printed else every[rows, nearest]
        found.append(Choice(chosen, float(error.mean())))
        if told:
            told(n + 1, total)
    return sorted(found, key=lambda choice: (choice.error_m, choice.markers))


def by_components(poses: Floats, candidates: Sequence[int], top: int | None = None) -> list[int]:
    """Algorithm 2: rank markers by what they contribute to the principal components.

    Σ |coefficient · eigenvalue| over all components and the three axes of a marker; with `top`, the
    strongest so many components count alike and the others not at all.

    Returns: the candidates, the most important first.
    """
    found = principal_components(poses.reshape(len(poses), -1))
    weights = found.variances if top is None else np.arange(len(found.variances)) < top
    each = np.abs(found.directions * weights).sum(axis=1).reshape(-1, 3).sum(axis=1)
    return sorted(candidates, key=lambda m: (-each[m], m))


def by_regression(
    poses: Floats,
    sequence: Floats,
    count: int,
    candidates: Sequence[int],
    regression: LocalRegression | None = None,
    told: Told | None = None,
) -> Choice:
    """Ours: the markers from which regression foretells all others best.

    Markers are added one by one, and exchanged one by one as long as that gains: each choice is
    measured by the method that will use it.

    Args: as of `by_clusters`.
    """
    how = regression or LocalRegression()
    flat = poses.reshape(len(poses), -1)
    measured: dict[frozenset[int], float] = {}

    def error(chosen: Iterable[int]) -> float:
        key = frozenset(chosen)
        if key not in measured:
            known = sorted(key)
            trust = np.ones((len(sequence), len(known)))
            made = how.foretell(poses[:, known], sequence[:, known], trust, flat)
            off = made.reshape(sequence.shape) - sequence
            others = [m for m in range(poses.shape[1]) if m not in known]
            each = np.linalg.norm(off, axis=-1)
            measured[key] = float(each[:, others].sum(axis=1).mean()) / poses.shape[1]
            if told:
                told(len(measured), count * len(candidates) * 2)
        return measured[key]

    chosen: list[int] = []
    while len(chosen) < count:
        left = [m for m in candidates if m not in chosen]
        chosen.append(min(left, key=lambda m: (error([*chosen, m]), m)))
    while True:
        others = [
            [*(c for c in chosen if c != out), new]
            for out in chosen
            for new in candidates
            if new not in chosen
        ]
        best = min(others, key=error, default=chosen)
        if error(best) >= error(chosen):
            return Choice(tuple(sorted(chosen)), error(chosen))
        chosen = best
