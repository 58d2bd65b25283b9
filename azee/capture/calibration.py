"""A person's hand from recorded poses: lengths of bones, places of markers, the palm in the root.

Postures and shape are found in turn. With the shape known, postures are fitted within the limits.
With the postures known, where a marker is, is linear in the offsets o of its joints and in its own
place l on its bone:

    x = o₁ + R₁ o₂ + R₂ o₃ + R₃ l

so that the shape is a least-squares problem, one a digit. Few markers cannot tell all of it: it
stays near the body's own, scaled to the person's size.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from azee.capture.hand import Hand, HandShape
from azee.capture.hand_fit import HandFit
from azee.capture.markers import Floats
from azee.capture.places import Place
from azee.capture.root_frame import rigid
from azee.clip.digits import DIGITS

Told = Callable[[int, int], None]

STARTS = (0.9, 1.0, 1.12)
"""Sizes of hands to start from, times the body's: the best is gone on with."""
FIRST, ROUNDS = 3, 10
"""Rounds from each start, and from the best."""
MARKER_M = 0.002
"""How well markers are met; the unit of the costs below."""
BASE_M, LENGTH_M, SIDE_M, PLACE_M = 0.004, 0.004, 0.0015, 0.008
"""How far a person may differ from the scaled body: first joints, bones along and across, places
of markers; metres."""
SIZES = (0.85, 1.15)
"""How large hands of adults are, times the body's."""
IDLE_KEEP = 2.0
"""Cost of a squared radian from idle, in squared millimetres of a marker."""


@dataclass(frozen=True, eq=False)
class Calibrated:
    """A shape, the postures (N, V) of poses, and what markers are off in them, (N, m) metres."""

    shape: HandShape
    postures: Floats
    off_m: Floats


def calibrate(
    poses: Floats, places: Mapping[str, Place], hand: Hand, told: Told | None = None
) -> Calibrated:
    """Fit a hand to poses.

    Args: poses: (N, m, 3) markers on digits in the root's frame, in the order of `places`.
    """
    hand = replace(hand, coupled=False)
    total = len(STARTS) * FIRST + ROUNDS
    done = 0

    def improved(found: Calibrated, rounds: int) -> Calibrated:
        nonlocal done
        for _ in range(rounds):
            found = _improved(found, poses, hand)
            done += 1
            if told:
                told(done, total)
        return found

    starts = [improved(_start(poses, places, hand, size), FIRST) for size in STARTS]
    return improved(min(starts, key=lambda found: float(found.off_m.mean())), ROUNDS)


def _start(poses: Floats, places: Mapping[str, Place], hand: Hand, size: float) -> Calibrated:
    """Return the body's own hand in another size, laid on the poses."""
    markers = {name: (place, size * hand.site(place)) for name, place in places.items()}
    shape = HandShape(size * hand.own_offsets, markers, np.eye(3), np.zeros(3))
    idle = hand.body.coordinates.idle[None]
    shape = _turned(shape, poses.mean(axis=0)[None], hand.marker_positions(shape, idle))
    return _posed(shape, poses, hand)


def _improved(found: Calibrated, poses: Floats, hand: Hand) -> Calibrated:
    """Fit the shape to the postures, then the postures to the shape."""
    shape, q = found.shape, found.postures
    shape = _turned(shape, poses, hand.marker_positions(shape, q))
    shape = _shaped(shape, hand, shape.into_palm(poses), q, _size(shape, hand))
    return _posed(shape, poses, hand)


def _posed(shape: HandShape, poses: Floats, hand: Hand) -> Calibrated:
    """Fit postures to the shape."""
    idle = np.tile(hand.body.coordinates.idle, (len(poses), 1))
    targets = shape.into_palm(poses)
    q = HandFit(hand, shape).solved(targets, idle, 1.0, keep=IDLE_KEEP, smooth=0.0)
    off = np.linalg.norm(hand.marker_positions(shape, q) - targets, axis=-1)
    return Calibrated(shape, q, off)


def _turned(shape: HandShape, poses: Floats, in_palm: Floats) -> HandShape:
    """Return a shape that brings poses (N, m, 3) nearest to markers in the palm, (N, m, 3)."""
    R, shift = rigid(poses.reshape(-1, 3), in_palm.reshape(1, -1, 3))
    return replace(shape, rotation=R[0], shift=shift[0])


def _size(shape: HandShape, hand: Hand) -> float:
    own = hand.own_offsets
    return _likely(float((shape.offsets * own).sum() / (own**2).sum()))


def _likely(size: float) -> float:
    """Return a size that people have: markers on fingers hardly tell how long the palm is."""
    return min(max(size, SIZES[0]), SIZES[1])


def _shaped(shape: HandShape, hand: Hand, targets: Floats, q: Floats, size: float) -> HandShape:
    """Return the shape that fits postures (N, V) whose markers are at targets (N, m, 3)."""
    _, R = hand.bones(hand.of(shape), q)
    numbers, _ = hand.numbered(shape.markers)
    offsets, places = np.array(shape.offsets), {}
    names = list(shape.markers)
    for d in range(len(DIGITS)):
        on = [k for k, number in enumerate(numbers) if number // 3 == d]
        first = 3 * d
        sites = [hand.site(shape.markers[names[k]][0]) for k in on]
        prior = size * np.concatenate([*hand.own_offsets[first : first + 3], *sites])
        rows = _rows(R[:, first : first + 3], [int(numbers[k]) % 3 for k in on])
        wanted = targets[:, on].swapaxes(0, 1).ravel()
        spread = np.concatenate([_SPREAD, np.full(3 * len(on), PLACE_M)])
        scale = MARKER_M * np.sqrt(len(q))
        A = np.vstack([rows / scale, np.diag(1.0 / spread)])
        b = np.concatenate([wanted / scale, prior / spread])
        found = np.linalg.lstsq(A, b, rcond=None)[0].reshape(-1, 3)
        offsets[first : first + 3] = found[:3]
        for column, k in enumerate(on):
            places[names[k]] = (shape.markers[names[k]][0], found[3 + column])
    return replace(shape, offsets=offsets, markers={name: places[name] for name in names})


_SPREAD = np.array([*3 * [BASE_M], *2 * [SIDE_M, LENGTH_M, SIDE_M]])
"""How far offsets of a digit's three joints may differ, (9,) metres."""


def _rows(R: Floats, bones: Sequence[int]) -> Floats:
    """Return where markers on a digit are as linear in three offsets and their own places.

    Args: R: (N, 3, 3, 3) rotations of its bones. bones: of each of its k markers, 0 … 2.
    Returns: (3 k N, 9 + 3 k), marker by marker.
    """
    out = np.zeros((len(bones), len(R), 3, 9 + 3 * len(bones)))
    for k, bone in enumerate(bones):
        out[k, :, :, :3] = np.eye(3)
        for above in range(bone):
            out[k, :, :, 3 * above + 3 : 3 * above + 6] = R[:, above]
        out[k, :, :, 9 + 3 * k : 12 + 3 * k] = R[:, bone]
    return out.reshape(-1, out.shape[3])
