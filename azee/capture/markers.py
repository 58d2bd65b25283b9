"""Recorded markers: points in space over time, some of which are not seen now and then."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

LEAST_HZ, MOST_HZ = 5.0, 5000.0
"""Rates of cameras; others come of a mistake."""
FARTHEST_M = 1000.0
"""No marker is farther from the origin."""


class MarkersError(ValueError):
    """Markers cannot be used; `remedy` says what to do about it, if that is known."""

    def __init__(self, message: str, remedy: str | None = None) -> None:
        super().__init__(message)
        self.remedy = remedy


@dataclass(frozen=True, eq=False)
class Markers:
    """Markers of one recording.

    names: of the M markers. positions: (T, M, 3) metres in the frame of the room, NaN where a
    marker is not seen. rate_hz: frames a second. source: the file they come from, with its digest.

    Raises: MarkersError: names are not unique, numbers are infinite, or the rate is none.
    """

    names: tuple[str, ...]
    positions: Floats
    rate_hz: float
    source: str = ""

    def __post_init__(self) -> None:
        array = np.array(self.positions, dtype=np.float64)
        if array.ndim != 3 or array.shape[1:] != (len(self.names), 3):
            raise MarkersError(f"{len(self.names)} names do not fit positions {array.shape}")
        if not array.size:
            raise MarkersError("there are no markers in it")
        twice = sorted({name for name in self.names if self.names.count(name) > 1})
        if twice:
            raise MarkersError(f"two markers are called `{twice[0]}`")
        if not (np.isfinite(self.rate_hz) and LEAST_HZ <= self.rate_hz <= MOST_HZ):
            raise MarkersError(
                f"{self.rate_hz:g} frames a second is no rate of a recording",
                "name the right one with --rate",
            )
        array[np.isnan(array).any(axis=2)] = np.nan
        if np.isinf(array).any() or np.nanmax(np.abs(array), initial=0.0) > FARTHEST_M:
            raise MarkersError(
                f"markers are more than {FARTHEST_M:g} m away",
                "name the right unit with --unit",
            )
        array.setflags(write=False)
        object.__setattr__(self, "positions", array)

    @property
    def seen(self) -> Flags:
        """Which markers are seen in which frames, (T, M)."""
        return np.asarray(~np.isnan(self.positions[:, :, 0]))

    def only(self, names: Sequence[str]) -> Markers:
        """Return some of the markers, in the order given. Raises: MarkersError: one is missing."""
        missing = [name for name in names if name not in self.names]
        if missing:
            raise MarkersError(
                f"there is no marker `{missing[0]}`; there are: {', '.join(self.names)}"
            )
        columns = [self.names.index(name) for name in names]
        return replace(self, names=tuple(names), positions=self.positions[:, columns])

    def frames(self, part: slice) -> Markers:
        """Return some of the frames."""
        return replace(self, positions=self.positions[part])


def plain_name(name: str) -> str:
    """Return a name without the subject before its colon, in small letters, joined by `_`."""
    words = name.rpartition(":")[2].replace("-", " ").replace("_", " ").replace(".", " ").split()
    return "_".join(words).lower()


def named_like(markers: Markers, wanted: Sequence[str]) -> Markers:
    """Return markers under the names of another recording, as far as they differ in writing only.

    `Ann:Index-Tip` is taken for `index_tip`. Markers that nobody wants keep their names.
    """
    by_plain = {plain_name(name): name for name in wanted}
    renamed = [
        name if name in wanted else by_plain.get(plain_name(name), name) for name in markers.names
    ]
    if len(set(renamed)) < len(renamed):
        return markers
    return replace(markers, names=tuple(renamed))
