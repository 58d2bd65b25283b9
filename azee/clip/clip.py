"""Motion as data: coordinates and face weights over time, with labels."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee.clip.finite import check_numbers, check_times


@dataclass(frozen=True, slots=True)
class Label:
    """A named interval of a clip, such as a block of the score.

    path: names of the labels it stands in, outermost first, and its own, last.
    """

    path: tuple[str, ...]
    start_s: float
    end_s: float

    @property
    def text(self) -> str:
        """Its own name."""
        return self.path[-1]

    @property
    def depth(self) -> int:
        """Number of labels it stands in."""
        return len(self.path) - 1


@dataclass(frozen=True, eq=False)
class Clip:
    """Motion of one rig.

    times: (T,) seconds, increasing. coordinates: (T, V) radians, in the rig's order.
    units: names of the M face units that ever move; unit_weights: (T, M).
    labels: blocks and utterances, in order of start.

    Raises: ValueError: the arrays do not fit each other, or hold what is no number.
    """

    times: NDArray[np.float64]
    coordinates: NDArray[np.float64]
    units: tuple[str, ...]
    unit_weights: NDArray[np.float64]
    labels: tuple[Label, ...] = ()

    def __post_init__(self) -> None:
        frames = len(self.times)
        if (np.ndim(self.times), np.ndim(self.coordinates)) != (1, 2):
            raise ValueError("a clip has one time and one row of coordinates a frame")
        check_times(self.times)
        if len(self.coordinates) != frames or self.unit_weights.shape != (frames, len(self.units)):
            raise ValueError("times, coordinates and unit weights do not fit each other")
        check_numbers("coordinates", self.coordinates)
        check_numbers("weights of the face", self.unit_weights)
        check_numbers("times of labels", [t for x in self.labels for t in (x.start_s, x.end_s)])
        for name in ("times", "coordinates", "unit_weights"):
            array = np.array(getattr(self, name), dtype=np.float64)
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle and copy by the constructor, so that the arrays stay read-only."""
        return type(self), tuple(getattr(self, f.name) for f in fields(self))

    @property
    def duration_s(self) -> float:
        """Seconds from the first frame to the last."""
        return float(self.times[-1] - self.times[0])
