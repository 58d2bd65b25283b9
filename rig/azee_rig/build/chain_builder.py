"""Builds the chain of AZee bones on a body: frames, degrees of freedom, the mesh's own posture.

Zero pose: standing, arms hanging, elbow creases forward, thumbs forward, fingers straight. Each
node's frame has columns x, dir, nrm with x = dir × nrm; dir runs from proximal to distal.

| bone | nrm | turns, in order |
|---|---|---|
| back | forward | flexion about x, lateral about −nrm, axial about dir |
| neck, head | forward | the same, axial first |
| clav | forward | elevation about nrm, protraction about x |
| arm | elbow crease | flexion about x, abduction about nrm, rotation about dir |
| f_arm | palm side at the wrist | flexion about ±nrm (the arm's x), pronation about dir |
| palm | palm | flexion about x, deviation about nrm |
| fingers | palmar | deviation about nrm (MCP only), flexion about x |
| thumb | pad; ulnar at zero | flexion about x, abduction about nrm, roll about dir; flexion |
| eye | up | yaw about nrm, pitch about x |

Turns about dir and nrm change sign on the right, except those of the eyes.

Skin near a joint turns by a part of what the joint does. For the sites that ride on it there are
nodes beside the bones' own: `deltoid`, `elbow` and `carpus` bend by half as much as arm, f_arm and
palm; `shoulder` and `cubitus` bend like arm and f_arm but leave out the turn about the limb's
axis, and `upperarm` and `forearm` take half of it.

A raised arm lifts its shoulder: abduction and flexion of the arm turn the clavicle up by a share
each, and the arm turns back by as much, so that the direction of the arm itself does not change
(scapulohumeral rhythm, made linear).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.anatomy import FINGERS, PHALANGES, SIDES, Anatomy, unit
from azee_rig.chain import DIR, NRM, Chain, X
from azee_rig.rig import BoneNodes
from azee_rig.rotation import about_axis

Floats = NDArray[np.float64]
Turn = tuple[int, float, str]
"""Axis, signed share, coordinate."""

RHYTHM = {"abduction": 0.16, "flexion": 0.15}
"""Share of the arm's elevation that the clavicle takes.

The shoulder blade takes 0.43° for each degree of the shoulder joint, 30 % of the whole (Braman et
al. 2009, J Shoulder Elbow Surg 18:960). In flexion it takes somewhat less than in abduction (Borsa
et al. 2003, J Athl Train 38:12). About half of that is the clavicle's, 30° of 180° (range-of-motion
tables).
"""

STRAIGHT_DEG, BACKWARD_DEG = 3.0, 15.0
"""An elbow that bends by less, to either side, counts as straight."""
SAME_M, LOCKED = 1e-6, 1e-9
RAISED_DEG = 75.0
"""From this abduction on, the arms of a mesh count as held out."""

UP, FORWARD, LEFT = np.eye(3)[1], np.eye(3)[2], np.eye(3)[0]
TRUNK = np.eye(3)
"""Frame of an upright trunk: x to the left, dir up, nrm forward."""


@dataclass(frozen=True, eq=False, slots=True)
class BuiltChain:
    """A chain, the nodes of each bone, and the coordinates of the mesh's own posture, radians."""

    chain: Chain
    bones: dict[str, BoneNodes]
    bind: dict[str, float]


def frame(direction: Floats, normal: Floats) -> Floats:
    """Return right-handed columns x, dir, nrm from a direction and an approximate normal."""
    d = unit(direction)
    n = unit(normal - d * (normal @ d))
    return np.stack([np.cross(d, n), d, n], axis=1)


def build_chain(anatomy: Anatomy, coordinate_names: Sequence[str]) -> BuiltChain:
    """Build the chain of a body.

    Raises: KeyError: a turn drives a coordinate that is not in `coordinate_names`.
    """
    made = _Builder()
    _trunk(made, anatomy)
    for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
        _arm(made, anatomy, side, sign)
        for finger in FINGERS:
            _finger(made, anatomy, finger, side, sign)
        _thumb(made, anatomy, side, sign)
    return made.finish(coordinate_names)


@dataclass(eq=False)
class _Builder:
    """Collects nodes, with each node's frame in the mesh's own posture."""

    names: list[str] = field(default_factory=list)
    parents: list[int] = field(default_factory=list)
    places: list[Floats] = field(default_factory=list)
    frames: list[Floats] = field(default_factory=list)
    zero: list[Floats] = field(default_factory=list)
    turns: list[Sequence[Turn]] = field(default_factory=list)
    bones: dict[str, BoneNodes] = field(default_factory=dict)
    bind: dict[str, float] = field(default_factory=dict)

    def node(
        self, name: str, parent: str | None, place: Floats, zero: Floats, turns: Sequence[Turn]
    ) -> Floats:
        """Add a node whose turns have known bind values; return its frame in the mesh."""
        above = -1 if parent is None else self.names.index(parent)
        R = zero if above < 0 else self.frames[above] @ zero
        for axis, scale, coordinate in turns:
            R = R @ about_axis(axis, scale * self.bind.setdefault(coordinate, 0.0))
        self.names.append(name)
        self.parents.append(above)
        self.places.append(place)
        self.frames.append(R)
        self.zero.append(zero)
        self.turns.append(turns)
        return R

    def bone(self, bone: str, nodes: Sequence[str]) -> None:
        """Store the nodes of a bone, proximal first."""
        self.bones[bone] = BoneNodes(self.names.index(nodes[-1]), self.names.index(nodes[0]))

    def finish(self, coordinate_names: Sequence[str]) -> BuiltChain:
        index = {name: i for i, name in enumerate(coordinate_names)}
        offsets = [
            place if p < 0 else self.frames[p].T @ (place - self.places[p])
            for place, p in zip(self.places, self.parents, strict=True)
        ]
        flat = [turn for turns in self.turns for turn in turns]
        chain = Chain(
            names=tuple(self.names),
            parents=np.array(self.parents),
            offsets=np.array(offsets),
            zero=np.array(self.zero),
            dof_start=np.cumsum([0, *(len(turns) for turns in self.turns)]),
            dof_axis=np.array([axis for axis, _, _ in flat]),
            dof_scale=np.array([scale for _, scale, _ in flat]),
            dof_coordinate=np.array([index[coordinate] for _, _, coordinate in flat]),
        )
        return BuiltChain(chain, self.bones, self.bind)


def _trunk(made: _Builder, anatomy: Anatomy) -> None:
    below: str | None = None
    for bone in ("back_1", "back_2", "neck", "head"):
        places = anatomy.joints[bone]
        share = 1.0 / len(places)
        bends = [(X, share, f"{bone}.flexion"), (NRM, -share, f"{bone}.lateral")]
        axial = (DIR, share, f"{bone}.axial")
        turns = [*bends, axial] if bone.startswith("back") else [axial, *bends]
        nodes = [bone] if len(places) == 1 else [f"{bone}.{i + 1}" for i in range(len(places))]
        for node, place in zip(nodes, places, strict=True):
            made.node(node, below, place, TRUNK, turns)
            below = node
        made.bone(bone, nodes)
    for side in SIDES:
        eye = f"eye_{side}"
        zero = frame(FORWARD, UP)
        made.bind[f"{eye}.yaw"], made.bind[f"{eye}.pitch"] = 0.0, 0.0
        turns = [(NRM, 1.0, f"{eye}.yaw"), (X, 1.0, f"{eye}.pitch")]
        made.node(eye, "head", anatomy.origin(eye), zero, turns)
        made.bone(eye, [eye])


def _arm(made: _Builder, anatomy: Anatomy, side: str, sign: float) -> None:
    clav, arm, f_arm, palm = (f"{b}_{side}" for b in ("clav", "arm", "f_arm", "palm"))
    shoulder, elbow, wrist = (anatomy.origin(b) for b in (arm, f_arm, palm))
    along_arm, along_f_arm = unit(elbow - shoulder), unit(wrist - elbow)
    in_mesh = frame(along_arm, _crease(along_arm, along_f_arm))
    hanging = frame(-UP, FORWARD)
    a, b, c = _turn_angles(hanging.T @ in_mesh, X, NRM, DIR)
    if abs(b) > np.radians(RAISED_DEG):
        # With arms this far out, abduction hardly separates flexion from rotation. So the plane of
        # abduction is laid through the arm, by a turn of the hanging arm about its own axis.
        hanging = about_axis(1, np.arctan2(-sign * along_arm[2], sign * along_arm[0])) @ hanging
        a, b = 0.0, sign * float(np.arccos(np.clip(-along_arm[1], -1.0, 1.0)))
        turned = (hanging @ about_axis(NRM, b)).T @ in_mesh
        c = float(np.arctan2(turned[0, 2], turned[0, 0]))
    made.bind |= {
        f"{arm}.flexion": a,
        f"{arm}.abduction": sign * b,
        f"{arm}.rotation": sign * c,
    }
    rhythm = [(NRM, sign * share, f"{arm}.{turn}") for turn, share in RHYTHM.items()]
    # In the frontal plane: nrm stays exactly forward, and the rhythm's turn back is exact too.
    along = (shoulder - anatomy.origin(clav)) * (1.0, 1.0, 0.0)
    if np.linalg.norm(along) < SAME_M:  # a body without clavicles
        along = sign * LEFT
    lifted = sum(scale * made.bind[coordinate] for _, scale, coordinate in rhythm)
    clav_zero = frame(along, FORWARD) @ about_axis(NRM, -lifted)
    own = [(NRM, sign, f"{clav}.elevation"), (X, 1.0, f"{clav}.protraction")]
    made.node(
        clav,
        made.names[made.bones["back_2"].node],
        anatomy.origin(clav),
        clav_zero,
        [*rhythm, *own],
    )
    made.bone(clav, [clav])

    back = [(axis, -scale, coordinate) for axis, scale, coordinate in rhythm]
    turns = [
        *back,
        (X, 1.0, f"{arm}.flexion"),
        (NRM, sign, f"{arm}.abduction"),
        (DIR, sign, f"{arm}.rotation"),
    ]
    R = made.node(arm, clav, shoulder, clav_zero.T @ hanging, turns)
    made.bone(arm, [arm])
    beside = partial(made.node, parent=clav, place=shoulder, zero=clav_zero.T @ hanging)
    beside(f"deltoid_{side}", turns=_share(turns[:-1], 0.5))
    beside(f"shoulder_{side}", turns=turns[:-1])
    beside(f"upperarm_{side}", turns=[*turns[:-1], *_share(turns[-1:], 0.5)])

    palm_frame = _palm_frame(anatomy, side, sign)
    medial = np.stack([-sign * NRM_AXIS, DIR_AXIS, sign * X_AXIS], axis=1)
    in_mesh = frame(along_f_arm, palm_frame[:, NRM])
    # A straight arm does not separate its plane of bending from its carrying angle. So the
    # hinge is tilted by the part that no flexion produces.
    tilt, a, b = _turn_angles((R @ medial).T @ in_mesh, X, NRM, DIR)
    medial = medial @ about_axis(X, tilt)
    made.bind |= {f"{f_arm}.flexion": sign * a, f"{f_arm}.pronation": sign * b}
    turns = [(NRM, sign, f"{f_arm}.flexion"), (DIR, sign, f"{f_arm}.pronation")]
    R = made.node(f_arm, arm, elbow, medial, turns)
    made.bone(f_arm, [f_arm])

    beside = partial(made.node, parent=arm, place=elbow, zero=medial)
    beside(f"elbow_{side}", turns=_share(turns[:1], 0.5))
    beside(f"cubitus_{side}", turns=turns[:1])
    beside(f"forearm_{side}", turns=[turns[0], *_share(turns[1:], 0.5)])

    a, b, rest = _turn_angles(R.T @ palm_frame, X, NRM, DIR)
    _expect_small(rest, palm)
    made.bind |= {f"{palm}.flexion": a, f"{palm}.deviation": sign * b}
    turns = [(X, 1.0, f"{palm}.flexion"), (NRM, sign, f"{palm}.deviation")]
    made.node(palm, f_arm, wrist, np.eye(3), turns)
    made.bone(palm, [palm])
    made.node(f"carpus_{side}", f_arm, wrist, np.eye(3), _share(turns, 0.5))


def _share(turns: Sequence[Turn], part: float) -> list[Turn]:
    return [(axis, part * scale, coordinate) for axis, scale, coordinate in turns]


X_AXIS, DIR_AXIS, NRM_AXIS = np.eye(3)


def _crease(along_arm: Floats, along_f_arm: Floats) -> Floats:
    """Return the direction from the upper arm to which its elbow bends; forward if straight."""
    ahead: Floats = FORWARD if abs(along_arm @ FORWARD) < 0.9 else UP
    bend = np.cross(along_arm, along_f_arm)
    angle = np.degrees(np.arctan2(np.linalg.norm(bend), along_arm @ along_f_arm))
    crease = np.cross(bend, along_arm)
    if angle < STRAIGHT_DEG or (angle < BACKWARD_DEG and crease @ ahead < 0.0):
        return ahead
    return np.asarray(crease)


def _ways(ends: Sequence[Floats]) -> list[Floats]:
    """Return directions between places; equal places (missing joints) take the next direction."""
    ways = [b - a for a, b in pairwise(ends)]
    for k in range(len(ways) - 2, -1, -1):
        if np.linalg.norm(ways[k]) < SAME_M:
            ways[k] = ways[k + 1]
    return [unit(way) for way in ways]


def _palm_frame(anatomy: Anatomy, side: str, sign: float) -> Floats:
    """Return columns x, dir, nrm: dir from the wrist to the middle knuckle, x to the ulnar side."""
    wrist = anatomy.origin(f"palm_{side}")
    knuckle = {f: anatomy.origin(f"{f}_{side}_1") for f in FINGERS}
    across = sign * (knuckle["little"] - knuckle["index"])
    along = knuckle["middle"] - wrist
    return frame(along, np.cross(across, along))


def _finger(made: _Builder, anatomy: Anatomy, finger: str, side: str, sign: float) -> None:
    """Add a finger; at zero, its three frames are the palm's: straight and parallel.

    In the mesh, fingers are neither. The bind values come as near as turns in one plane can, and
    the mesh follows from there.
    """
    names = [f"{finger}_{side}_{k}" for k in PHALANGES]
    palm = f"palm_{side}"
    ends = [*(anatomy.origin(n) for n in names), anatomy.tips[f"{finger}_{side}"]]
    R = made.frames[made.names.index(palm)]
    ways = _ways(ends)
    above = palm
    for k, name in enumerate(names):
        d = R.T @ ways[k]
        turns: list[Turn] = [(X, 1.0, f"{name}.flexion")]
        if k == 0:
            spread = np.arctan2(-d[0], d[1])
            made.bind[f"{name}.deviation"] = sign * spread
            d = about_axis(NRM, -spread) @ d
            turns.insert(0, (NRM, sign, f"{name}.deviation"))
        made.bind[f"{name}.flexion"] = float(np.arctan2(d[2], d[1]))
        R = made.node(name, above, ends[k], np.eye(3), turns)
        made.bone(name, [name])
        above = name


def _thumb(made: _Builder, anatomy: Anatomy, side: str, sign: float) -> None:
    """Add the thumb; at zero it lies beside the index, along the palm, pad to the ulnar side.

    It bends in the plane perpendicular to the nail. The first frame lies in that plane, not along
    the metacarpal, which is hidden in flesh. So the two visible phalanges have their frames at
    their places.
    """
    names = [f"thumb_{side}_{k}" for k in PHALANGES]
    palm = f"palm_{side}"
    ends = [*(anatomy.origin(n) for n in names), anatomy.tips[f"thumb_{side}"]]
    along = _ways(ends)
    across = unit(np.cross(along[2], -anatomy.thumb_nail[side]))
    first = along[0] - across * (across @ along[0])
    in_mesh = frame(first, np.cross(across, first))
    zero = np.stack([-sign * NRM_AXIS, DIR_AXIS, sign * X_AXIS], axis=1)
    local = zero.T @ made.frames[made.names.index(palm)].T @ in_mesh
    a, b, c = _turn_angles(local, X, NRM, DIR)
    made.bind |= {
        f"{names[0]}.flexion": a,
        f"{names[0]}.abduction": sign * b,
        f"{names[0]}.roll": sign * c,
    }
    turns = [
        (X, 1.0, f"{names[0]}.flexion"),
        (NRM, sign, f"{names[0]}.abduction"),
        (DIR, sign, f"{names[0]}.roll"),
    ]
    R = made.node(names[0], palm, ends[0], zero, turns)
    made.bone(names[0], [names[0]])
    for k in (1, 2):
        d = R.T @ along[k]
        made.bind[f"{names[k]}.flexion"] = float(np.arctan2(d[2], d[1]))
        turns = [(X, 1.0, f"{names[k]}.flexion")]
        R = made.node(names[k], names[k - 1], ends[k], np.eye(3), turns)
        made.bone(names[k], [names[k]])


def _turn_angles(R: Floats, first: int, second: int, third: int) -> tuple[float, float, float]:
    """Return the angles of R = rot(first, a) · rot(second, b) · rot(third, c) for different axes.

    Of the two solutions, it takes the one with |b| ≤ 90°. At 90°, where only a sum of a and c is
    determined, it takes the one with a = 0.
    """
    handed = 1.0 if (second - first) % 3 == 1 else -1.0
    free = np.hypot(R[second, third], R[third, third])
    b = np.arctan2(handed * R[first, third], free)
    if free < LOCKED:
        return 0.0, float(b), float(np.arctan2(handed * R[second, first], R[second, second]))
    a = np.arctan2(-handed * R[second, third], R[third, third])
    c = np.arctan2(-handed * R[first, second], R[first, first])
    return float(a), float(b), float(c)


def _expect_small(angle: float, bone: str) -> None:
    if abs(angle) > 1e-9:
        raise ValueError(f"{bone} has a third turn of {np.degrees(angle):.3f}° in the mesh")
