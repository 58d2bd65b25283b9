"""How often each of several things is preferred to another, as one number a thing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components
from scipy.special import expit
from scipy.stats import chi2

Array = NDArray[np.float64]

STEPS = 100
TOLERANCE = 1e-12


@dataclass(frozen=True, eq=False)
class Strengths:
    """Strengths of a Bradley–Terry model.

    strengths: (K,) logits against the last thing, whose own is 0. covariance: (K, K), with zeros
    of the last. p: of the likelihood-ratio test that all are equal. bounded: whether half a choice
    was added each way, because some are never or always preferred to the others.
    """

    strengths: Array
    covariance: Array
    p: float
    bounded: bool

    @property
    def standard_errors(self) -> Array:
        """Standard errors, (K,); 0 of the last."""
        return np.sqrt(np.diag(self.covariance))

    def difference(self, i: int, j: int) -> tuple[float, float]:
        """Return by how many logits i is preferred to j, and the standard error."""
        c = self.covariance
        variance = c[i, i] + c[j, j] - 2 * c[i, j]
        return float(self.strengths[i] - self.strengths[j]), float(np.sqrt(max(0.0, variance)))


def strengths(wins: Array) -> Strengths:
    """Fit P(i is preferred to j) = 1 / (1 + exp(βⱼ − βᵢ)) by maximum likelihood.

    R. Bradley and M. Terry, Biometrika 39, 1952; Newton's method on the logits.

    Args: wins: (K, K), how often i was preferred to j; halves stand for "no difference".
    """
    bounded = _is_separated(wins)
    if bounded:
        wins = wins + 0.5 * ((wins + wins.T) > 0)
    count = len(wins)
    shown = wins + wins.T
    beta = np.zeros(count)
    for _ in range(STEPS):
        p = expit(beta[:, None] - beta[None, :])
        gradient = (wins - shown * p).sum(axis=1)[:-1]
        step = np.linalg.solve(_information(shown, p)[:-1, :-1], gradient)
        beta[:-1] += step
        if np.abs(step).max() < TOLERANCE:
            break
    covariance = np.zeros((count, count))
    p = expit(beta[:, None] - beta[None, :])
    covariance[:-1, :-1] = np.linalg.inv(_information(shown, p)[:-1, :-1])
    gain = _log_likelihood(wins, beta) - _log_likelihood(wins, np.zeros(count))
    return Strengths(beta, covariance, float(chi2.sf(2 * gain, count - 1)), bounded)


def _information(shown: Array, p: Array) -> Array:
    """Fisher information of the logits, (K, K); singular, for only differences count."""
    w = shown * p * (1 - p)
    np.fill_diagonal(w, 0)
    return np.asarray(np.diag(w.sum(axis=1)) - w)


def _log_likelihood(wins: Array, beta: Array) -> float:
    return float((wins * -np.logaddexp(0, beta[None, :] - beta[:, None])).sum())


def _is_separated(wins: Array) -> bool:
    """Whether some things never lose to the others, so that no maximum exists."""
    number, _ = connected_components(wins > 0, directed=True, connection="strong")
    return bool(number > 1)
