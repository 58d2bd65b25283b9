"""A BVH reader that knows nothing of azee: the grammar of Gürel 2010, figure B.2, no more."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray


class PlainBvh:
    """A file's joints in the order in which it lists them, and its frames."""

    def __init__(self, text: str) -> None:
        self._words = iter(text.split())
        self.names: list[str] = []
        self.parents: list[int] = []
        self.offsets: list[list[float]] = []
        self.channels: list[list[str]] = []
        self.end_sites: list[list[float]] = []
        self._expect("HIERARCHY", "ROOT")
        self._joint(-1)
        self._expect("MOTION", "Frames:")
        frames = int(next(self._words))
        self._expect("Frame", "Time:")
        self.frame_time = float(next(self._words))
        values = np.array([float(word) for word in self._words])
        self.rows = values.reshape(frames, sum(map(len, self.channels)))

    def _expect(self, *words: str) -> None:
        for word in words:
            assert next(self._words) == word

    def _numbers(self) -> list[float]:
        return [float(next(self._words)) for _ in range(3)]

    def _joint(self, parent: int) -> None:
        name = next(self._words)
        assert re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name)
        assert name not in self.names
        self.names.append(name)
        self.parents.append(parent)
        me = len(self.names) - 1
        self._expect("{", "OFFSET")
        self.offsets.append(self._numbers())
        self._expect("CHANNELS")
        self.channels.append([next(self._words) for _ in range(int(next(self._words)))])
        while (word := next(self._words)) != "}":
            if word == "JOINT":
                self._joint(me)
                continue
            assert word == "End"
            self._expect("Site", "{", "OFFSET")
            self.end_sites.append(self._numbers())
            self._expect("}")

    def positions(self) -> NDArray[np.float64]:
        """World positions, (frames, joints, 3), in the file's units; channels apply in order."""
        out = np.zeros((len(self.rows), len(self.names), 3))
        for f, row in enumerate(self.rows):
            numbers = iter(row)
            frames: list[NDArray[np.float64]] = []
            for j, channels in enumerate(self.channels):
                local = np.eye(4)
                local[:3, 3] = self.offsets[j]
                for channel in channels:
                    local = local @ _matrix(channel, float(next(numbers)))
                frames.append(local if self.parents[j] < 0 else frames[self.parents[j]] @ local)
                out[f, j] = frames[j][:3, 3]
        return out


def _matrix(channel: str, value: float) -> NDArray[np.float64]:
    matrix = np.eye(4)
    axis = "XYZ".index(channel[0])
    if channel.endswith("position"):
        matrix[axis, 3] = value
        return matrix
    c, s = np.cos(np.radians(value)), np.sin(np.radians(value))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix[i, i], matrix[i, j], matrix[j, i], matrix[j, j] = c, -s, s, c
    return matrix
