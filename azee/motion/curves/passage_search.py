"""The search for a way of digits round each other between two handshapes, and what it has found.

Two via points of every digit that is free, an early and a late one, are sought by damped least
squares (see `OffsetSearch`). A search that starts from straight ways alone stays on the wrong side
of the finger. It is therefore started from several ways in which people do it (`_starts`), in the
order of what they cost, until one leads round.

What is found depends only on the hand's coordinates along the way, to `GRID_RAD`, and on how long
the way takes, to a millisecond: the same way on the same body is searched once in a process.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.capsule_overlap import CapsuleOverlaps
from azee.motion.curves.offset_search import Offset, OffsetSearch
from azee.motion.curves.thumb_skin import ThumbSkin
from azee.motion.curves.via_points import ViaPoint
from azee_rig.coordinates import Coordinates
from azee_solver.evaluate import Evaluator

Array = NDArray[np.float64]
Side: TypeAlias = Literal["L", "R"]

PEAKS = (0.3, 0.6)
"""When the early and the late via point are whole, as shares of the way."""
MOST_RAD_S, MOST_RAD_S2 = math.radians(1200.0), math.radians(40_000.0)
"""Largest speed and acceleration that an offset adds to a joint of a finger."""
PRICE_M = 0.002
"""An offset of one radian costs as much as this overlap in one sample."""
STEP_RAD = 0.35
ENOUGH_M = 0.0005
"""A way on which no pair lacks more is good."""
WORTHWHILE = 0.9
"""Offsets are used if they leave at most this share of the shortfall."""
TRIES = 8
"""So many starts are searched from."""
SLIGHT_M = 0.003
"""Where capsules lack less, the straight way is searched from first."""
ROUNDS = 4
"""So often the skin may say where capsules must be farther apart."""
SAMPLES = 16
"""On a way, its ends not counted."""
SHARES: Array = np.linspace(0.0, 1.0, SAMPLES + 2)
"""When a way is measured, as shares of its time: in even steps. Half-way all move fastest, and a
thumb crosses a finger within .03 s of .2 s; out of a touch it goes as fast, near an end."""
GRID_RAD = 0.0005
"""Ways are told apart by coordinates in steps of this: a fingertip moves by .1 mm."""
MOST_KNOWN = 4000
"""Ways that are remembered of a body; beyond, the oldest go."""

_OPEN = {
    **{f"{finger}_{{S}}_1.flexion": -0.35 for finger in ("index", "middle", "ring", "little")},
    **{f"{finger}_{{S}}_2.flexion": -0.5 for finger in ("index", "middle", "ring", "little")},
    **{f"{finger}_{{S}}_3.flexion": -0.2 for finger in ("index", "middle", "ring", "little")},
}
"""Fingers that let a thumb pass below them, radians."""
_ASIDE = {"thumb_{S}_1.flexion": -0.5, "thumb_{S}_3.flexion": -0.3}
"""A thumb beside the hand."""
_BEFORE = {"thumb_{S}_1.abduction": 0.5, "thumb_{S}_2.flexion": -0.3, "thumb_{S}_3.flexion": -0.4}
"""A thumb before the fingers."""


@dataclass(frozen=True, slots=True, eq=False)
class Hand:
    """The pairs of capsules of one hand's digits, and the coordinates that move them."""

    pairs: NDArray[np.int64]
    coordinates: NDArray[np.int64]
    thumb: ThumbSkin


class PassageSearch:
    """Finds offsets that lead the digits of one body round each other, and remembers them.

    overlaps: of the body's capsules. hands: by side.
    """

    def __init__(self, overlaps: CapsuleOverlaps, coordinates: Coordinates) -> None:
        self.overlaps, self._coordinates = overlaps, coordinates
        self.hands: Mapping[Side, Hand] = {side: _hand(overlaps, side) for side in ("L", "R")}
        self._known: dict[tuple[Side, int, bytes, bytes], Array | None] = {}

    def offsets(
        self, q: Array, members: NDArray[np.int64], span_s: float, side: Side
    ) -> Array | None:
        """Return the offsets of the early and the late via point, (2 n,); none if none helps.

        Args: q: (T, V) at the `SHARES` of the way. members: (n,) the coordinates that
            are free. span_s: how long the way takes.
        """
        own = self.hands[side].coordinates
        steps = np.round(q[:, own] / GRID_RAD).astype(np.int32)
        span_ms = max(1, round(1000 * span_s))
        way = (side, span_ms, members.tobytes(), steps.tobytes())
        if way not in self._known:
            body = self._coordinates
            at = np.tile(body.idle, (len(q), 1))
            at[:, own] = np.clip(GRID_RAD * steps, body.lower[own], body.upper[own])
            found = self._searched(at, members, span_ms / 1000, side)
            self._known[way] = found
            if len(self._known) > MOST_KNOWN:
                self._known.pop(next(iter(self._known)), None)
            return found
        return self._known[way]

    def _searched(
        self, q: Array, members: NDArray[np.int64], span_s: float, side: Side
    ) -> Array | None:
        bells = via_points(members, 0.0, span_s)
        weight = np.stack([bell.weight(span_s * SHARES) for bell in bells])
        speed, acceleration = np.array([bell.fastest for bell in bells]).T
        most = np.minimum(MOST_RAD_S / speed, MOST_RAD_S2 / acceleration)
        search = OffsetSearch(
            q,
            np.tile(members, len(bells)),
            np.repeat(weight, len(members), axis=0).T,
            np.repeat(most, len(members)),
            self.overlaps,
            self.overlaps.axis_distances(()),
            np.zeros(len(self.overlaps.pairs)),
            PRICE_M,
            STEP_RAD,
            self._coordinates.lower,
            self._coordinates.upper,
        )
        hand = self.hands[side]
        capsules = self.overlaps.depths(q, search.axis_distances, hand.pairs)
        allowed = search.allowed_depths(capsules, hand.pairs)
        held = hand.thumb.depths(q[[0, -1]], capsules[[0, -1]])
        judge = _Judge(search, hand, allowed, hand.thumb.allowed(held, len(q)))
        shortfall = float(np.max(capsules - allowed, initial=0.0))
        straight: _Judged | None = None
        if shortfall <= ENOUGH_M:
            straight = judge.judged(q, capsules)
            if straight.worst_m <= ENOUGH_M:
                return None
        index = self._coordinates.index
        starts = [
            np.clip(start, -search.most, search.most)
            for start in _starts(q[0, members], q[-1, members], members, index, side)
        ]
        best: _Judged | None = None
        found = np.zeros(2 * len(members)) if shortfall < SLIGHT_M else None
        for _ in range(ROUNDS):
            on_capsules = _round(search, starts, found, hand.pairs, allowed)
            wanted = search.offset_by(on_capsules)
            at = np.clip(wanted, search.lower, search.upper)
            capsules = self.overlaps.depths(at, search.axis_distances, hand.pairs)
            judged = judge.judged(at, capsules, on_capsules)
            best = judged if best is None or judged.worst_m < best.worst_m else best
            if best.worst_m <= ENOUGH_M:
                break
            allowed = hand.thumb.parted(allowed, capsules, judged.excess)
            found = on_capsules
        assert best is not None  # there are rounds
        if best.worst_m > ENOUGH_M:
            straight = straight or judge.judged(
                q, self.overlaps.depths(q, search.axis_distances, hand.pairs)
            )
            if best.worst_m > WORTHWHILE * straight.worst_m:
                return None
        return best.offsets


def _round(
    search: OffsetSearch,
    starts: Sequence[Array],
    before: Array | None,
    pairs: NDArray[np.int64],
    allowed: Array,
) -> Array:
    """Return the best offsets on capsules, (2 n,).

    Args: before: from which it starts, if any, before it takes the starts in order of their cost.
    """
    best: Offset | None = None
    if before is not None:
        best = search.smallest(before, pairs, allowed, ENOUGH_M)
        if best.shortfall_m <= ENOUGH_M:
            return best.values
    for start in _by_cost(search, starts, pairs, allowed)[:TRIES]:
        found = search.smallest(start, pairs, allowed, ENOUGH_M)
        if best is None or found.shortfall_m < best.shortfall_m:
            best = found
        if best.shortfall_m <= ENOUGH_M:
            break
    assert best is not None  # there are starts
    return best.values


@dataclass(frozen=True, slots=True, eq=False)
class _Judged:
    """A way, how deep anything is beyond what it may be, and (T, F) what the skin is."""

    offsets: Array | None
    worst_m: float
    excess: Array


@dataclass(frozen=True, slots=True, eq=False)
class _Judge:
    """Judges ways: of thumbs by their skin, of fingers among themselves by their capsules.

    allowed: (T, P) of capsules. skin: (T, F) of skins.
    """

    search: OffsetSearch
    hand: Hand
    allowed: Array
    skin: Array

    def judged(self, q: Array, capsules: Array, offsets: Array | None = None) -> _Judged:
        """Judge the postures of a way, (T, V), whose capsules are so deep, (T, P)."""
        skins = self.hand.thumb.depths(q, capsules)
        fingers = self.hand.thumb.finger < 0
        beyond = float(np.max((capsules - self.allowed)[:, fingers], initial=0.0))
        excess = skins - self.skin
        return _Judged(offsets, max(beyond, float(np.max(excess, initial=0.0))), excess)


@lru_cache(maxsize=8)
def passage_search(evaluator: Evaluator) -> PassageSearch:
    """Return the one search of a body, which remembers what it has found."""
    return PassageSearch(CapsuleOverlaps(evaluator), evaluator.rig.coordinates)


def via_points(members: NDArray[np.int64], start_s: float, end_s: float) -> list[ViaPoint]:
    """Return the early and the late via point of a way, without offsets."""
    nothing = np.zeros(len(members))
    return [ViaPoint(members, nothing, start_s, end_s, peak) for peak in PEAKS]


def _hand(overlaps: CapsuleOverlaps, side: Side) -> Hand:
    own = np.flatnonzero(overlaps.same_hand)
    pairs = own[[f"_{side}_" in overlaps.names(pair)[0] for pair in own.tolist()]]
    moving = {v for pair in pairs.tolist() for v in overlaps.moved_by(pair)}
    coordinates = np.array(sorted(moving), dtype=np.int64)
    return Hand(pairs, coordinates, ThumbSkin.of(overlaps.rig, overlaps, pairs, side))


def _starts(
    a: Array, b: Array, members: NDArray[np.int64], index: Mapping[str, int], side: Side
) -> Iterator[Array]:
    """Yield offsets to start from, (2 n,): early and late ones of every coordinate.

    Nothing; fingers that open while the thumb goes beside or before them; and each of these with
    the thumb first or last.

    Args: a, b: (n,) the coordinates at both ends.
    """
    thumb = np.isin(members, [v for n, v in index.items() if n.startswith(f"thumb_{side}")])

    def shape(*parts: Mapping[str, float]) -> Array:
        out = np.zeros(len(members))
        for part in parts:
            for name, angle in part.items():
                out[members == index.get(name.format(S=side), -1)] += angle
        return out

    turn = 0.4 * (b - a)
    thumb_first = np.where(thumb, turn, -turn)
    for opened in (shape(), shape(_OPEN), shape(_ASIDE), shape(_OPEN, _ASIDE),
                   shape(_BEFORE), shape(_OPEN, _BEFORE)):  # fmt: skip
        for early, late in ((0.7, 0.7), (1.2, 0.2), (0.2, 1.2)) if opened.any() else ((1.0, 1.0),):
            for order in (0.0, 1.0, -1.0):
                way = order * thumb_first
                yield np.concatenate([early * opened + way, late * opened + way])


def _by_cost(
    search: OffsetSearch, starts: Sequence[Array], pairs: NDArray[np.int64], allowed: Array
) -> list[Array]:
    """Return the starts in the order of what they cost, which one call measures.

    Every second sample tells that well enough.
    """
    some = slice(1, None, 2)
    wanted = np.tile(search.q[some], (len(starts), 1, 1))
    for half in np.split(np.arange(len(search.members)), len(PEAKS)):
        weighted = search.weights[some, half] * np.stack(starts)[:, None, half]
        wanted[:, :, search.members[half]] += weighted
    wanted = wanted.reshape(-1, wanted.shape[-1])
    q = np.clip(wanted, search.lower, search.upper)
    depths = search.overlaps.depths(q, search.axis_distances, pairs)
    beyond = np.maximum(depths.reshape(len(starts), -1, len(pairs)) - allowed[some], 0.0)
    costs = [
        float(np.sum(each**2) + search.price_m**2 * np.sum(start**2))
        for each, start in zip(beyond, starts, strict=True)
    ]
    return [starts[i] for i in np.argsort(costs, kind="stable")]
