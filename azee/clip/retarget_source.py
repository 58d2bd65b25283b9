"""What retargeting keeps of a motion, measured on its source in the frame of the chest.

The frame has the columns left, up, forward; its origin is the middle of the shoulders. Hands are
read off the places of joints, so that neither the source's axes nor its rest posture matter;
`azee.clip.digit_source` measures the fingers. How trunk and head turn is counted from the rest
posture, if a figure stands there, else from the first frame.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip, Label
from azee.clip.digit_source import DigitJoints, joints_of, measure_digit
from azee.clip.digits import DIGITS, FINGERS, SIDES, Digit, DigitFit
from azee.clip.finite import check_numbers, check_times
from azee.clip.recording import Recording
from azee_rig.importing.bone_map import BoneMap
from azee_rig.importing.propose import propose
from azee_rig.importing.skeleton_tree import Tree
from azee_rig.rig import Rig
from azee_rig.rotation import rotation_vectors

Floats = NDArray[np.float64]

BACK_SHARE = {"back_1": 0.45, "back_2": 0.55}
HEAD_SHARE = {"neck": 0.5, "head": 0.5}
"""How the turns of trunk and head are shared."""
LEAST_SHARE, LEAST_M = 0.05, 1e-4
"""A part of the body that is shorter than this share of the longest segment of the arms has no
length, nor has one that is shorter than this."""
ALIKE = 0.8
"""Share of one side's length that the other's has, if joints of both were read alike."""
UPRIGHT_DEG = 20.0
"""A figure that leans less stands straight along an axis of its file."""
TURNS = {"flexion": (0, 1.0), "axial": (1, 1.0), "lateral": (2, -1.0)}
"""Component and sign of a rotation vector (left, up, forward) for each coordinate."""


class RetargetError(Exception):
    """Motion of a skeleton without recognisable arms. The message is for the user."""


@dataclass(frozen=True, eq=False)
class Measured:
    """A motion of T frames, without its body.

    arm_m: length of the arms. wrists, elbows: (T, 2, 3) metres from the middle of the shoulders,
    in the chest's frame. palms: (T, 2, 3, 3) columns x, dir, nrm of the palms there. coordinates:
    by name, (T,) radians: trunk, head, eyes. digits: those that have joints to bend. units: names
    and weights (T, M) of face units. notes: what was guessed or left out.

    Raises: ValueError: the arms have no length, or a number is none.
    """

    times: Floats
    arm_m: float
    wrists: Floats
    elbows: Floats
    palms: Floats
    coordinates: Mapping[str, Floats]
    digits: tuple[Digit, ...]
    units: tuple[tuple[str, ...], Floats]
    labels: tuple[Label, ...] = ()
    notes: tuple[str, ...] = field(default=())

    def __post_init__(self) -> None:
        check_times(self.times)
        if not self.arm_m > 0.0:
            raise ValueError("arms have no length")
        for name in ("arm_m", "wrists", "elbows", "palms"):
            check_numbers(name, getattr(self, name))
        for name, values in self.coordinates.items():
            check_numbers(name, values)


def measure_clip(clip: Clip, rig: Rig) -> Measured:
    """Measure a clip on its rig."""
    c = rig.coordinates
    at = rig.chain.frames(clip.coordinates)
    chest = rig.bones["back_2"].node
    still = rig.chain.frames(c.idle)
    middle = still.rotations[chest].T @ (rig.landmarks.shoulder_middle - still.positions[chest])
    R = at.rotations[:, chest]
    origin = at.positions[:, chest] + R @ middle

    def seen(bone: str) -> Floats:
        nodes = [rig.bones[f"{bone}_{s}"].origin_node for s in SIDES]
        return np.asarray(np.einsum("tba,tsb->tsa", R, at.positions[:, nodes] - origin[:, None]))

    palms = at.rotations[:, [rig.bones[f"palm_{s}"].node for s in SIDES]]
    elsewhere = ("clav", "arm", "f_arm", "palm", *DIGITS)
    digits = [
        Digit(
            f"{digit}_{side}",
            np.einsum(
                "tba,tnbc->tnac",
                palms[:, s],
                at.rotations[:, [rig.bones[f"{digit}_{side}_{k}"].node for k in (1, 2, 3)]],
            ),
        )
        for s, side in enumerate(SIDES)
        for digit in DIGITS
        if DigitFit(rig, f"{digit}_{side}").exists
    ]
    return Measured(
        times=clip.times,
        arm_m=rig.landmarks.arm_m,
        wrists=seen("palm"),
        elbows=seen("f_arm"),
        palms=np.einsum("tba,tsbc->tsac", R, palms),
        coordinates={
            name: clip.coordinates[:, i]
            for i, name in enumerate(c.names)
            if not name.startswith(elsewhere)
        },
        digits=tuple(digits),
        units=(clip.units, clip.unit_weights),
        labels=clip.labels,
    )


def measure_recording(recording: Recording) -> Measured:
    """Measure motion of any skeleton with two arms.

    Raises: RetargetError: the arms cannot be recognised.
    """
    places, turned = recording.frames()
    skeleton = recording.skeleton
    bones = propose(Tree(skeleton.names, skeleton.parents, places[0]))
    if bones.lacking:
        raise RetargetError(f"the skeleton has no joints that could be {', '.join(bones.lacking)}")
    try:
        return _Reader(recording, bones, places, turned).measured()
    except ValueError as error:
        raise RetargetError(str(error)) from error


class _Reader:
    """A recording, with its joints by AZee's bones."""

    def __init__(
        self, recording: Recording, bones: BoneMap, places: Floats, turned: Floats
    ) -> None:
        self.recording, self.bones, self.places, self.turned = recording, bones, places, turned
        self.index = {name: j for j, name in enumerate(recording.skeleton.names)}
        self.notes = [*recording.notes]
        self.bare: list[str] = []
        """Sides on which no fingers tell how the palm is turned."""
        self._check_lengths()
        upright = self._upright()
        self.still = recording.skeleton.rest_positions if upright else places[0]
        """Places of the joints in an upright posture: the rest pose, or else the first frame."""
        self.turned_still = np.tile(np.eye(3), (len(places[0]), 1, 1)) if upright else turned[0]
        self.axes = self._axes()

    def at(self, bone: str) -> Floats:
        """Where a bone begins, (T, 3)."""
        return self.places[:, self.index[self.bones.bones[bone][0]]]

    def _check_lengths(self) -> None:
        """Refuse a body whose directions nothing tells. Raises: RetargetError."""
        ends = {
            "upper arm": ("arm", "f_arm"), "forearm": ("f_arm", "palm"),
        }  # fmt: skip
        lengths = {
            f"{part} {side}": self._apart(f"{above}_{side}", f"{below}_{side}")
            for side in SIDES
            for part, (above, below) in ends.items()
        }
        for part in ends:
            left, right = (lengths[f"{part} {side}"] for side in SIDES)
            if min(left, right) < ALIKE * max(left, right):
                self.notes.append(
                    f"{part}s are {100 * left:.0f} cm (L) and {100 * right:.0f} cm (R) long: "
                    "joints may be misread"
                )
        longest = max(lengths.values())
        lengths["line of the shoulders"] = self._apart("arm_L", "arm_R")
        lengths["way from the hips to the head"] = float(
            np.linalg.norm(
                self.places[0, self._joint("head")] - self.places[0, self.index[self.bones.root]]
            )
        )
        for part, length in lengths.items():
            if length <= max(LEAST_M, LEAST_SHARE * longest):
                raise RetargetError(f"the {part} has no length")

    def _apart(self, first: str, second: str) -> float:
        """Median distance of two joints, metres."""
        return float(np.median(np.linalg.norm(self.at(first) - self.at(second), axis=-1)))

    def measured(self) -> Measured:
        shoulders = np.stack([self.at(f"arm_{s}") for s in SIDES], axis=1)
        elbows = np.stack([self.at(f"f_arm_{s}") for s in SIDES], axis=1)
        wrists = np.stack([self.at(f"palm_{s}") for s in SIDES], axis=1)
        middle = shoulders.mean(axis=1)
        chest = self._frame(self._chest())
        lengths = np.linalg.norm(elbows - shoulders, axis=-1) + np.linalg.norm(
            wrists - elbows, axis=-1
        )

        def seen(points: Floats) -> Floats:
            return np.asarray(np.einsum("tba,tsb->tsa", chest, points - middle[:, None]))

        palms = np.stack([self._palm(s) for s in SIDES], axis=1)
        if self.bare:
            self.notes.append(
                f"no fingers ({', '.join(self.bare)}): palms are taken to face inward where the "
                "arm hangs, and down where it is held out"
            )
        self.notes.append("where the body goes and how its legs move is left out")
        return Measured(
            times=self.recording.times,
            arm_m=float(np.median(lengths)),
            wrists=seen(wrists),
            elbows=seen(elbows),
            palms=np.einsum("tba,tsbc->tsac", chest, palms),
            coordinates=self._trunk(),
            digits=self._digits(palms),
            units=((), np.zeros((len(middle), 0))),
            notes=tuple(self.notes),
        )

    def _chest(self) -> int:
        return self.index[self.bones.bones.get("back_2", (self.bones.root,))[-1]]

    def _frame(self, joint: int) -> Floats:
        """Return columns left, up, forward of a part of the body, (T, 3, 3): upright in `still`."""
        still = self.turned_still[joint]
        return np.asarray(self.turned[:, joint] @ still.T @ self.axes)

    def _axes(self) -> Floats:
        """Return left, up, forward of the upright body, in the file's axes, (3, 3)."""
        up = self.still[self._joint("head")] - self.still[self.index[self.bones.root]]
        up = _unit(up)
        axis = int(np.abs(up).argmax())
        if abs(up[axis]) > np.cos(np.radians(UPRIGHT_DEG)):
            up = np.sign(up[axis]) * np.eye(3)[axis]
        across = self.still[self._joint("arm_L")] - self.still[self._joint("arm_R")]
        left = across - up * (across @ up)
        if np.linalg.norm(left) < LEAST_SHARE * np.linalg.norm(across):
            raise RetargetError("one shoulder stands above the other")
        left = _unit(left)
        return np.stack([left, up, np.cross(left, up)], axis=-1)

    def _palm(self, side: str) -> Floats:
        """Return columns x, dir, nrm of a palm, (T, 3, 3): by knuckles or the hand's rotation."""
        wrist = self.at(f"palm_{side}")
        there = [f"{f}_{side}_1" for f in FINGERS if f"{f}_{side}_1" in self.bones.bones]
        sign = 1.0 if side == "L" else -1.0
        if len(there) >= 2:
            middle = f"middle_{side}_1"
            tip = self.at(middle) if middle in there else np.mean([self.at(b) for b in there], 0)
            across = sign * (self.at(there[-1]) - self.at(there[0]))
            normal = np.cross(across, tip - wrist)
            square = np.linalg.norm(tip - wrist, axis=-1) ** 2
            if (np.linalg.norm(normal, axis=-1) > LEAST_SHARE * square).all():
                return _frames(_unit(tip - wrist), normal)
        self.bare.append(side)
        hand, elbow = self._joint(f"palm_{side}"), self._joint(f"f_arm_{side}")
        along = _unit(self.still[hand] - self.still[elbow])
        x, y, _ = np.abs(self.axes.T @ along)
        facing = self.axes @ np.array([-sign * y, -x - 0.1, 0.0])
        held = _frames(along[None], facing[None])[0]
        return np.asarray(self.turned[:, hand] @ self.turned_still[hand].T @ held)

    def _trunk(self) -> dict[str, Floats]:
        """Angles of back, neck and head."""
        root, chest, head = self.index[self.bones.root], self._chest(), self._joint("head")
        found: dict[str, Floats] = {}
        for low, top, shares in ((root, chest, BACK_SHARE), (chest, head, HEAD_SHARE)):
            relative = np.swapaxes(self._frame(low), 1, 2) @ self._frame(top)
            vectors = rotation_vectors(relative)
            for bone, share in shares.items():
                for name, (component, sign) in TURNS.items():
                    found[f"{bone}.{name}"] = share * sign * vectors[:, component]
        return found

    def _upright(self) -> bool:
        """Whether the rest pose is upright: its head as high over its hips as in frame one."""
        still = self.recording.skeleton.rest_positions
        root, head = self.index[self.bones.root], self._joint("head")
        height = float(np.linalg.norm(still[head] - still[root]))
        now = float(np.linalg.norm(self.places[0, head] - self.places[0, root]))
        left = still[self._joint("arm_L")] - still[self._joint("arm_R")]
        width = float(np.linalg.norm(self.places[0, self._joint("arm_L")]
                                     - self.places[0, self._joint("arm_R")]))  # fmt: skip
        return height > 0.9 * now and float(np.linalg.norm(left)) > 0.8 * width

    def _joint(self, bone: str) -> int:
        return self.index[self.bones.bones[bone][0]]

    def _digits(self, palms: Floats) -> tuple[Digit, ...]:
        """Fingers and thumbs that have joints enough to bend."""
        found: list[Digit] = []
        still, shared = [], []
        for s, side in enumerate(SIDES):
            for digit in DIGITS:
                joints = self._digit_joints(digit, side)
                if joints is None or not joints.whole:
                    still.append(f"{digit} {side}")
                    continue
                if len(joints.ways) == 2:
                    shared.append(joints.name)
                found.append(measure_digit(joints, palms[:, s]))
        if still and found:
            self.notes.append(f"without joints to bend, and left at rest: {', '.join(still)}")
        if shared:
            self.notes.append(
                f"{len(shared)} digits have two joints: what the second bends is shared by two"
            )
        return tuple(found)

    def _digit_joints(self, digit: str, side: str) -> DigitJoints | None:
        joints = joints_of(digit, side, self.bones.bones, self.index)
        if not joints:
            return None
        places = np.median(self.recording.translations, axis=0)
        ways = [
            # Bones between two of a digit's joints, such as twist bones, are taken as straight.
            sum((places[j] for j in self._between(above, below)), np.zeros(3))
            for above, below in pairwise(joints)
        ]
        return DigitJoints(
            f"{digit}_{side}", self.turned[:, joints], np.array([*ways, self._end(joints[-1])])
        )

    def _between(self, above: int, below: int) -> list[int]:
        """Joints on the way down from one to another, the last among them."""
        path, parents = [below], self.recording.skeleton.parents
        while parents[path[-1]] not in (above, -1):
            path.append(int(parents[path[-1]]))
        return path

    def _end(self, joint: int) -> Floats:
        """Where a last bone ends, (3,) in its joint's axes; zero where nothing tells."""
        below = np.flatnonzero(self.recording.skeleton.parents == joint)
        if len(below):
            return np.asarray(np.median(self.recording.translations[:, below[0]], axis=0))
        return np.asarray(self.recording.tips.get(joint, np.zeros(3)))


def _unit(v: Floats) -> Floats:
    return np.asarray(v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-12))


def _frames(along: Floats, normal: Floats) -> Floats:
    """Columns x, dir, nrm, (T, 3, 3)."""
    n = _unit(normal - along * (normal * along).sum(axis=-1, keepdims=True))
    return np.stack([np.cross(along, n), along, n], axis=-1)
