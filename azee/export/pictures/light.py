"""The light in pictures: where it comes from, its colours, and the view from the key light."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

SUN = np.array([0.28, 0.72, 0.95]) / np.linalg.norm([0.28, 0.72, 0.95])
"""The unit direction towards the key light, (3,)."""
LIGHTS = np.array(
    [
        [1.75, 1.68, 1.58],  # key
        [0.62, 0.66, 0.74],  # sky
        [0.30, 0.27, 0.25],  # ground
        [0.35, 0.38, 0.42],  # rim
    ]
)
BACKGROUND = (0.72, 0.76, 0.80), (0.90, 0.92, 0.94)
"""Colours at the top and at the bottom of a picture, sRGB."""
SHADOW_SAMPLES = 1024
SHADOW_TILES = np.array([2, 4, 8, 16, 32])
"""Sides, in samples, of tiles in which depths of the shadow buffer are summed up."""
SHADOW_MARGIN_M = 0.25
"""How far outside of the picture something may be and still throw a shadow into it."""


def background(height: int) -> Floats:
    """Return the linear colours of the background by row, (height, 3), from the top."""
    top, bottom = (np.array(c) ** 2.2 for c in BACKGROUND)
    rows: Floats = top + np.linspace(0.0, 1.0, height)[:, None] * (bottom - top)
    return rows


def encoding() -> Floats:
    """Return a table over [0, 1] of the encoding of sRGB (IEC 61966-2-1)."""
    steps = np.linspace(0.0, 1.0, 4097)
    return np.where(steps <= 0.0031308, 12.92 * steps, 1.055 * steps ** (1.0 / 2.4) - 0.055)


def shadow_map(target: Floats, reach_m: float) -> Floats:
    """Return what maps a place to samples x, y and depth in metres of the key light's view.

    Args: target: (3,) the middle of that view. reach_m: from there to its edges.
    Returns: (4, 3) rows that a place is multiplied with, and their constants.
    """
    right = np.cross([0.0, 1.0, 0.0], SUN)
    right = right / np.linalg.norm(right)
    up = np.cross(SUN, right)
    per_metre = SHADOW_SAMPLES / 2.0 / reach_m
    rows = np.stack([right * per_metre, -up * per_metre, -SUN])
    constant = np.array([SHADOW_SAMPLES / 2.0, SHADOW_SAMPLES / 2.0, 0.0]) - rows @ target
    return np.ascontiguousarray(np.concatenate([rows, constant[None]]))
