"""Joins clips: the decay of each is blended with the attack of the next.

Gürel 2010, §4.1.3: signs S₁ … Sₘ of durations D₁ … Dₘ begin and end with an attack and a decay of
the same length a, outside of their meaning. Sign n + 1 starts with the decay of sign n, at

    E′ₙ = Σᵢ₌₁ⁿ (Dᵢ − a)

In between, the two are averaged on the vector of parameters, with weights that sum to 1:

    T′(t) = (E′ₙ + a − t)/a · Sₙ(t − E′ₙ₋₁) + (t − E′ₙ)/a · Sₙ₊₁(t − E′ₙ),  E′ₙ < t < E′ₙ + a

The thesis prints E′ₙ without brackets. If a is subtracted only once, T′ samples every sign except
the first up to a beyond its end; so the sum is over Dᵢ − a (ADR 35).

`linear` is T′ exactly; its speed jumps at both ends of a blend (§5.1.3). `smooth` replaces the
linear weight by minimum jerk. Its first and second derivatives are zero at both ends, so that T′ is
C². In both, hands that fall in a decay and rise in an attack still fall half the way. `direct`
leaves out what the two do meanwhile: from where the blend starts to where it ends leads one
movement of least jerk, which takes over the velocity at both ends (`azee.clip.quintic`).

Overlaps need not be the same everywhere: sign n then has its own aₙ with the next.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from azee.clip.clip import Clip
from azee.clip.edit import shifted
from azee.clip.quintic import STEP_S, State, quintic
from azee.clip.resample import EVEN_S, frame_count, rate, sampled
from azee.clip.spline import minimum_jerk
from azee_rig.coordinates import Coordinates

Array = NDArray[np.float64]
Blend = Literal["linear", "smooth", "direct"]

ROOT = 6
"""Number of parameters of a root joint: its place and its turn."""


def repositioned(parameters: ArrayLike) -> Array:
    """Return motion (…, P) with its first six parameters zero: the root's place and turn.

    So the signer stands at the origin, faces +Z, and does not float while signs are blended; the
    movement of the limbs stays (Gürel 2010, §3.2.3). A `Clip` has no root and does not need this.
    """
    out = np.array(parameters, dtype=np.float64)
    out[..., :ROOT] = 0.0
    return out


@dataclass(frozen=True, eq=False)
class Concatenation:
    """T′(t) of some clips: a movement that can be sampled at any time from 0 to `duration_s`.

    clips: at least one; the times of all count from 0.
    overlap_s: a, the length of attacks and decays, or one for each two neighbours; 0 sets clips end
    to end.
    """

    clips: tuple[Clip, ...]
    coordinates: Coordinates
    overlap_s: float | tuple[float, ...] = 0.0
    blend: Blend = "smooth"

    def __post_init__(self) -> None:
        if not self.clips:
            raise ValueError("there is no clip to join")
        blends = get_args(Blend)
        if self.blend not in blends:
            raise ValueError(f"there is no blend '{self.blend}'; there are: {', '.join(blends)}")
        if isinstance(self.overlap_s, tuple) and len(self.overlap_s) != len(self.clips) - 1:
            raise ValueError("there is not one overlap for each two neighbours")
        given = self.overlap_s if isinstance(self.overlap_s, tuple) else (self.overlap_s,)
        for overlap_s in given:
            if not (np.isfinite(overlap_s) and overlap_s >= 0.0):
                raise ValueError(f"clips cannot overlap by {overlap_s:g} s")
        around = (0.0, *self.overlaps_s, 0.0)
        for n, clip in enumerate(self.clips):
            needed = around[n] + around[n + 1]
            if clip.duration_s < needed * (1.0 - 1e-12):
                raise ValueError(
                    f"clip {n + 1} lasts {clip.duration_s:g} s, less than the {needed:g} s "
                    "in which it is blended with its neighbours"
                )
        at_zero = tuple(shifted(clip, -float(clip.times[0])) for clip in self.clips)
        object.__setattr__(self, "clips", at_zero)

    @property
    def overlaps_s(self) -> tuple[float, ...]:
        """How long each clip but the last is blended with the next."""
        if isinstance(self.overlap_s, tuple):
            return self.overlap_s
        return (float(self.overlap_s),) * (len(self.clips) - 1)

    @property
    def starts_s(self) -> tuple[float, ...]:
        """Start times of the clips: 0, E′₁, …, E′ₘ₋₁."""
        lengths = [c.duration_s - a for c, a in zip(self.clips, self.overlaps_s, strict=False)]
        return tuple(float(e) for e in np.cumsum([0.0, *lengths]))

    @property
    def duration_s(self) -> float:
        """End of the last clip: E′ₘ + a."""
        return self.starts_s[-1] + self.clips[-1].duration_s

    @property
    def units(self) -> tuple[str, ...]:
        """All face units that any of the clips moves."""
        return tuple(dict.fromkeys(unit for clip in self.clips for unit in clip.units))

    def sample(self, times: ArrayLike) -> Array:
        """Return T′ at increasing times (T,): coordinates and weights of `units`, (T, V + M)."""
        t = np.asarray(times, dtype=np.float64)
        out = np.zeros((len(t), len(self.coordinates) + len(self.units)))
        starts, overlaps = self.starts_s, self.overlaps_s
        for n, (clip, start) in enumerate(zip(self.clips, starts, strict=True)):
            weight = np.ones_like(t)
            if n > 0:
                weight = self._weight(t - start, overlaps[n - 1])
            if n < len(self.clips) - 1:
                weight = weight - self._weight(t - starts[n + 1], overlaps[n])
            used = weight != 0.0
            if used.any():
                out[used] += weight[used, None] * self._parameters(clip, t[used] - start)
        if self.blend == "direct":
            self._lead_over(t, out)
        return out

    def _lead_over(self, t: Array, out: Array) -> None:
        """Fill in the times of blends with movements from the one clip to the other."""
        for n, (a, start) in enumerate(zip(self.overlaps_s, self.starts_s[1:], strict=True)):
            inside = (t >= start) & (t < start + a)
            if inside.any():
                leaving = self._state(self.clips[n], self.clips[n].duration_s - a)
                arriving = self._state(self.clips[n + 1], a)
                out[inside] = quintic(leaving, arriving, a, t[inside] - start)

    def _state(self, clip: Clip, time_s: float) -> State:
        """Return the state of a clip at a time, (V + M,) each; at its very ends it stands."""
        around = np.array([time_s - STEP_S, time_s, time_s + STEP_S])
        return State.between(*self._parameters(clip, around))

    def clip(self, times: ArrayLike) -> Clip:
        """Return T′ as a clip with frames at some times; labels keep their clips' own times."""
        split = len(self.coordinates)
        values = self.sample(times)
        found = [
            label
            for clip, start in zip(self.clips, self.starts_s, strict=True)
            for label in shifted(clip, start).labels
        ]
        return Clip(
            np.asarray(times, dtype=np.float64),
            np.clip(values[:, :split], self.coordinates.lower, self.coordinates.upper),
            self.units,
            values[:, split:],
            tuple(sorted(found, key=lambda x: (x.start_s, x.depth))),
        )

    def _weight(self, since: Array, overlap_s: float) -> Array:
        """Return the weight of a clip at a time after its start, before its decay; 1 from a on."""
        if overlap_s == 0.0 or self.blend == "direct":
            return np.where(since >= 0.0, 1.0, 0.0)
        share = np.clip(since / overlap_s, 0.0, 1.0)
        return share if self.blend == "linear" else minimum_jerk(share)

    def _parameters(self, clip: Clip, times: Array) -> Array:
        """Return Sₙ at some times, (T, V + M)."""
        found = sampled(clip, times, self.coordinates)
        weights = np.zeros((len(times), len(self.units)))
        weights[:, [self.units.index(unit) for unit in clip.units]] = found.unit_weights
        return np.hstack([found.coordinates, weights])


def joined(
    clips: Sequence[Clip],
    coordinates: Coordinates,
    *,
    overlap_s: float = 0.0,
    blend: Blend = "smooth",
    fps: float | None = None,
) -> Clip:
    """Return clips joined to one, from 0 on.

    Args: fps: of the result; by default the frames of the clips, and in an overlap those of both.
    Raises: ValueError: there is nothing to join, or a clip is shorter than its blends.
        TooManyFramesError: of too many frames.
    """
    whole = Concatenation(tuple(clips), coordinates, overlap_s, blend)
    if fps is not None:
        return whole.clip(np.arange(frame_count(whole.duration_s, fps)) / fps)
    starts = zip(whole.clips, whole.starts_s, strict=True)
    times = np.concatenate([clip.times + start for clip, start in starts])
    return whole.clip(_apart(np.sort(times)))


def common_rate(clips: Sequence[Clip]) -> float | None:
    """Return the frames per second of all clips, None if they differ or none has any."""
    rates = [rate(clip) for clip in clips if len(clip.times) > 1]
    if not rates or any(r is None for r in rates):
        return None
    known = [r for r in rates if r is not None]
    return known[0] if all(abs(a - b) < 1e-3 for a, b in pairwise(known)) else None


def _apart(times: Array) -> Array:
    """Leave out times that a rounding error alone tells from the one before."""
    return np.asarray(times[np.r_[True, np.diff(times) > EVEN_S]])
