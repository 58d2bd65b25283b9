"""Signs one after the other, each with an attack and a decay of its own (Gürel 2010, §4.1.3).

The thesis gives all signs the same attack and decay a, of a second. Here the decay of a sign and
the attack of the next may differ: they are blended for aₙ = min(decay, attack), beginning where the
meaning of the first ends. What the longer of them has more is left out, so that where all are
the same it is the printed formula.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.clip.blend import Blend, Concatenation
from azee.clip.clip import Clip, Label
from azee.clip.edit import cut, shifted
from azee.clip.resample import frame_count
from azee_rig.coordinates import Coordinates

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class PlayedSign:
    """A sign of a sequence. attack_s, decay_s: parts of the clip outside of what it means.

    name: what viewers read while it plays; none for idling.
    """

    name: str | None
    clip: Clip
    attack_s: float
    decay_s: float

    def part(self, attack_s: float, decay_s: float, coordinates: Coordinates) -> Clip:
        """Return what of it is played if only so much of attack and decay is."""
        clip = shifted(self.clip, -float(self.clip.times[0]))
        start = max(0.0, self.attack_s - attack_s)
        end = min(clip.duration_s, clip.duration_s - self.decay_s + decay_s)
        return cut(clip, min(start, end), end, coordinates)


@dataclass(frozen=True, slots=True, eq=False)
class Played:
    """A sequence as one movement.

    names, starts_s, ends_s: of the signs, ways into them and out of them halved between neighbours.
    bodies_s: from when to when each is what was recorded.
    """

    clip: Clip
    names: tuple[str, ...]
    starts_s: tuple[float, ...]
    ends_s: tuple[float, ...]
    bodies_s: tuple[tuple[float, float], ...]


def played(
    signs: Sequence[PlayedSign],
    coordinates: Coordinates,
    *,
    blend: Blend,
    fps: float,
    transition_s: float | None = None,
) -> Played:
    """Play signs one after the other.

    Args: transition_s: the most time from one sign to the next; by default what attack and decay
        leave.
    Raises: ValueError: there is nothing to play. TooManyFramesError.
    """
    if not signs:
        raise ValueError("there is no sign to play")
    most = float("inf") if transition_s is None else transition_s
    ways = [min(a.decay_s, b.attack_s, most) for a, b in pairwise(signs)]
    before, after = [signs[0].attack_s, *ways], [*ways, signs[-1].decay_s]
    parts = [sign.part(a, d, coordinates) for sign, a, d in zip(signs, before, after, strict=True)]
    whole = Concatenation(tuple(parts), coordinates, tuple(ways), blend)
    clip = whole.clip(np.arange(frame_count(whole.duration_s, fps)) / fps)
    names, spans, bodies = [], [], []
    for n, (sign, start) in enumerate(zip(signs, whole.starts_s, strict=True)):
        end = start + parts[n].duration_s
        if sign.name is not None:
            names.append(sign.name)
            spans.append((start + before[n] / 2, end - after[n] / 2))
            bodies.append((start + before[n], end - after[n]))
    labels = tuple(Label((name,), a, b) for name, (a, b) in zip(names, spans, strict=True))
    return Played(
        replace(clip, labels=labels),
        tuple(names),
        tuple(a for a, _ in spans),
        tuple(b for _, b in spans),
        tuple(bodies),
    )
