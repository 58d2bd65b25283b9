"""How many choices a comparison needs."""

from __future__ import annotations

import math

from scipy.stats import norm

PREFERENCE, SIGNIFICANCE, POWER = 0.60, 0.05, 0.80


def choices_needed(
    preference: float = PREFERENCE, significance: float = SIGNIFICANCE, power: float = POWER
) -> int:
    """Return how many choices between two types tell a preference from none.

    n = ((z₁₋α/₂ / 2 + z_power √(p (1 − p))) / (p − 1/2))², the normal approximation of a two-sided
    binomial test (Fleiss, Levin and Paik 2003, section 2.5).
    """
    z_alpha, z_power = norm.ppf(1 - significance / 2), norm.ppf(power)
    spread = z_alpha / 2 + z_power * math.sqrt(preference * (1 - preference))
    return math.ceil(float(spread / (preference - 0.5)) ** 2)


def participants_needed(words: int) -> int:
    """Return how many participants give these choices; each gives one a word and pair."""
    return math.ceil(choices_needed() / words)


def sentence(words: int) -> str:
    """Say it to people."""
    preference, power = round(100 * PREFERENCE), round(100 * POWER)
    return (
        f"To tell a preference of {preference} % from none with {power} % power, each pair of "
        f"types needs {choices_needed()} choices: {participants_needed(words)} participants."
    )
