"""What retargeting keeps of a motion, measured on its source in the frame of the chest.

The frame has the columns left, up, forward; its origin is the middle of the shoulders. Hands and
fingers are read off the places of joints, so that neither the source's axes nor its rest posture
matter. How trunk and head turn is counted from the rest posture, if a figure stands there, else
from the first frame.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip, Label
from azee.clip.finite import check_numbers, check_times
from azee.clip.recording import Recording
from azee_rig.importing.bone_map import BoneMap
from azee_rig.importing.propose import propose
from azee_rig.importing.skeleton_tree import Tree
from azee_rig.rig import Rig
from azee_rig.rotation import rotation_vectors

Floats = NDArray[np.float64]

SIDES = ("L", "R")
FINGERS = ("index", "middle", "ring", "little")
BACK_SHARE = {"back_1": 0.45, "back_2": 0.55}
HEAD_SHARE = {"neck": 0.5, "head": 0.5}
"""How the turns of trunk and head are shared."""
LEAST_SHARE, LEAST_M = 0.05, 1e-4
"""A part of the body that is shorter than this share of the longest segment of the arms has no
length, nor has one that is shorter than this."""
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
    by name, (T,) radians: fingers, trunk, head. units: names and weights (T, M) of face units.
    notes: what was guessed or left out.

    Raises: ValueError: the arms have no length, or a number is none.
    """

    times: Floats
    arm_m: float
    wrists: Floats
    elbows: Floats
    palms: Floats
    coordinates: Mapping[str, Floats]
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
    arms = ("clav", "arm", "f_arm", "palm")
    return Measured(
        times=clip.times,
        arm_m=rig.landmarks.arm_m,
        wrists=seen("palm"),
        elbows=seen("f_arm"),
        palms=np.einsum("tba,tsbc->tsac", R, palms),
        coordinates={
            name: clip.coordinates[:, i]
            for i, name in enumerate(c.names)
            if not name.startswith(arms)
        },
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
        self.notes.append("where the body goes and how its legs move is left out")
        return Measured(
            times=self.recording.times,
            arm_m=float(np.median(lengths)),
            wrists=seen(wrists),
            elbows=seen(elbows),
            palms=np.einsum("tba,tsbc->tsac", chest, palms),
            coordinates=self._trunk() | self._hands(palms),
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
            along = _unit(tip - wrist)
            return _frames(along, np.cross(across, along))
        self.notes.append(
            f"no fingers on side {side}: its palm is taken to face inward where the arm hangs, and "
            "down where it is held out"
        )
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

    def _hands(self, palms: Floats) -> dict[str, Floats]:
        """Angles of the fingers, from the directions of their bones in the palm."""
        found: dict[str, Floats] = {}
        for s, side in enumerate(SIDES):
            sign = 1.0 if side == "L" else -1.0
            for digit in FINGERS:
                ends = self._ends(digit, side)
                if ends is None:
                    continue
                ways = np.einsum("tba,tkb->tka", palms[:, s], np.diff(ends, axis=1))
                spread = np.arctan2(-ways[:, 0, 0], np.hypot(ways[:, 0, 1], ways[:, 0, 2]))
                bends = np.arctan2(ways[..., 2], ways[..., 1])
                bend = np.diff(np.unwrap(bends, axis=1), axis=1, prepend=0.0)
                found[f"{digit}_{side}_1.deviation"] = sign * spread
                for k in range(3):
                    found[f"{digit}_{side}_{k + 1}.flexion"] = bend[:, k]
            thumb = self._ends("thumb", side)
            if thumb is not None:
                found |= _thumb(
                    np.einsum("tba,tkb->tka", palms[:, s], np.diff(thumb, axis=1)), side
                )
        return found

    def _ends(self, digit: str, side: str) -> Floats | None:
        """Places of a digit's joints and its tip, (T, 4, 3); None where joints are missing."""
        names = [self.bones.bones.get(f"{digit}_{side}_{k}") for k in (1, 2, 3)]
        joints = [self.index[chain[0]] for chain in names if chain]
        if len(joints) < 3:
            return None
        last = joints[-1]
        below = [j for j, p in enumerate(self.recording.skeleton.parents) if p == last]
        if below:
            tip = self.places[:, below[0]]
        elif last in self.recording.tips:
            tip = self.places[:, last] + self.turned[:, last] @ self.recording.tips[last]
        else:
            tip = 2.0 * self.places[:, last] - self.places[:, joints[-2]]
        if np.linalg.norm(tip - self.places[:, last], axis=-1).min() < 1e-4:
            tip = 2.0 * self.places[:, last] - self.places[:, joints[-2]]
        return np.stack([*(self.places[:, j] for j in joints), tip], axis=1)


def _thumb(ways: Floats, side: str) -> dict[str, Floats]:
    """Angles of a thumb from the directions of its bones in the palm's frame, (T, 3, 3).

    Its first bone's frame at zero has the columns (−s nrm, dir, s x) of the palm, s the side's
    sign; flexion about x, then abduction about nrm put its direction there. How the pad rolls no
    place of a joint tells; it keeps what it is at idle.
    """
    sign = 1.0 if side == "L" else -1.0
    zero = np.array([[0.0, 0.0, -sign], [0.0, 1.0, 0.0], [sign, 0.0, 0.0]])
    first = _unit(ways[:, 0]) @ zero.T
    flexion = np.arctan2(first[:, 2], first[:, 1])
    abduction = sign * np.arcsin(np.clip(-first[:, 0], -1.0, 1.0))
    bends = [
        np.arccos(np.clip((_unit(ways[:, k]) * _unit(ways[:, k + 1])).sum(axis=-1), -1.0, 1.0))
        for k in (0, 1)
    ]
    return {
        f"thumb_{side}_1.flexion": flexion,
        f"thumb_{side}_1.abduction": abduction,
        f"thumb_{side}_2.flexion": bends[0],
        f"thumb_{side}_3.flexion": bends[1],
    }


def _unit(v: Floats) -> Floats:
    return np.asarray(v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-12))


def _frames(along: Floats, normal: Floats) -> Floats:
    """Columns x, dir, nrm, (T, 3, 3)."""
    n = _unit(normal - along * (normal * along).sum(axis=-1, keepdims=True))
    return np.stack([np.cross(along, n), along, n], axis=-1)
