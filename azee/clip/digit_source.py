"""Fingers and thumbs of a recording: the frames of their bones in the palm.

A file says how each joint turns and where the next one is. What it does not say is the axis that
a digit bends about, its hinge, which is fixed in the digit's bones:

- a finger's lies in the palm and square to the finger, in the frame in which it is straightest;
- a thumb's is the one that its two outer joints turn about most while it moves; where it never
  moves, the one about which the file turns it from rest, if that is one axis.

Bones then stand as their directions say, square to the hinge: so a thumb whose first joint lies
beside its axis is straight where its own flexion is zero.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.clip.digits import DIR, NRM, Digit, bend, thumb_turns, thumb_zero
from azee_rig.rotation import about_axis, rotation_vectors

Floats = NDArray[np.float64]

MOVED_RAD = np.radians(2.0)
"""A joint that turns by less tells no axis."""
ONE_AXIS = 0.35
"""Turns about other axes than the main one, as a share of it, up to which a joint is a hinge."""
USUAL_ROLL_RAD, LIKELY_ROLL_RAD = np.radians(-25.0), np.radians(75.0)
"""How a thumb at rest is rolled, and how far from that a hinge is believed."""
FLAT = 0.2
"""Share of a finger's length that lies in the palm where its direction tells its hinge."""
ALONG = 0.7
"""Cosine to the palm's x that a finger's hinge has at least."""
SAME_WAY = np.cos(np.radians(0.5))
"""A last bone that is as straight on as this only continues the one before."""
FOLDED_RAD = np.radians(120.0)
"""A last bone that is bent by more points the other way."""
SHARED_BEND = (0.76, 0.51)
"""Of a digit of two joints, what its middle and last joint take of the bend of the second.

The last joint of a finger bends by about two thirds of the middle one; two bones of nearly one
length then end in the direction of one that is bent by 1.32 times the middle joint's bend."""
NO_LENGTH = 1e-3
"""Bones shorter than this, as a share of the longest of the digit, have no direction."""


@dataclass(frozen=True, eq=False)
class DigitJoints:
    """A digit as a recording has it.

    turned: (T, n, 3, 3) rotations of its n joints in the world. ways: (n, 3) from each joint to
    the next, in the joint's axes; the last is where the digit ends, zero where nothing tells.
    """

    name: str
    turned: Floats
    ways: Floats

    @property
    def whole(self) -> bool:
        """Whether it has joints enough to bend, a length apart."""
        lengths = np.linalg.norm(self.ways, axis=-1)
        inner = lengths[:-1]
        return len(lengths) >= 2 and bool(inner.min() > NO_LENGTH * lengths.max())


def measure_digit(joints: DigitJoints, palm: Floats) -> Digit:
    """Measure a digit of two joints or more.

    Args: palm: (T, 3, 3) frame of the palm in the world, columns x, dir, nrm.
    """
    turned = np.einsum("tba,tnbc->tnac", palm, joints.turned)
    ways = joints.ways / np.maximum(np.linalg.norm(joints.ways, axis=-1, keepdims=True), 1e-12)
    blind = not ways[-1].any() or float(ways[-1] @ ways[-2]) > SAME_WAY
    if not ways[-1].any():
        ways[-1] = ways[-2]
    sign = 1.0 if joints.name.endswith("_L") else -1.0
    if joints.name.startswith("thumb"):
        hinge, told = _thumb_hinge(turned, ways, sign)
    else:
        hinge, told = _finger_hinge(turned, ways), True
    # Fixed in the joints' axes: F(t) = A(t) F.
    fixed = np.stack([_bone(way, axis) for way, axis in zip(ways, hinge, strict=True)])
    frames = turned @ fixed
    directions = None if told else np.einsum("tnab,nb->tna", turned[:, :2], ways[:2])
    at_rest = float(bend(fixed[None, 0], fixed[None, 1])[0])
    if len(ways) == 2:
        return Digit(joints.name, _with_shared_bend(frames), directions)
    if np.median(np.abs(bend(frames[:, 1], frames[:, 2]))) > FOLDED_RAD:
        # Some exporters turn the last joint half round, and its end site with it.
        frames[:, 2] = frames[:, 2] @ about_axis(0, np.pi)
    return Digit(joints.name, frames, directions, at_rest if blind else None)


def _with_shared_bend(frames: Floats) -> Floats:
    """Three bones (T, 3, 3, 3) of two (T, 2, 3, 3), the second's bend shared out."""
    first = frames[:, 0]
    total = bend(first, frames[:, 1])
    second = first @ about_axis(0, SHARED_BEND[0] * total)
    return np.stack([first, second, second @ about_axis(0, SHARED_BEND[1] * total)], axis=1)


def _bone(way: Floats, hinge: Floats) -> Floats:
    """Frame of a bone, (3, 3), from its hinge and about its direction."""
    along = way - hinge * (hinge @ way)
    length = float(np.linalg.norm(along))
    if length < 1e-6:  # it lies in its hinge: any direction is as good
        axis = np.eye(3)[int(np.abs(hinge).argmin())]
        along = axis - hinge * (hinge @ axis)
        length = float(np.linalg.norm(along))
    along = along / length
    return np.stack([hinge, along, np.cross(hinge, along)], axis=-1)


def _finger_hinge(turned: Floats, ways: Floats) -> Floats:
    """Hinge (n, 3) in the axes of each joint.

    It lies in the palm and square to the finger, where the finger lies most in the palm. One that
    always points along the palm's normal bends about what its joints turn about, if they do.
    """
    first = turned[:, 0] @ ways[0]
    flat = int(np.abs(first[:, NRM]).argmin())
    x = np.array([first[flat, DIR], -first[flat, 0], 0.0])
    length = float(np.linalg.norm(x))
    if length < FLAT:
        for reference, axis in _turned_about(turned):
            across = axis * np.sign(axis[0])
            if across[0] > ALONG:
                return _in_joints(reference, across)
    x = x / length if length > 1e-6 else np.array([1.0, 0.0, 0.0])
    return _in_joints(turned[flat], x)


def _thumb_hinge(turned: Floats, ways: Floats, sign: float) -> tuple[Floats, bool]:
    """Hinge (n, 3) in the axes of each joint, and whether anything tells it."""
    for reference, axis in _turned_about(turned):
        rolls = []
        for hinge in (axis, -axis):
            bone = reference[0] @ _bone(ways[0], reference[0].T @ hinge)
            roll = float(thumb_turns(bone[None], sign)[2][0])
            rolls.append(abs(roll - USUAL_ROLL_RAD))
        if min(rolls) < LIKELY_ROLL_RAD:
            return _in_joints(reference, axis if rolls[0] <= rolls[1] else -axis), True
    return _in_joints(turned[0], _usual_hinge(turned[0, 0] @ ways[0], sign)), False


def _turned_about(turned: Floats) -> Iterator[tuple[Floats, Floats]]:
    """Yield postures (n, 3, 3) of a digit's joints and the axis that the outer ones turn about.

    The axis, (3,) in the palm, is the one of all turns from the posture: that of the first frame,
    and that of rest. At rest joints have one orientation; that of the first joint in the first
    frame is as good.
    """
    for reference in (turned[0], np.broadcast_to(turned[0, 0], turned[0].shape)):
        vectors = []
        for k in range(1, len(reference)):
            local = np.swapaxes(turned[:, k - 1], -1, -2) @ turned[:, k]
            since = local @ (reference[k - 1].T @ reference[k]).T
            vectors.append(rotation_vectors(since) @ reference[k - 1].T)
        axis = _main_axis(np.concatenate(vectors))
        if axis is not None:
            yield reference, axis


def _in_joints(reference: Floats, axis: Floats) -> Floats:
    """Axis of the palm, (3,), in the axes of each joint, (n, 3), in some posture (n, 3, 3)."""
    return np.asarray(np.einsum("nba,b->na", reference, axis))


def _usual_hinge(way: Floats, sign: float) -> Floats:
    """Hinge in the palm, (3,), of a thumb whose first bone goes one way and is rolled as usual."""
    d = thumb_zero(sign).T @ way
    flexion = np.arctan2(d[NRM], d[DIR])
    abduction = np.arctan2(-d[0], np.hypot(d[DIR], d[NRM]))
    R = about_axis(0, flexion) @ about_axis(NRM, abduction) @ about_axis(DIR, sign * USUAL_ROLL_RAD)
    return np.asarray((thumb_zero(sign) @ R)[:, 0])


def _main_axis(vectors: Floats) -> Floats | None:
    """Return the unit axis (3,) of rotation vectors (N, 3); None where they have not one alone."""
    if np.linalg.norm(vectors, axis=-1).max(initial=0.0) < MOVED_RAD:
        return None
    _, strength, axes = np.linalg.svd(vectors, full_matrices=False)
    if len(strength) > 1 and strength[1] > ONE_AXIS * strength[0]:
        return None
    return np.asarray(axes[0])


def joints_of(
    digit: str, side: str, bones: Mapping[str, Sequence[str]], index: Mapping[str, int]
) -> list[int]:
    """Joints of a digit that has some, proximal first."""
    chains = (bones.get(f"{digit}_{side}_{k}") for k in (1, 2, 3))
    return [index[chain[0]] for chain in chains if chain]
