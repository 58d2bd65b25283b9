"""Frames of a clip in a film: one camera or several side by side, with the strip below."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import AbstractContextManager
from dataclasses import dataclass
from itertools import pairwise
from queue import SimpleQueue

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.export.pictures.camerawork import cameras
from azee.export.pictures.posed import SAMPLES
from azee.export.pictures.renderer import Canvas, Renderer, canvases
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

    samples: of a pixel, each way. renderer: who draws the body; `resolved` finds it for `auto`.
    Raises: ValueError: no camera. NoRoomError.
    """

    size: tuple[int, int] = (1280, 720)
    shots: tuple[str, ...] = ("front",)
    captions: bool = True
    transparent: bool = False
    samples: int = SAMPLES
    renderer: Renderer = "software"

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

    def canvases(self, threads: int = 1) -> AbstractContextManager[list[list[Canvas]]]:
        """Give a canvas per panel to each of so many threads. Raises: NoOpenGLError, on entry."""
        look = self.look
        return canvases(look.renderer, self.rig.mesh, self.panels, look.samples, threads)

    def frame(self, index: int, canvases: Sequence[Canvas]) -> Pixels:
        """Return a frame, (H, W, 3), or (H, W, 4) if it is transparent."""
        return self._captioned(index, self._drawn(index, canvases))

    def _drawn(self, index: int, canvases: Sequence[Canvas]) -> Pixels:
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
        """Yield frames in order, drawn by as many threads as there are processors.

        Raises: NoOpenGLError, with the first frame.
        """
        chosen = list(range(len(self.clip.times)) if indices is None else indices)
        workers = max(1, min(MOST_THREADS, os.cpu_count() or 1, len(chosen)))
        with self.canvases(workers) as of_threads, ThreadPoolExecutor(workers) as pool:
            free: SimpleQueue[list[Canvas]] = SimpleQueue()
            for own in of_threads:
                free.put(own)

            def drawn(index: int) -> Pixels:
                own = free.get()
                try:
                    return self._drawn(index, own)
                finally:
                    free.put(own)

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
