"""A recording of a hand that tests use, and which of its markers they record."""

from __future__ import annotations

from pathlib import Path

import numpy as np

FILE = Path(__file__).with_name("optical_markers.npz")
LEARNT = 840
CHOSEN = ("thumb_tip", "index_tip", "middle_tip", "ring_tip", "little_tip", "ring_middle")


def away(made: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """How far markers are off, metres."""
    return np.asarray(np.linalg.norm(made - truth, axis=-1))
