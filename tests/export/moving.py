"""A short movement of arms, fingers, head, eyes and face, for formats."""

from __future__ import annotations

import numpy as np

from azee.clip.clip import Clip, Label
from azee_rig.rig import Rig

FPS = 25.0
FRAMES = 13


def moving(rig: Rig, seed: int = 3) -> Clip:
    """Half a second from the idle posture to another one, within the limits."""
    c = rig.coordinates
    rng = np.random.default_rng(seed)
    goal = c.idle + 0.4 * (rng.uniform(c.lower, c.upper) - c.idle)
    share = np.linspace(0.0, 1.0, FRAMES)[:, None]
    units = tuple(u for u in ("jawOpen", "browInnerUp", "mouthSmileLeft") if u in rig.units)
    weights = share * np.linspace(0.8, 0.3, len(units))
    times = np.arange(FRAMES) / FPS
    q = c.idle + share * (goal - c.idle)
    return Clip(times, q, units, weights, (Label(("moving",), 0.0, float(times[-1])),))
