"""Landmarks of a clip before a camera, in MediaPipe's measures.

- x and y are pixels from the upper left of the picture, y downwards.
- z is a depth in widths of the picture, smaller towards the camera. It counts from the middle of
  the hips for the body, from the wrist for a hand, from the middle of its points for the face.
  The scale is that of the picture at the distance of that origin.
- World points are metres from the middle of the hips along the camera's axes: x to the right of
  the picture, y downwards, z away from the camera.
- The confidence of a point of the body is 1 inside of the picture and 0 outside. A hand or a face
  is found as a whole: where half of its points are in the picture and, for a face, where it is
  turned to the camera. What is not found is zero. What hides behind the body counts as found.

Noise and losses are laid on all that: the same seed gives the same numbers.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate, pairwise

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.clip.resample import at_rate
from azee.export.landmarks.layout import BODY, COMPONENTS, COUNT
from azee.export.landmarks.points import world_points
from azee.export.pictures.camera import Camera
from azee.export.pictures.camerawork import cameras
from azee.export.pictures.shots import SHOTS
from azee_rig.rig import Rig

Floats = NDArray[np.float64]

HIPS = (BODY.index("LEFT_HIP"), BODY.index("RIGHT_HIP"))
STARTS = tuple(accumulate((len(c.points) for c in COMPONENTS), initial=0))
"""Where each component begins among all points, and where the last one ends."""
FOUND = 0.5
"""Share of a hand or a face that must be in the picture."""
CHEEKS, CHIN_AND_FRONT = (234, 454), (152, 10)
"""Landmarks of the face that tell where it looks."""
TURNED_AWAY = -0.25
"""Cosine of the angle between face and camera below which there is no face to be found."""


@dataclass(frozen=True, slots=True)
class View:
    """How a clip is seen.

    shot: one of `SHOTS`. size: pixels. fps: frames a second. noise_px: standard deviation of
    pixels; depths and world points get the same, as lengths. dropout: share of hands, faces and
    single points of the body that are lost, each for itself in each frame. seed: of both.

    Raises: ValueError: a number is out of its range, or there is no such camera.
    """

    shot: str = "front"
    size: tuple[int, int] = (720, 720)
    fps: float = 25.0
    noise_px: float = 0.0
    dropout: float = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        if self.shot not in SHOTS:
            raise ValueError(f"there is no camera `{self.shot}`; there are {', '.join(SHOTS)}")
        if not all(16 <= side <= 8192 for side in self.size):
            raise ValueError("a picture has 16 to 8192 pixels each way")
        if not 0.0 < self.fps <= 1000.0:
            raise ValueError("a film has up to 1000 frames a second")
        if not 0.0 <= self.noise_px <= 1000.0:
            raise ValueError("noise is a number of pixels")
        if not 0.0 <= self.dropout <= 1.0:
            raise ValueError("a share is a number from 0 to 1")
        if self.seed < 0:
            raise ValueError("a seed is not negative")


@dataclass(frozen=True, eq=False)
class Landmarks:
    """All points of `COMPONENTS` in T frames: values (T, 576, 3) and confidence (T, 576)."""

    view: View
    values: Floats
    confidence: Floats

    def component(self, name: str) -> tuple[Floats, Floats]:
        """Return values and confidence of one component. Raises: KeyError: there is none."""
        for component, (start, end) in zip(COMPONENTS, pairwise(STARTS), strict=True):
            if component.name == name:
                return self.values[:, start:end], self.confidence[:, start:end]
        raise KeyError(name)


def landmarks(clip: Clip, rig: Rig, view: View | None = None) -> Landmarks:
    """Return what a tracker without fault would find in a film of a clip.

    Raises: TooManyFramesError.
    """
    view = view or View()
    even = at_rate(clip, view.fps, rig.coordinates)
    points, has = world_points(even, rig)
    width, height = view.size
    seen = _Seen(points, cameras(even, rig, view.shot, width / height), view)
    values = np.empty((len(points), COUNT, 3))
    confidence = np.zeros((len(points), COUNT))
    inside, hips = seen.inside & has, points[:, HIPS].mean(axis=1, keepdims=True)
    for n, (start, end) in enumerate(pairwise(STARTS[:-1])):
        rows = slice(start, end)
        values[:, rows, :2] = seen.pixels[:, rows]
        origins = (hips[:, 0], points[:, rows].mean(axis=1), points[:, start])
        values[:, rows, 2] = seen.depths(points[:, rows], origins[min(n, 2)])
        if n == 0:
            confidence[:, rows] = inside[:, rows]
        else:
            found = inside[:, rows].sum(axis=1) >= FOUND * (end - start)
            if n == 1:
                found &= seen.faces(points[:, rows])
            confidence[:, rows] = found[:, None] & has[rows]
    world = slice(STARTS[-2], STARTS[-1])
    values[:, world] = seen.turned(points[:, : len(BODY)] - hips) * (1.0, -1.0, -1.0)
    confidence[:, world] = confidence[:, : len(BODY)]
    _spoil(values, confidence, seen, hips[:, 0], view)
    values[:, len(BODY) : STARTS[-2]][confidence[:, len(BODY) : STARTS[-2]] == 0.0] = 0.0
    return Landmarks(view, values, confidence)


class _Seen:
    """Points (T, P, 3) before a camera for each frame."""

    def __init__(self, points: Floats, eyes: list[Camera], view: View) -> None:
        self.eye = np.stack([eye.eye for eye in eyes])
        self.axes = np.stack([eye.axes for eye in eyes])
        self.width, self.height = view.size
        self.focal = np.array([self.height / 2.0 / np.tan(e.height_rad / 2.0) for e in eyes])
        local = self.turned(points - self.eye[:, None])
        away = np.maximum(-local[..., 2], 0.01)
        scale = (self.focal[:, None] / away)[..., None]
        self.pixels = (self.width / 2.0, self.height / 2.0) + scale * local[..., :2] * (1.0, -1.0)
        self.inside = ((self.pixels >= 0.0) & (self.pixels < view.size)).all(axis=2)
        self.inside &= -local[..., 2] > 0.01

    def turned(self, vectors: Floats) -> Floats:
        """Vectors (T, P, 3) along the camera's axes: right, up, backward."""
        return np.asarray(np.einsum("tab,tpb->tpa", self.axes, vectors))

    def scale(self, origin: Floats) -> Floats:
        """Pixels a metre has at some points (T, 3), (T,)."""
        back = self.axes[:, 2]
        away = -np.einsum("tb,tb->t", back, origin - self.eye)
        return np.asarray(self.focal / np.maximum(away, 0.01))

    def depths(self, points: Floats, origin: Floats) -> Floats:
        """Depths (T, P) of points (T, P, 3) beyond others (T, 3), in widths of the picture."""
        beyond = -self.turned(points - origin[:, None])[..., 2]
        return np.asarray(beyond * self.scale(origin)[:, None] / self.width)

    def faces(self, face: Floats) -> NDArray[np.bool_]:
        """Whether faces (T, 468, 3) are turned to the camera, (T,)."""
        across = face[:, CHEEKS[1]] - face[:, CHEEKS[0]]
        up = face[:, CHIN_AND_FRONT[1]] - face[:, CHIN_AND_FRONT[0]]
        ahead = np.cross(across, up)
        towards = self.eye - face.mean(axis=1)
        cosine = (ahead * towards).sum(axis=1)
        lengths = np.linalg.norm(ahead, axis=1) * np.linalg.norm(towards, axis=1)
        return np.asarray(cosine > TURNED_AWAY * lengths)


def _spoil(values: Floats, confidence: Floats, seen: _Seen, hips: Floats, view: View) -> None:
    """Lay noise and losses on what is seen, in place."""
    rng = np.random.default_rng(view.seed)
    world = slice(STARTS[-2], STARTS[-1])
    if view.noise_px:
        noise = rng.normal(0.0, view.noise_px, values.shape)
        noise[..., 2] /= view.size[0]
        noise[:, world] = rng.normal(0.0, view.noise_px, noise[:, world].shape)
        noise[:, world] /= seen.scale(hips)[:, None, None]
        values += noise
    if view.dropout:
        frames = len(values)
        body = rng.random((frames, len(BODY))) < view.dropout
        confidence[:, : len(BODY)][body] = 0.0
        confidence[:, world][body] = 0.0
        for start, end in pairwise(STARTS[1:-1]):
            confidence[rng.random(frames) < view.dropout, start:end] = 0.0
