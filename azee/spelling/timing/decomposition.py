"""How much of each of a word's letters is in every frame of a hand that spells it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from azee.spelling.timing.letter_poses import LetterPoses

Array = NDArray[np.float64]

SUM_WEIGHT = 30.0
"""Of the row that asks weights to sum to 1, against radians."""


def distinct(word: str) -> str:
    """Return the letters of a word, each once, in the order in which they first come."""
    return "".join(dict.fromkeys(word))


def pseudo_inverse_weights(frames: Array, poses: LetterPoses, word: str) -> Array:
    """Decompose frames as published: weights of any size and sign.

    J = Σ w L by least squares, with L⁺ = (LᵀL)⁻¹Lᵀ (Wheatland 2016, equations 4.1 and 4.2), over
    the letters of the word only.

    Args: frames: (T, joints) radians, in the order of the poses.
    Returns: (T, letters of `distinct(word)`).
    Raises: KeyError: a letter has no pose. LinAlgError: two of its letters have the same pose.
    """
    letters = poses.of(distinct(word)).T
    return np.asarray((np.linalg.inv(letters.T @ letters) @ letters.T @ frames.T).T)


def convex_weights(frames: Array, poses: LetterPoses, word: str) -> Array:
    """Decompose frames into weights of 0 to 1 that sum to 1. Ours: equation 4.1 with conditions.

    Poses and frames count from the mean of all letters. Args and returns: as
    `pseudo_inverse_weights`. Raises: KeyError: a letter has no pose.
    """
    mean = poses.angles.mean(axis=0)
    letters = (poses.of(distinct(word)) - mean).T
    system = np.vstack([letters, np.full((1, letters.shape[1]), SUM_WEIGHT)])
    weights = [nnls(system, np.r_[frame - mean, SUM_WEIGHT])[0] for frame in frames]
    return np.array(weights).reshape(len(frames), -1)
