"""A latent space of poses by Gaussian processes (Lawrence 2005), for the distance GPLVMD."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import minimize

Array = NDArray[np.float64]

DIMENSIONS = 2


def latent_points(poses: Array, dimensions: int = DIMENSIONS) -> Array:
    """Place poses in a latent space, from which a Gaussian process makes them again.

    With Y the centred poses, (N, D), and k(x, x′) = s² exp(−|x − x′|² / 2) + σ² δ, the points X,
    s and σ maximise −D/2 log |K| − ½ tr(K⁻¹ Y Yᵀ) − ½ Σ x² (N. Lawrence, Journal of Machine
    Learning Research 6, 2005, equation 4, with a standard normal prior on X). It starts from the
    principal components.

    Args: poses: (N, D). Returns: (N, dimensions).
    """
    centred = poses - poses.mean(axis=0)
    scaled = centred / max(float(centred.std()), 1e-12)
    u, s, _ = np.linalg.svd(scaled, full_matrices=False)
    start = u[:, :dimensions] * s[:dimensions]
    start /= np.maximum(start.std(axis=0), 1e-12)
    gram, count = scaled @ scaled.T, len(poses)

    def loss(x: Array) -> tuple[float, Array]:
        return negative_log_posterior(x, gram, scaled.shape[1], dimensions)

    first = np.r_[start.ravel(), 0.0, np.log(0.1)]
    found = minimize(loss, first, jac=True, method="L-BFGS-B", options={"maxiter": 500})
    return np.asarray(found.x[:-2].reshape(count, dimensions))


def negative_log_posterior(
    x: Array, gram: Array, outputs: int, dimensions: int
) -> tuple[float, Array]:
    """Return what is minimised, and its gradient.

    Args: x: (N · dimensions + 2,), the points, log s and log σ. gram: Y Yᵀ, (N, N). outputs: D.
    """
    count = len(gram)
    points, log_s, log_noise = x[:-2].reshape(count, dimensions), x[-2], x[-1]
    apart = points[:, None, :] - points[None, :, :]
    signal = np.exp(2 * log_s - 0.5 * (apart**2).sum(axis=-1))
    noise = np.exp(2 * log_noise) + 1e-6
    factor = cho_factor(signal + noise * np.eye(count), lower=True)
    inverse = cho_solve(factor, np.eye(count))
    log_determinant = 2 * np.log(np.diag(factor[0])).sum()
    value = 0.5 * (outputs * log_determinant + (inverse * gram).sum() + (points**2).sum())
    by_k = 0.5 * (outputs * inverse - inverse @ gram @ inverse)
    by_points = -2 * ((by_k * signal)[:, :, None] * apart).sum(axis=1) + points
    by_s = 2 * (by_k * signal).sum()
    by_noise = 2 * np.exp(2 * log_noise) * np.trace(by_k)
    return float(value), np.r_[by_points.ravel(), by_s, by_noise]


def latent_distances(poses: Array) -> Array:
    """Return GPLVMD of every two poses, (N, N), 0 to 1 (Wheatland 2016, section 4.2.2).

    GPLVMD(a, b) = Σ (c_a − d_b)² / x, where c_a and d_b are the poses' points in the latent space
    and x is the largest of these sums.
    """
    points = latent_points(poses)
    squares = ((points[:, None, :] - points[None, :, :]) ** 2).sum(axis=-1)
    return np.asarray(squares / max(float(squares.max()), 1e-12))
