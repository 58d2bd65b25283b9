"""Locally weighted regression: a linear model for every frame, of the samples that are near it.

A frame's model weighs each sample by the inverse of its distance from the frame, over the markers
that are recorded (Wheatland 2016, section 3.2.2). With weights w that sum to one, x̄ = Σ w x, and a
ridge λ,

    S = Σ w (x − x̄)(x − x̄)ᵀ + λ I        g = S⁻¹ (x_frame − x̄)        h = w (1 + (x − x̄)·g)

what it foretells is Σ h y: linear in what the samples have. The shares h hang on the recorded
markers only, so they serve everything at once: the other markers, joint angles, components of
either. Since Σ h = 1, the way over all components changes nothing. Sums over samples are products
of matrices, one for many frames: they take most of the time.

A marker that is missing, or trusted in part only, counts by its trust τ: τ of its distance, its
coordinates are scaled by τ, and its ridge goes from λ to a metre squared, evenly in its logarithm.
So trust that fades lets a marker come and go without a jump.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.capture.markers import Floats

LEAST_M = 1e-6
"""Samples nearer than this count as at this distance."""
CHUNK = 64
"""Frames that are solved together."""


@dataclass(frozen=True, slots=True)
class LocalRegression:
    """How samples are weighted, and what the ridge keeps small.

    exponent: weights are 1 / distance to the power of it; 1 is the published one. nearest: how many
    samples a frame's model has; None takes all, as published. Of fewer, the weight of the farthest
    is taken off all weights, so that samples come and go without a jump. ridge_m: √λ, the error of
    a marker that the ridge allows for, metres. penalised: whether the ridge keeps the intercept
    small too, as a plain ridge regression does; kept to show what that costs.
    """

    exponent: float = 2.0
    nearest: int | None = None
    ridge_m: float = 0.0001
    penalised: bool = False

    def foretell(self, samples: Floats, frames: Floats, trust: Floats, values: Floats) -> Floats:
        """Return Σ h y for each frame, (T, D).

        Args: samples: (N, m, 3) recorded markers, metres. frames: (T, m, 3), anything where the
            trust is 0. trust: (T, m), 0 … 1. values: (N, D) what the samples have.
        """
        middle = samples.mean(axis=0)
        X = samples - middle
        frames = np.where(trust[:, :, None] > 0.0, frames - middle, 0.0)
        flat = X.reshape(len(X), -1)
        products = (flat[:, :, None] * flat[:, None, :]).reshape(len(X), -1)
        out = np.empty((len(frames), values.shape[1]))
        for start in range(0, len(frames), CHUNK):
            some = slice(start, start + CHUNK)
            w = self._weights(X, frames[some], trust[some])
            out[some] = self._shares(flat, products, w, frames[some], trust[some]) @ values
        return out

    def _weights(self, samples: Floats, frames: Floats, trust: Floats) -> Floats:
        """Weights (t, N) that sum to one."""
        w = np.maximum(summed_distances(samples, frames, trust), LEAST_M) ** -self.exponent
        if self.nearest is not None and self.nearest < len(samples):
            least = np.partition(w, -self.nearest - 1, axis=1)[:, -self.nearest - 1]
            w = np.maximum(w - least[:, None], 0.0)
        return np.asarray(w / w.sum(axis=1, keepdims=True))

    def _shares(
        self, X: Floats, products: Floats, w: Floats, frames: Floats, trust: Floats
    ) -> Floats:
        """Shares h (t, N) of samples with markers X (N, d), of which the products are (N, d²)."""
        t, d = len(w), X.shape[1]
        tau = np.repeat(trust, 3, axis=1)
        x = frames.reshape(t, d) * tau
        middle = (w @ X) * tau
        S = (w @ products).reshape(t, d, d) * tau[:, :, None] * tau[:, None, :]
        ridge = self.ridge_m ** (2.0 * tau)[:, :, None] * np.eye(d)
        if self.penalised:
            S = np.block([[np.ones((t, 1, 1)), middle[:, None]], [middle[:, :, None], S + ridge]])
            S[:, 0, 0] += self.ridge_m**2
            g = np.linalg.solve(S, np.concatenate([np.ones((t, 1)), x], axis=1)[:, :, None])
            return np.asarray(w * (g[:, 0] + (g[:, 1:, 0] * tau) @ X.T))
        S += ridge - middle[:, :, None] * middle[:, None, :]
        g = np.linalg.solve(S, (x - middle)[:, :, None])[:, :, 0]
        return np.asarray(w * (1.0 - (middle * g).sum(axis=1)[:, None] + (g * tau) @ X.T))


def summed_distances(samples: Floats, frames: Floats, trust: Floats) -> Floats:
    """Return Σ τ |x − x'| over the markers of frames (t, m, 3) and samples (N, m, 3), (t, N)."""
    apart = np.zeros((len(frames), len(samples)))
    for m in range(samples.shape[1]):
        a, b = frames[:, m], samples[:, m]
        square = (a**2).sum(axis=1)[:, None] + (b**2).sum(axis=1) - 2.0 * (a @ b.T)
        apart += trust[:, m, None] * np.sqrt(np.maximum(square, 0.0))
    return apart


def nearest_rows(samples: Floats, frames: Floats, trust: Floats) -> NDArray[np.int64]:
    """Return the sample that is nearest to each frame, (T,) rows of samples."""
    middle = samples.mean(axis=0)
    frames = np.where(trust[:, :, None] > 0.0, frames - middle, 0.0)
    found = [
        summed_distances(samples - middle, frames[s : s + CHUNK], trust[s : s + CHUNK]).argmin(1)
        for s in range(0, len(frames), CHUNK)
    ]
    return np.concatenate(found)
