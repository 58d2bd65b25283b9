"""Frames of a clip in a film: one camera or several side by side, with the strip below."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from itertools import pairwise
from queue import SimpleQueue

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.export.pictures.camerawork import cameras
from azee.export.pictures.canvas import SoftwareCanvas
from azee.export.pictures.posed import SAMPLES
from azee.export.pictures.strip import Strip
from azee_rig.rig import Rig
from azee_rig.skeleton import Pose

Pixels = NDArray[np.uint8]

MOST_THREADS = 8
LEAST = 16
"""The least pixels of a camera's panel, each way."""


class NoRoomError(ValueError):
    """The picture is too small for its content."""


@dataclass(frozen=True, slots=True)
class Look:
    """The look of frames: size in pixels, cameras from left to right, captions, background.

    Raises: ValueError: no camera. NoRoomError.
    """

    size: tuple[int, int] = (1280, 720)
    shots: tuple[str, ...] = ("front",)
    captions: bool = True
    transparent: bool = False
    samples: int = SAMPLES

    def __post_init__(self) -> None:
        if not self.shots:
            raise ValueError("a film needs a camera")
        if self.size[1] < LEAST or self.size[0] < LEAST * len(self.shots):
            raise NoRoomError(f"{self.size[0]}×{self.size[1]} pixels are too few")


class Scene:
    """A clip in front of its cameras."""

    def __init__(self, clip: Clip, rig: Rig, look: Look) -> None:
        """Prepare everything that is the same in all frames.

        Raises: KeyError: there is no camera of that name. NoRoomError: the captions leave none.
        """
        self.clip, self.rig, self.look = clip, rig, look
        width, height = look.size
        self.strip = Strip(clip.labels if look.captions else (), look.size)
        inner = height - self.strip.height
        if inner < LEAST:
            raise NoRoomError(f"{width}×{height} pixels leave no room above the captions")
        edges = np.linspace(0, width, len(look.shots) + 1).round().astype(int)
        self.panels = [(int(b - a), inner) for a, b in pairwise(edges)]
        self.cameras = [
            cameras(clip, rig, shot, w / h)
            for shot, (w, h) in zip(look.shots, self.panels, strict=True)
        ]
        self.poses = rig.pose(clip.coordinates)
        self.faces = np.zeros((len(clip.times), len(rig.units)))
        self.faces[:, [rig.units.index(unit) for unit in clip.units]] = clip.unit_weights

    def canvases(self) -> list[SoftwareCanvas]:
        """Return buffers for one thread: a canvas per panel."""
        return [SoftwareCanvas(self.rig.mesh, size, self.look.samples) for size in self.panels]

    def frame(self, index: int, canvases: list[SoftwareCanvas]) -> Pixels:
        """Return a frame, (H, W, 3), or (H, W, 4) if it is transparent."""
        return self._captioned(index, self._drawn(index, canvases))

    def _drawn(self, index: int, canvases: list[SoftwareCanvas]) -> Pixels:
        """Draw the views of the cameras side by side; several threads may call this at once."""
        root = np.broadcast_to(self.poses.root_translation, (len(self.clip.times), 3))[index]
        pose = Pose(root, self.poses.rotations[index])
        vertices = self.rig.skin(pose, self.faces[index])
        clear = self.look.transparent
        panels = [
            canvas.draw(vertices, shown[index], clear)
            for canvas, shown in zip(canvases, self.cameras, strict=True)
        ]
        return np.concatenate(panels, axis=1)

    def _captioned(self, index: int, drawn: Pixels) -> Pixels:
        """Put the strip under a frame."""
        if not self.strip.height:
            return drawn
        strip = self.strip.draw(float(self.clip.times[index]))
        return np.concatenate([drawn, strip[..., : drawn.shape[2]]], axis=0)

    def frames(self, indices: Iterable[int] | None = None) -> Iterator[Pixels]:
        """Yield frames in order, drawn by as many threads as there are processors."""
        chosen = list(range(len(self.clip.times)) if indices is None else indices)
        workers = max(1, min(MOST_THREADS, os.cpu_count() or 1, len(chosen)))
        free: SimpleQueue[list[SoftwareCanvas]] = SimpleQueue()
        for _ in range(workers):
            free.put(self.canvases())

        def drawn(index: int) -> Pixels:
            canvases = free.get()
            try:
                return self._drawn(index, canvases)
            finally:
                free.put(canvases)

        with ThreadPoolExecutor(workers) as pool:
            waiting: deque[tuple[int, Future[Pixels]]] = deque()
            try:
                for index in chosen:
                    waiting.append((index, pool.submit(drawn, index)))
                    if len(waiting) > 2 * workers:
                        yield self._next(waiting)
                while waiting:
                    yield self._next(waiting)
            finally:
                for _, left in waiting:
                    left.cancel()

    def _next(self, waiting: deque[tuple[int, Future[Pixels]]]) -> Pixels:
        index, drawn = waiting.popleft()
        return self._captioned(index, drawn.result())
