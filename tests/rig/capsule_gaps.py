"""Gaps between capsules, and postures of the gallery, for the tests of this folder."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee_rig.rig import Rig

Floats = NDArray[np.float64]
POSTURES = json.loads(
    (Path(__file__).parents[2] / "docs" / "rig" / "postures.json").read_text(encoding="utf-8")
)


def posture(rig: Rig, *layers: Mapping[str, float]) -> Floats:
    """Idle with some coordinates set in degrees; `{S}` is both sides."""
    q = np.array(rig.coordinates.idle)
    for layer in layers:
        for name, degrees in layer.items():
            for side in "LR" if "{S}" in name else [""]:
                q[rig.coordinates.index[name.format(S=side)]] = np.radians(degrees)
    return q


def gaps(rig: Rig, q: Floats, pairs: NDArray[np.int64]) -> Floats:
    """Distance between the surfaces of each pair of capsules, metres; negative inside."""
    capsules, frames = rig.capsules, rig.chain.frames(q)
    R, p = frames.rotations[capsules.node], frames.positions[capsules.node]
    a = p + (R @ capsules.a[:, :, None])[:, :, 0]
    b = p + (R @ capsules.b[:, :, None])[:, :, 0]
    return np.array(
        [
            segment_distance(a[i], b[i], a[j], b[j]) - capsules.radius[i] - capsules.radius[j]
            for i, j in pairs
        ]
    )


def segment_distance(a: Floats, b: Floats, c: Floats, d: Floats) -> float:
    """Least distance of two segments: their ends against each other, and their insides."""
    best = min(
        _to_segment(a, c, d), _to_segment(b, c, d), _to_segment(c, a, b), _to_segment(d, a, b)
    )
    u, v, w = b - a, d - c, a - c
    square = (u @ u) * (v @ v) - (u @ v) ** 2
    if square > 1e-15:
        s = ((u @ v) * (v @ w) - (v @ v) * (u @ w)) / square
        t = ((u @ u) * (v @ w) - (u @ v) * (u @ w)) / square
        if 0.0 <= s <= 1.0 and 0.0 <= t <= 1.0:
            best = min(best, float(np.linalg.norm(w + s * u - t * v)))
    return best


def _to_segment(p: Floats, a: Floats, b: Floats) -> float:
    t = np.clip((p - a) @ (b - a) / max(float((b - a) @ (b - a)), 1e-15), 0.0, 1.0)
    return float(np.linalg.norm(p - a - t * (b - a)))
