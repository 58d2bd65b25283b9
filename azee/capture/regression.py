"""Locally weighted regression: a linear model for every frame, of the samples that are near it.

A frame's model weighs each sample by the inverse of its distance from the frame, over the markers
that are recorded (Wheatland 2016, section 3.2.2). What it foretells is linear in what the samples
have, Σ h y: the shares h hang on the recorded markers only. So they are worked out once a frame and
serve everything that is to be foretold: the other markers, joint angles, components of either.
Where Σ h = 1, as with an intercept that the ridge spares, the way over all components changes
nothing.

A marker that is missing, or trusted in part only, counts by its trust τ: τ of its distance, and its
coordinates are scaled by τ, so that the ridge keeps its coefficients from growing. Trust that fades
lets a marker come and go without a jump.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.capture.markers import Floats

Rows = NDArray[np.int64]

LEAST_M = 1e-6
"""Samples nearer than this count as at this distance."""
CHUNK = 32
"""Frames that are solved together."""


@dataclass(frozen=True, slots=True)
class LocalRegression:
    """How samples are weighted, and what the ridge keeps small.

    exponent: weights are 1 / distance to the power of it; 1 is the published one. nearest: how many
    samples a frame's model has; None takes all, as published. Of fewer, the weight of the farthest
    is taken off all weights, so that samples come and go without a jump. ridge_m: the error of a
    marker, metres, that the ridge allows for. penalised: whether the ridge keeps the intercept
    small too, as a plain ridge regression does; kept to show what that costs.
    """

    exponent: float = 2.0
    nearest: int | None = 200
    ridge_m: float = 0.0005
    penalised: bool = False

    def shares(self, samples: Floats, frames: Floats, trust: Floats) -> tuple[Rows, Floats]:
        """Return for each frame which samples it takes, (T, k), and their shares h, (T, k).

        Args: samples: (N, m, 3) recorded markers, metres. frames: (T, m, 3), anything where the
            trust is 0. trust: (T, m), 0 … 1.
        """
        count = len(samples) if self.nearest is None else min(self.nearest, len(samples))
        rows = np.empty((len(frames), count), dtype=np.int64)
        shares = np.empty((len(frames), count))
        frames = np.where(trust[:, :, None] > 0.0, frames, 0.0)
        for start in range(0, len(frames), CHUNK):
            some = slice(start, start + CHUNK)
            rows[some], shares[some] = self._some(samples, frames[some], trust[some], count)
        return rows, shares

    def _some(
        self, samples: Floats, frames: Floats, trust: Floats, count: int
    ) -> tuple[Rows, Floats]:
        apart = np.zeros((len(frames), len(samples)))
        for m in range(samples.shape[1]):
            square = np.zeros_like(apart)
            for axis in range(3):
                square += (frames[:, m, axis, None] - samples[None, :, m, axis]) ** 2
            apart += trust[:, m, None] * np.sqrt(square)
        rows: Rows
        if count < len(samples):
            rows = np.argpartition(apart, count - 1, axis=1)[:, :count]
        else:
            rows = np.broadcast_to(np.arange(count), (len(frames), count))
        near = np.maximum(np.take_along_axis(apart, rows, axis=1), LEAST_M)
        w = near**-self.exponent
        if count < len(samples):
            w = w - w.min(axis=1, keepdims=True)
        w /= np.maximum(w.sum(axis=1, keepdims=True), np.finfo(float).tiny)
        X = (samples[rows] * trust[:, None, :, None]).reshape(len(frames), count, -1)
        x = (frames * trust[:, :, None]).reshape(len(frames), -1)
        if self.penalised:
            X = np.concatenate([np.ones((*X.shape[:2], 1)), X], axis=2)
            x = np.concatenate([np.ones((len(x), 1)), x], axis=1)
            constant = np.zeros(w.shape)
        else:
            middle = np.einsum("tk,tkd->td", w, X)
            X, x, constant = X - middle[:, None], x - middle, w
        S = np.matmul(np.swapaxes(X * w[:, :, None], 1, 2), X)
        S += self.ridge_m**2 * np.eye(S.shape[1])
        slope = np.linalg.solve(S, x[:, :, None])
        return rows, constant + w * np.matmul(X, slope)[:, :, 0]


def foretold(rows: Rows, shares: Floats, values: Floats) -> Floats:
    """Return Σ h y for each frame, (T, D): of samples that have the values (N, D)."""
    out = np.empty((len(rows), values.shape[1]))
    for start in range(0, len(rows), CHUNK):
        some = slice(start, start + CHUNK)
        out[some] = np.matmul(shares[some, None], values[rows[some]])[:, 0]
    return out
