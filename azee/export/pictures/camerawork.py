"""Cameras over the time of a clip: a camera for each frame.

Body and face are seen from one place, as by a viewer. Close-ups follow the hands smoothly and a
little late, as a camera operator does.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.export.pictures.camera import Camera, camera, from_direction
from azee.export.pictures.shots import SHOTS
from azee_rig.rig import Rig

Floats = NDArray[np.float64]

FOLLOW_S = 0.25
"""Standard deviation of the Gaussian that smooths the target of the camera."""
AWAY_M = 0.05, 0.2
"""Between these distances from its idle place, a hand gradually enters the close-up."""
PALM_M = 0.075
"""From the wrist to about the middle of the hand."""
MARGIN_M = 0.17
"""Margin around the middles of the hands."""
CLOSER = 0.86
"""Distance of a film's cameras, relative to the still ones; the upper edge stays the same."""
STEADY = ("whole", "back", "front", "side", "three-quarter")


def cameras(clip: Clip, rig: Rig, shot: str, aspect: float) -> list[Camera]:
    """Return a camera for every frame.

    Args: aspect: width by height of the picture. Raises: KeyError: no such shot.
    """
    if shot not in SHOTS:
        raise KeyError(shot)
    if shot in STEADY:
        return [_closer(camera(rig, rig.coordinates.idle, shot), shot)] * len(clip.times)
    if shot == "face":
        return _following_face(clip, rig)
    sides = {"hands": "RL", "right hand": "R", "left hand": "L"}[shot]
    return _following_hands(clip, rig, sides, aspect)


def _closer(still: Camera, shot: str) -> Camera:
    """Leave out the legs, but not the space above the head, where hands may be."""
    if shot == "whole":
        return still
    way = still.eye - still.target
    raised = (1.0 - CLOSER) * np.linalg.norm(way) * np.tan(still.height_rad / 2.0)
    target = still.target + np.array([0.0, raised, 0.0])
    return Camera(target + CLOSER * way, target, still.height_rad)


def _following_face(clip: Clip, rig: Rig) -> list[Camera]:
    still = camera(rig, rig.coordinates.idle, "face")
    nodes = [rig.bones[f"eye_{side}"].node for side in "LR"]
    eyes = rig.chain.frames(clip.coordinates).positions[:, nodes].mean(axis=1)
    rest = rig.chain.frames(rig.coordinates.idle).positions[nodes].mean(axis=0)
    way = _smoothed(clip.times, eyes - rest)
    return [Camera(still.eye + w, still.target + w, still.height_rad) for w in way]


def _following_hands(clip: Clip, rig: Rig, sides: str, aspect: float) -> list[Camera]:
    """Look at the hands that are away from idle, so near that both are in the picture."""
    middles = np.stack([_middles(rig, clip.coordinates, side) for side in sides], axis=1)
    rests = np.stack([_middles(rig, rig.coordinates.idle[None], side)[0] for side in sides])
    away = np.linalg.norm(middles - rests, axis=2)
    busy = np.clip((away - AWAY_M[0]) / (AWAY_M[1] - AWAY_M[0]), 0.0, 1.0) + 1e-3
    busy /= busy.max(axis=1, keepdims=True)
    target = (busy[..., None] * middles).sum(axis=1) / busy.sum(axis=1)[:, None]
    apart = np.abs(middles - target[:, None]) * busy[..., None]
    half = MARGIN_M + np.maximum(
        apart[..., 1].max(axis=1), apart[..., 0].max(axis=1) / max(aspect, 1e-3)
    )
    target, half = (_smoothed(clip.times, values) for values in (target, half))
    towards = np.array([0.0, 0.1, 1.0])
    return [from_direction(t, towards, float(h)) for t, h in zip(target, half, strict=True)]


def _middles(rig: Rig, q: Floats, side: str) -> Floats:
    """Return the middles of a hand, (T, 3)."""
    node = rig.bones[f"palm_{side}"].node
    frames = rig.chain.frames(q)
    return np.asarray(frames.positions[:, node] + PALM_M * frames.rotations[:, node, :, 1])


def _smoothed(times: Floats, values: Floats) -> Floats:
    """Return weighted means over the neighbouring frames, (T, …); beyond the ends nothing moves."""
    step = float(np.median(np.diff(times))) if len(times) > 1 else 1.0
    reach = int(np.ceil(3 * FOLLOW_S / step))
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) * step / FOLLOW_S) ** 2)
    weights /= weights.sum()
    flat = values.reshape(len(values), -1)
    padded = np.pad(flat, ((reach, reach), (0, 0)), mode="edge")
    columns = [np.convolve(column, weights, mode="valid") for column in padded.T]
    return np.stack(columns, axis=1).reshape(values.shape)
