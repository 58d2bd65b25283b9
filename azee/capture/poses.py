"""Poses of a hand as markers in the root's frame: their distances, and few that stand for many."""

from __future__ import annotations

import warnings

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.vq import kmeans2

from azee.capture.markers import Floats

Rows = NDArray[np.int64]

SEED = 2016
SWEEPS = 10
"""Of k-means; centres move little after them."""
ENOUGH = 4
"""Poses for each centre, more of which change it little: frames that follow each other are nearly
alike."""


def marker_distances(first: Floats, second: Floats) -> Floats:
    """Euclidean distance of each marker in each pair of poses, (M, N, P) metres.

    Wheatland 2016 measures how far poses are apart by the sum over markers.

    Args: first: (N, M, 3). second: (P, M, 3).
    """
    out = np.empty((first.shape[1], len(first), len(second)))
    for m in range(first.shape[1]):
        square = np.zeros((len(first), len(second)))
        for axis in range(3):
            square += (first[:, None, m, axis] - second[None, :, m, axis]) ** 2
        out[m] = np.sqrt(square)
    return out


def representatives(poses: Floats, count: int, seed: int = SEED) -> Rows:
    """Return so many real poses that stand for all: of each cluster the one nearest its mean.

    k-means on all markers (Wheatland 2016, section 3.1.2), of so many evenly spaced poses as tell
    the clusters. Fewer are returned where clusters are left empty.

    Args: poses: (N, M, 3). Returns: rows of `poses`, increasing.
    """
    if count >= len(poses):
        return np.arange(len(poses))
    every = np.arange(0, len(poses), max(1, len(poses) // max(ENOUGH * count, 1000)))
    flat = poses[every].reshape(len(every), -1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of empty clusters
        centres, member = kmeans2(
            flat, count, iter=SWEEPS, minit="points", seed=np.random.default_rng(seed)
        )
    apart = np.linalg.norm(flat - centres[member], axis=1)
    order = np.lexsort((apart, member))
    first = np.r_[True, np.diff(member[order]) > 0]
    return np.asarray(every[np.sort(order[first])])
