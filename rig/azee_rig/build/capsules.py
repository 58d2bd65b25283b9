"""Fits capsules to a body, which keep arms out of the trunk and hands out of the face.

Trunk: lateral capsules, as deep and as wide as the trunk at their height. Limbs: along the bone,
with the radius that holds most of the skin, or the usual one where that is a sleeve. Hands: two
capsules, on the thumb's and on the little finger's side, since a palm is flat. Fingers: one per
phalanx.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import product

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.anatomy import DIGITS, PHALANGES, SIDES, Anatomy
from azee_rig.build.surface import Surface
from azee_rig.chain import Frames
from azee_rig.rig import BoneNodes, Capsules

Floats = NDArray[np.float64]

TRUNK_HEIGHTS = (0.0, 0.17, 0.34, 0.51, 0.67, 0.84)
"""Heights as shares of the way from the lowest back joint to the neck."""
BAND_M = 0.03
LIMB_SHARE = 75.0
"""A limb's capsule holds this percentile of the skin's distances from the bone."""
ARMS = {
    "shoulder": (0.29, 0.36),
    "upper_arm": (0.23, 0.31),
    "elbow": (0.23, 0.31),
    "forearm": (0.175, 0.21),
}
"""Radius of an arm's capsules as a share of the bone's length: the mean of the bodies that ship,
and a fifth more than that of the heavy man. What is wider than that is a sleeve."""
HEAD = {
    "skull": ((0.0, 0.20, -1.49), (0.0, 0.41, -1.00), 1.41),
    "face": ((0.0, -0.55, 0.22), (0.0, -1.52, 0.02), 0.43),
    "jaw_L": ((0.27, -0.42, -0.62), (0.15, -1.00, -0.54), 0.93),
    "jaw_R": ((-0.27, -0.42, -0.62), (-0.15, -1.00, -0.54), 0.93),
}
"""The head's capsules: ends, from the middle between the eyes to the left, up and forward, and
radius, in distances between the eyes. They came out of a least-squares fit of four capsules to
the signer's skin without the ears: 95 % of it is less than 4 mm outside."""
FINGER_SHARE = 66.0
THIN = 0.2
"""Radius of a bone without skin, as a share of its length."""
COLLAR_M = 0.05
"""Half the thickness of the shoulders between neck and arm."""


@dataclass(eq=False)
class _Fitter:
    surface: Surface
    anatomy: Anatomy
    frames: Frames
    node_names: tuple[str, ...]
    bones: Mapping[str, BoneNodes]
    joints: Mapping[str, tuple[str, ...]]
    size: float
    lowered: Floats
    made: dict[str, tuple[int, Floats, Floats, float]] = field(default_factory=dict)

    def add(self, name: str, node: int, a: Floats, b: Floats, radius: float) -> None:
        R, p = self.frames.rotations[node], self.frames.positions[node]
        self.made[name] = (node, R.T @ (a - p), R.T @ (b - p), radius)

    def skin_of(self, *bones: str, at_least: float = 0.6) -> Floats:
        """Return the vertices that some bones carry, (n, 3)."""
        return self.surface.mesh.vertices[self.carried_by(*bones, at_least=at_least)]

    def carried_by(self, *bones: str, at_least: float = 0.6) -> NDArray[np.bool_]:
        """Tell which vertices some bones carry, (N,)."""
        joints = [j for bone in bones for j in self.joints[bone]]
        return np.asarray(self.surface.share(joints) >= at_least)


def fit_capsules(
    surface: Surface,
    anatomy: Anatomy,
    frames: Frames,
    node_names: tuple[str, ...],
    bones: Mapping[str, BoneNodes],
    joints: Mapping[str, tuple[str, ...]],
    size: float = 1.0,
    lowered: Floats | None = None,
) -> Capsules:
    """Fit all capsules in the mesh's own posture and list the pairs that must not overlap.

    Args: size: of the body, relative to the signer, where a length here is in metres. lowered:
        (N, 3) the vertices with the arms let down, if they are held out in the mesh's own posture:
        the flesh of raised shoulders makes a trunk some 2 cm wider on each side.
    """
    skin = surface.mesh.vertices if lowered is None else lowered
    fit = _Fitter(surface, anatomy, frames, node_names, bones, joints, size, skin)
    _fit_trunk(fit)
    _fit_head(fit)
    for side in SIDES:
        _fit_arm(fit, side)
    names = tuple(fit.made)
    nodes, a, b, radius = zip(*fit.made.values(), strict=True)
    index = {name: i for i, name in enumerate(names)}
    return Capsules(
        names,
        np.array(nodes),
        np.array(a),
        np.array(b),
        np.array(radius),
        np.array([(index[x], index[y]) for x, y in _pairs()]),
        np.array([(index[x], index[y]) for x, y in _finger_pairs(names)]),
    )


def _fit_trunk(fit: _Fitter) -> None:
    low, high = fit.anatomy.origin("back_1"), fit.anatomy.origin("neck")
    trunk = [n for n in fit.node_names if n.startswith("back_")]
    levels = [fit.frames.positions[fit.node_names.index(n)][1] for n in trunk]
    skin = fit.lowered[fit.carried_by("back_1", "back_2", "root")]
    for i, at in enumerate(TRUNK_HEIGHTS):
        y = low[1] + at * (high[1] - low[1])
        band = _band(skin, y, BAND_M * fit.size)
        depth = np.percentile(band[:, 2], [3.0, 97.0])
        radius = float(depth[1] - depth[0]) / 2.0
        half = max(float(np.percentile(np.abs(band[:, 0]), 97.0)) - radius, 0.01)
        middle = np.array([0.0, y, depth.mean()])
        node = trunk[max(0, sum(y >= level for level in levels) - 1)]
        out = np.array([half, 0.0, 0.0])
        fit.add(f"trunk_{i + 1}", fit.node_names.index(node), middle - out, middle + out, radius)


def _band(skin: Floats, y: float, half: float) -> Floats:
    """Return the skin near height y, or else the nearest; a small ball if there is no skin."""
    if not len(skin):
        return np.asarray((0.0, y, 0.0) + half * np.vstack([np.eye(3), -np.eye(3)]))
    gap = np.abs(skin[:, 1] - y)
    near = skin[gap < half]
    return np.asarray(near if len(near) else skin[np.argsort(gap)[:8]])


def _fit_head(fit: _Fitter) -> None:
    """Add skull, face, both jaws and the neck."""
    eyes = [fit.anatomy.origin(f"eye_{s}") for s in SIDES]
    middle, apart = (eyes[0] + eyes[1]) / 2.0, float(np.linalg.norm(eyes[0] - eyes[1]))
    head = fit.bones["head"].node
    for name, (a, b, radius) in HEAD.items():
        near, far = middle + apart * np.array(a), middle + apart * np.array(b)
        fit.add(name, head, near, far, apart * radius)
    _fit_limb(fit, "neck", fit.bones["neck"].node, "neck", "head", ("neck",), 0.0, 1.0)


def _fit_arm(fit: _Fitter, side: str) -> None:
    arm, f_arm, palm = (f"{b}_{side}" for b in ("arm", "f_arm", "palm"))
    _fit_limb(fit, f"shoulder_{side}", fit.bones[arm].node, arm, f_arm, (arm,), 0.0, 0.45)
    _fit_limb(fit, f"upper_arm_{side}", fit.bones[arm].node, arm, f_arm, (arm,), 0.45, 1.0)
    _fit_limb(fit, f"elbow_{side}", fit.bones[arm].node, arm, f_arm, (arm,), 0.66, 1.0)
    shoulder, neck = fit.anatomy.origin(arm), fit.anatomy.origin("neck")
    root = neck + 0.35 * (shoulder - neck)
    collar = fit.bones[f"clav_{side}"].node
    half = COLLAR_M * fit.size
    fit.add(f"collar_{side}", collar, root - (0.0, half, 0.0), shoulder, half)
    _fit_limb(fit, f"forearm_{side}", fit.bones[f_arm].node, f_arm, palm, (f_arm,), 0.12, 1.0)
    wrist = fit.anatomy.origin(palm)
    flesh = fit.skin_of(palm)
    R = fit.frames.rotations[fit.bones[palm].node]
    for name, fingers in (("radial", ("index", "middle")), ("ulnar", ("ring", "little"))):
        knuckle = np.mean([fit.anatomy.origin(f"{f}_{side}_1") for f in fingers], axis=0)
        start = wrist + 0.25 * (knuckle - wrist)
        depth = (flesh - start) @ R[:, 2]
        near = np.abs((flesh - start) @ R[:, 0]) < 0.02 * fit.size
        thick = np.percentile(depth[near], [5.0, 95.0]) if near.any() else np.zeros(2)
        middle = R[:, 2] * thick.mean() * 0.5
        radius = float(thick[1] - thick[0]) / 2.0
        fit.add(
            f"hand_{side}_{name}",
            fit.bones[palm].node,
            start + middle,
            knuckle,
            min(radius, 0.019 * fit.size),
        )
    for digit in DIGITS:
        for k in PHALANGES:
            bone = f"{digit}_{side}_{k}"
            near_end = fit.anatomy.origin(bone)
            tip = fit.anatomy.tips[f"{digit}_{side}"]
            far_end = tip if k == 3 else fit.anatomy.origin(f"{digit}_{side}_{k + 1}")
            flesh = fit.skin_of(bone, at_least=0.5)
            radius = _radius(
                flesh, near_end, far_end, FINGER_SHARE, from_end=0.45 if k == 1 else 0.1
            )
            if k == 3:
                far_end = far_end - (far_end - near_end) * min(
                    0.6, radius / float(np.linalg.norm(far_end - near_end))
                )
            fit.add(bone, fit.bones[bone].node, near_end, far_end, radius)


def _fit_limb(
    fit: _Fitter,
    name: str,
    node: int,
    start: str,
    end: str,
    flesh_of: tuple[str, ...],
    near: float,
    far: float,
) -> None:
    a, b = fit.anatomy.origin(start), fit.anatomy.origin(end)
    length_m = float(np.linalg.norm(b - a))
    a, b = a + near * (b - a), a + far * (b - a)
    radius = _radius(fit.skin_of(*flesh_of), a, b, LIMB_SHARE)
    if (part := name.rpartition("_")[0]) in ARMS:
        usual, most = ARMS[part]
        if radius > most * length_m:
            radius = usual * length_m
    fit.add(name, node, a, b, radius)


def _radius(points: Floats, a: Floats, b: Floats, share: float, from_end: float = 0.0) -> float:
    """Return a percentile of the distances of the points beside a segment from its line.

    Args: from_end: share of the segment at its start that does not count (webs between fingers).
    """
    along = (points - a) @ (b - a) / ((b - a) @ (b - a))
    counted = (along >= from_end) & (along <= 1.0)
    if not counted.any():
        return THIN * float(np.linalg.norm(b - a))
    foot = a + along[counted, None] * (b - a)
    return float(np.percentile(np.linalg.norm(points[counted] - foot, axis=1), share))


def _arm_names(side: str) -> tuple[str, ...]:
    return f"upper_arm_{side}", f"forearm_{side}", f"hand_{side}_radial", f"hand_{side}_ulnar"


def _pairs() -> Iterator[tuple[str, str]]:
    trunk = [f"trunk_{i + 1}" for i in range(len(TRUNK_HEIGHTS))]
    for side, other in zip(SIDES, reversed(SIDES), strict=True):
        upper, fore, *hand = _arm_names(side)
        yield from product([upper], [*trunk[:-2], *HEAD])
        yield from product([f"elbow_{side}"], [*trunk[-2:], "neck"])
        yield from product([fore, *hand], [*trunk, "neck", *HEAD])
        yield from product([fore, *hand], [f"shoulder_{other}", f"collar_{other}"])
        yield from product(hand, [f"collar_{side}"])
    left, right = (_arm_names(side) for side in SIDES)
    yield left[1], right[1]
    yield from product(left[2:], right)
    yield from product(left[:2], right[2:])


def _same_or_webbed(first: str, second: str) -> bool:
    """Whether two phalanges of one hand may touch: one digit, or neighbours at their web.

    The thumb's web is at its first phalanx only; the others can lie along the index finger.
    """
    (a, _, i), (b, _, j) = first.split("_"), second.split("_")
    apart = abs(DIGITS.index(a) - DIGITS.index(b))
    if "thumb" in (a, b):
        return apart == 0 or (apart == 1 and (i if a == "thumb" else j) == "1")
    return apart == 0 or (apart == 1 and "1" in (i, j))


def _finger_pairs(names: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """List pairs: fingers with trunk, head, other arm and hand, other digits; thumbs with palm."""
    body = [n for n in names if n.startswith(("trunk", "collar")) or n in ("neck", *HEAD)]
    own = {
        s: [n for n in names if n.split("_")[0] in DIGITS and n.split("_")[1] == s] for s in SIDES
    }
    for side, other in zip(SIDES, reversed(SIDES), strict=True):
        yield from product(own[side], [*body, *_arm_names(other), f"shoulder_{other}"])
        yield from product([f"thumb_{side}_{k}" for k in (2, 3)], _arm_names(side)[2:])
        for i, first in enumerate(own[side]):
            for second in own[side][i + 1 :]:
                if not _same_or_webbed(first, second):
                    yield first, second
    yield from product(own["L"], own["R"])
