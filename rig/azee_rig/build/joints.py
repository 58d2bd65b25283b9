"""The skeleton that a rig exports: joints kept, the others merged into them, helpers added."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.anatomy import SIDES, Anatomy
from azee_rig.build.chain_builder import BuiltChain
from azee_rig.build.makehuman import Body
from azee_rig.drive import Drive
from azee_rig.skeleton import Skeleton

Floats = NDArray[np.float64]

TWIST_COORDINATE = {"arm": "rotation", "f_arm": "pronation"}


@dataclass(frozen=True, eq=False, slots=True)
class BuiltJoints:
    """A skeleton, how it follows the chain, and the body's weights on its joints (N, J)."""

    skeleton: Skeleton
    drive: Drive
    weights: Floats


def build_joints(
    body: Body,
    anatomy: Anatomy,
    built: BuiltChain,
    bones: Mapping[str, Sequence[str]],
    kept: Sequence[str],
    twist: Mapping[str, Sequence[float]],
    helpers: Mapping[str, Sequence[str]],
    coordinate_names: Sequence[str],
) -> BuiltJoints:
    """Merge, place and drive the joints of a body.

    Args: bones: joints per AZee bone. kept: further joints that never move. twist: share of a
    limb's turn per joint. helpers: per helper joint the joint whose bend it halves, then the
    joints from which, besides that one, it takes over the skin in between.
    """
    bone_of = {joint: bone for bone, chain in bones.items() for joint in chain}
    names = [j for j in body.joints if j in bone_of or j in kept]
    merged, parents = _merge(body, names)
    places = {j: p for j, p in zip(body.joints, body.heads, strict=True) if j in names}
    for bone, chain in bones.items():
        places |= dict(zip(chain, anatomy.joints[bone], strict=True))
    half_of = [-1] * len(names)
    for helper, (bending, *_) in helpers.items():
        parents.append(parents[names.index(bending)])
        half_of.append(names.index(bending))
        places[helper] = places[bending]
        names.append(helper)
    where = np.array([places[n] for n in names])
    offsets = [p if up < 0 else p - where[up] for p, up in zip(where, parents, strict=True)]
    skeleton = Skeleton(tuple(names), np.array(parents), np.array(offsets))
    drive = _drive(skeleton, built, bones, bone_of, twist, half_of, coordinate_names)
    weights = np.pad(merged, ((0, 0), (0, len(helpers))))
    for side in SIDES:
        _free_of_eyes(weights, [names.index(j) for j in bones[f"eye_{side}"]], parents)
    for helper, (bending, *others) in helpers.items():
        _hand_over(
            weights,
            names.index(helper),
            names.index(bending),
            [names.index(other) for other in others],
        )
    return BuiltJoints(skeleton, drive, weights)


def _merge(body: Body, names: Sequence[str]) -> tuple[Floats, list[int]]:
    """Weights (N, J) and parents of the kept joints."""

    def nearest(j: int) -> int:
        while body.joints[j] not in names:
            j = int(body.parents[j])
        return names.index(body.joints[j])

    weights = np.zeros((len(body.vertices), len(names)))
    for j in range(len(body.joints)):
        weights[:, nearest(j)] += body.weights[:, j]
    above = [int(body.parents[body.joints.index(name)]) for name in names]
    return weights, [nearest(p) if p >= 0 else -1 for p in above]


def _free_of_eyes(weights: Floats, eyes: Sequence[int], parents: Sequence[int]) -> None:
    """Give skin around an eye, which the body's makers let it drag along, to the head alone."""
    for eye in eyes:
        dragged = weights[:, eye] < 0.5
        weights[dragged, parents[eye]] += weights[dragged, eye]
        weights[dragged, eye] = 0.0


def _hand_over(weights: Floats, helper: int, bending: int, others: Sequence[int]) -> None:
    """Skin that is torn between a bending joint and its neighbours goes to the helper.

    Where both hold half, the helper takes all; where one holds all, nothing: 2 · min.
    """
    near = weights[:, others].sum(axis=1)
    taken = np.minimum(near, weights[:, bending])
    share = taken / np.where(near > 0.0, near, 1.0)
    weights[:, helper] = 2.0 * taken
    weights[:, bending] -= taken
    weights[:, others] -= weights[:, others] * share[:, None]


def _drive(
    skeleton: Skeleton,
    built: BuiltChain,
    bones: Mapping[str, Sequence[str]],
    bone_of: Mapping[str, str],
    twist: Mapping[str, Sequence[float]],
    half_of: Sequence[int],
    coordinate_names: Sequence[str],
) -> Drive:
    count = len(skeleton.names)
    node = np.full(count, -1)
    coordinate = np.full(count, -1)
    left_out = np.zeros(count)
    for j, name in enumerate(skeleton.names):
        if name not in bone_of:
            continue
        bone = bone_of[name]
        chain = list(bones[bone])
        nodes = built.bones[bone]
        spread = nodes.node - nodes.origin_node + 1
        node[j] = nodes.origin_node + min(chain.index(name), spread - 1)
        if bone in twist:
            base, side = bone.rsplit("_", 1)
            coordinate[j] = coordinate_names.index(f"{bone}.{TWIST_COORDINATE[base]}")
            sign = 1.0 if side == "L" else -1.0
            left_out[j] = sign * (1.0 - twist[bone][chain.index(name)])
    bind = np.array([built.bind[c] for c in coordinate_names])
    return Drive(node, coordinate, left_out, np.array(half_of), built.chain.frames(bind).rotations)
