"""Fingers and thumbs as three bones in the palm: their frames, and a body's coordinates of them.

A bone's frame has the columns x, dir, nrm as in `azee_rig.chain`: dir along the bone, x the axis
that it bends about, so that a positive turn about x brings dir towards nrm, the pad's side. With
the palm's frame P, s = 1 on the left and −1 on the right, the bones of a digit are, after
`azee_rig.build.chain_builder`,

    finger   N₁ = Rz(s deviation) Rx(flexion₁)                    N₂ = N₁ Rx(flexion₂)
    thumb    N₁ = Z Rx(flexion₁) Rz(s abduction) Ry(s roll)       N₃ = N₂ Rx(flexion₃)

where Z has the columns −s nrm, dir, s x of the palm.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from azee.clip.finite import check_numbers
from azee_rig.rig import Rig
from azee_rig.rotation import about_axis

Floats = NDArray[np.float64]

X, DIR, NRM = 0, 1, 2
SIDES = ("L", "R")
FINGERS = ("index", "middle", "ring", "little")
DIGITS = ("thumb", *FINGERS)
HINGE_WEIGHT = 0.2
"""How much the axis of a finger's first joint counts beside its direction, which tells nothing of
its deviation where the finger points along the palm's normal."""
TIP_SHARE = 0.75
"""Length of a last bone of which no site marks the end, as a share of the one before."""
ROLL_WEIGHT = 0.02
"""A radian of roll from the usual one weighs as a bone that is off by so much of its length."""
SWEEPS, STEP_RAD = 30, 1e-6
STRAIGHT_RAD = np.radians(3.0)
"""A middle joint that is bent by less tells nothing of how bent the last one is."""


@dataclass(frozen=True, eq=False)
class Digit:
    """How a digit's three bones stand in the palm of its hand, in T frames.

    frames: (T, 3, 3, 3) frames of the bones in the palm's. ways: (T, 2, 3) unit directions of the
    first two bones of a thumb of which nothing tells how it is rolled, so that its frames are a
    guess; None where something does. rest_bend: bend of the middle joint in the source's posture
    of rest, radians, where that posture shows the last bone as straight on only because nothing
    tells where it ends; None where something does.
    """

    name: str
    frames: Floats
    ways: Floats | None = None
    rest_bend: float | None = None

    def __post_init__(self) -> None:
        check_numbers(f"bones of {self.name}", self.frames)


@dataclass(frozen=True, eq=False)
class DigitFit:
    """A digit of a body, to be posed like another body's."""

    rig: Rig
    name: str

    @cached_property
    def coordinates(self) -> tuple[str, ...]:
        """Its coordinates: two or three of the first joint, then a flexion each."""
        first = ("flexion", "abduction", "roll") if self._thumb else ("deviation", "flexion")
        return (
            *(f"{self.name}_1.{turn}" for turn in first),
            f"{self.name}_2.flexion",
            f"{self.name}_3.flexion",
        )

    @property
    def exists(self) -> bool:
        """Whether the body can bend it."""
        return all(name in self.rig.coordinates.index for name in self.coordinates)

    def angles(self, digit: Digit) -> tuple[Floats, Floats]:
        """Return coordinates (T, 4 or 5) inside the limits, and how far the tip is off, (T,).

        The tip is off, in the palm's frame and metres on this body, from where it would be if
        its bones had the frames asked for.
        """
        c = self.rig.coordinates
        columns = [c.index[name] for name in self.coordinates]
        wanted = self._wanted(digit)
        frames = digit.frames
        if digit.rest_bend is not None:
            more = self._last_bend(digit.rest_bend)
            wanted[:, -1] += more
            last = frames[:, 2] @ about_axis(X, more)
            frames = np.stack([frames[:, 0], frames[:, 1], last], axis=1)
        if digit.ways is not None:
            wanted = self._rolled(wanted, digit.ways, float(c.idle[columns[2]]))
            frames = self.posed(wanted)
        found = np.clip(wanted, c.lower[columns], c.upper[columns])
        off = self._tips(self.posed(found)) - self._tips(frames)
        return found, np.linalg.norm(off, axis=-1)

    def posed(self, angles: Floats) -> Floats:
        """Frames (T, 3, 3, 3) of the bones in the palm for some coordinates (T, 4 or 5)."""
        if self._thumb:
            flexion, abduction, roll = np.moveaxis(angles[:, :3], -1, 0)
            R = about_axis(X, flexion) @ about_axis(NRM, self._sign * abduction)
            first = thumb_zero(self._sign) @ R @ about_axis(DIR, self._sign * roll)
        else:
            deviation, flexion = np.moveaxis(angles[:, :2], -1, 0)
            first = about_axis(NRM, self._sign * deviation) @ about_axis(X, flexion)
        second = first @ about_axis(X, angles[:, -2])
        return np.stack([first, second, second @ about_axis(X, angles[:, -1])], axis=1)

    def _wanted(self, digit: Digit) -> Floats:
        """Coordinates (T, 4 or 5), limits or not."""
        first, second, third = np.moveaxis(digit.frames, 1, 0)
        turns = thumb_turns(first, self._sign) if self._thumb else _finger_turns(first, self._sign)
        return np.stack([*turns, bend(first, second), bend(second, third)], axis=-1)

    def _rolled(self, wanted: Floats, ways: Floats, usual_rad: float) -> Floats:
        """Coordinates (T, 5) with which this thumb's bones have given directions.

        Of a body that rolls its thumb like this one they have them exactly: the first bone lies
        beside the axis of its frame, so that two directions tell the roll. Else the roll stays
        near its usual one, and the directions come as near as they can. Damped Gauss–Newton.
        """
        offsets, _ = self._lengths
        own = offsets / np.maximum(np.linalg.norm(offsets, axis=-1, keepdims=True), 1e-12)

        def residual(q: Floats) -> Floats:
            frames = self.posed(q)
            off = [frames[:, k] @ own[k] - ways[:, k] for k in (0, 1)]
            rolled = ROLL_WEIGHT * (q[:, 2:3] - usual_rad)
            return np.concatenate([*off, rolled, q[:, 4:] - wanted[:, 4:]], axis=-1)

        q = wanted.copy()
        q[:, 2] = usual_rad
        r = residual(q)
        damping = np.full(len(q), 1e-3)
        for _ in range(SWEEPS):
            J = (
                np.stack([residual(q + STEP_RAD * e) - r for e in np.eye(q.shape[1])], -1)
                / STEP_RAD
            )
            JT = np.swapaxes(J, -1, -2)
            normal = JT @ J + damping[:, None, None] * np.eye(q.shape[1])
            tried = q - np.linalg.solve(normal, JT @ r[..., None])[..., 0]
            after = residual(tried)
            better = (after**2).sum(axis=-1) < (r**2).sum(axis=-1)
            q[better], r[better] = tried[better], after[better]
            damping = np.where(better, 0.2 * damping, 5.0 * damping).clip(1e-12, 1e6)
        return q

    def _last_bend(self, rest_bend: float) -> float:
        """Bend of the last joint at rest that goes with that of the middle one, radians.

        Both are taken to be in proportion as in this body's own posture of rest.
        """
        c = self.rig.coordinates
        middle, last = (float(c.bind[c.index[name]]) for name in self.coordinates[-2:])
        if middle < STRAIGHT_RAD:
            return 0.0
        return float(last * np.clip(rest_bend / middle, 0.0, 1.0))

    def _tips(self, frames: Floats) -> Floats:
        """Tips (T, 3) in the palm, from the first joint, metres."""
        offsets, tip = self._lengths
        return np.asarray(
            frames[:, 0] @ offsets[0] + frames[:, 1] @ offsets[1] + frames[:, 2] @ tip
        )

    @cached_property
    def _lengths(self) -> tuple[Floats, Floats]:
        """Metres: second and third joint, (2, 3), in the bone before; tip (3,) in the last."""
        nodes = [self.rig.bones[f"{self.name}_{k}"].node for k in (2, 3)]
        offsets = self.rig.chain.offsets[nodes]
        digit, side = self.name.split("_")
        site = self.rig.sites.get(f"{digit[0].upper()}_TIP_{side}")
        if site is not None and site.node == nodes[-1]:
            return offsets, site.position
        return offsets, np.array([0.0, TIP_SHARE * float(np.linalg.norm(offsets[1])), 0.0])

    @property
    def _thumb(self) -> bool:
        return self.name.startswith("thumb")

    @property
    def _sign(self) -> float:
        return 1.0 if self.name.endswith("_L") else -1.0


def thumb_zero(sign: float) -> Floats:
    """Frame of the thumb's first bone in the palm, all coordinates zero, (3, 3)."""
    return np.array([[0.0, 0.0, sign], [0.0, 1.0, 0.0], [-sign, 0.0, 0.0]])


def bend(first: Floats, second: Floats) -> Floats:
    """Angle (T,) about the first frame's x from its dir to that of the second, (T, 3, 3) each."""
    along = np.einsum("tba,tb->ta", first, second[..., DIR])
    return np.asarray(np.arctan2(along[:, NRM], along[:, DIR]))


def thumb_turns(first: Floats, sign: float) -> tuple[Floats, Floats, Floats]:
    """Flexion, abduction and roll, (T,) each, of a thumb's first bone, (T, 3, 3) in the palm."""
    R = thumb_zero(sign).T @ first
    free = np.hypot(R[..., NRM, DIR], R[..., DIR, DIR])
    flexion = np.arctan2(R[..., NRM, DIR], R[..., DIR, DIR])
    abduction = sign * np.arctan2(-R[..., X, DIR], free)
    return flexion, abduction, sign * np.arctan2(R[..., X, NRM], R[..., X, X])


def _finger_turns(first: Floats, sign: float) -> tuple[Floats, Floats]:
    """Deviation and flexion, (T,) each, of a finger's first bone, (T, 3, 3) in the palm.

    Along the palm the bone's direction tells the deviation, along its normal only the axis that
    it bends about does.
    """
    d, x = first[..., DIR], first[..., X]
    hinge = x[..., :2]
    across = np.stack([d[..., DIR], -d[..., X]], axis=-1)
    across = across * np.where((across * hinge).sum(axis=-1, keepdims=True) < 0.0, -1.0, 1.0)
    both = across + HINGE_WEIGHT * hinge
    deviation = np.arctan2(both[..., 1], both[..., 0])
    along = np.cos(deviation) * d[..., DIR] - np.sin(deviation) * d[..., X]
    return sign * deviation, np.arctan2(d[..., NRM], along)
