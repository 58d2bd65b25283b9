"""How many examples a law is tried on: `@settings(max_examples=examples(0.5))`."""

from __future__ import annotations

from hypothesis import settings


def examples(share: float) -> int:
    """So many times as many as Hypothesis' profile takes: see `conftest.py`."""
    return max(1, round(share * settings().max_examples))
