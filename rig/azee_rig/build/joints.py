"""The skeleton that a rig exports: joints that stay, others merged into them, helpers added.

Linear blending loses volume where two joints that pull at the same skin turn far apart: half-way
between turns that differ by θ, skin comes nearer to the axis by cos(θ/2). So two neighbours must
not differ by much. The turn about a limb's axis is spread over joints along it, and a bend over
helpers that take a share each. Skin lies between two of them, and on no others.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.anatomy import SIDES, Anatomy
from azee_rig.build.bends import Bend, between, share_bend
from azee_rig.build.chain_builder import BuiltChain
from azee_rig.build.makehuman import Body
from azee_rig.coordinates import Coordinates
from azee_rig.drive import Drive
from azee_rig.skeleton import Skeleton

Floats = NDArray[np.float64]
Shares = Mapping[str, float]
"""Joints along a limb, proximal first, and the share of its turn that each takes: 0 … 1."""

TWIST_COORDINATE = {"arm": "rotation", "f_arm": "pronation"}
FOLLOWING = {"arm": "f_arm", "f_arm": "palm"}
"""The bone at whose origin a limb ends."""


@dataclass(frozen=True, eq=False, slots=True)
class BuiltJoints:
    """A skeleton, how it follows the chain, and the body's weights on its joints (N, J).

    flesh: all joints whose skin is that of an AZee bone; a helper's skin is that of the bone that
        bends.
    """

    skeleton: Skeleton
    drive: Drive
    weights: Floats
    flesh: Mapping[str, tuple[str, ...]]


def build_joints(
    body: Body,
    anatomy: Anatomy,
    built: BuiltChain,
    bones: Mapping[str, Sequence[str]],
    kept: Sequence[str],
    twist: Mapping[str, Shares],
    bends: Sequence[Bend],
    coordinates: Coordinates,
) -> BuiltJoints:
    """Merge, place and drive the joints of a body.

    Args: bones: joints per AZee bone. kept: further joints that never move. twist: per limb its
        joints; missing ones are added. bends: those of the hand before the wrist.
    """
    own = {joint for chain in bones.values() for joint in chain} | set(kept)
    names = [j for j in body.joints if j in own]
    above = {j: _nearest(body, j, own) for j in names}
    places = {j: p for j, p in zip(body.joints, body.heads, strict=True) if j in own}
    for bone, chain in bones.items():
        places |= dict(zip(chain, anatomy.joints[bone], strict=True))
    members = {bone: tuple(chain) for bone, chain in bones.items()}
    for bone, shares in twist.items():
        start, along = _limb(anatomy, bone)
        last, chain = bones[bone][-1], tuple(shares)
        names[names.index(last) + 1 : names.index(last) + 1] = chain[len(bones[bone]) :]
        above |= {j: chain[-1] for j, parent in above.items() if parent == last}
        above |= dict(zip(chain[1:], chain, strict=False))
        places |= {joint: start + share * along for joint, share in shares.items()}
        members[bone] = chain
    for bend in bends:
        names += bend.helpers
        above |= dict.fromkeys(bend.helpers, above[bend.joint])
        pivots = bend.pivots(built, coordinates)
        places |= {helper: places[bend.joint] + pivot for helper, pivot in pivots.items()}
    skeleton = _skeleton(names, above, places)
    return BuiltJoints(
        skeleton=skeleton,
        drive=_drive(skeleton, built, members, twist, bends, coordinates),
        weights=_weights(body, anatomy, skeleton, bones, own, twist, bends),
        flesh={
            bone: (*chain, *(h for bend in bends if bend.joint in chain for h in bend.helpers))
            for bone, chain in members.items()
        },
    )


def _nearest(body: Body, joint: str, own: set[str]) -> str | None:
    """Return the next joint above that stays."""
    j = int(body.parents[body.joints.index(joint)])
    while j >= 0 and body.joints[j] not in own:
        j = int(body.parents[j])
    return body.joints[j] if j >= 0 else None


def _limb(anatomy: Anatomy, bone: str) -> tuple[Floats, Floats]:
    """Return the start of a limb, and the vector to its end."""
    base, side = bone.rsplit("_", 1)
    start = anatomy.origin(bone)
    return start, anatomy.origin(f"{FOLLOWING[base]}_{side}") - start


def _skeleton(
    names: Sequence[str], above: Mapping[str, str | None], places: Mapping[str, Floats]
) -> Skeleton:
    parents, offsets = [], []
    for name in names:
        parent = above[name]
        parents.append(-1 if parent is None else names.index(parent))
        offsets.append(places[name] - (0.0 if parent is None else places[parent]))
    return Skeleton(tuple(names), np.array(parents), np.array(offsets))


def _weights(
    body: Body,
    anatomy: Anatomy,
    skeleton: Skeleton,
    bones: Mapping[str, Sequence[str]],
    own: set[str],
    twist: Mapping[str, Shares],
    bends: Sequence[Bend],
) -> Floats:
    column = {name: j for j, name in enumerate(skeleton.names)}
    weights = np.zeros((len(body.vertices), len(column)))
    for j, joint in enumerate(body.joints):
        to = joint if joint in own else _nearest(body, joint, own)
        if to is not None:
            weights[:, column[to]] += body.weights[:, j]
    for side in SIDES:
        for eye in bones[f"eye_{side}"]:
            _free_of_eye(weights, column[eye], int(skeleton.parents[column[eye]]))
    for bone in twist:
        first, *others = (column[j] for j in bones[bone])
        weights[:, first] += weights[:, others].sum(axis=1)
        weights[:, others] = 0.0
    for bend in bends:
        steps = [*(column[h] for h in bend.helpers), column[bend.joint]]
        share_bend(weights, [column[j] for j in bend.near], steps)
    for bone, shares in twist.items():
        start, along = _limb(anatomy, bone)
        at = (body.vertices - start) @ along / (along @ along)
        joints = [column[j] for j in shares]
        limb = weights[:, joints[0]].copy()
        weights[:, joints] = limb[:, None] * between(at, np.array(list(shares.values())))
    return weights


def _free_of_eye(weights: Floats, eye: int, parent: int) -> None:
    """Assign skin around an eye to the head alone; in the source, the eye drags it along."""
    dragged = weights[:, eye] < 0.5
    weights[dragged, parent] += weights[dragged, eye]
    weights[dragged, eye] = 0.0


def _drive(
    skeleton: Skeleton,
    built: BuiltChain,
    members: Mapping[str, Sequence[str]],
    twist: Mapping[str, Shares],
    bends: Sequence[Bend],
    coordinates: Coordinates,
) -> Drive:
    count = len(skeleton.names)
    node, coordinate, helper_of = np.full(count, -1), np.full(count, -1), np.full(count, -1)
    left_out, helper_share = np.zeros(count), np.zeros(count)
    column = {name: j for j, name in enumerate(skeleton.names)}
    for bone, chain in members.items():
        nodes = built.bones[bone]
        for i, joint in enumerate(chain):
            node[column[joint]] = min(nodes.origin_node + i, nodes.node)
    for bone, shares in twist.items():
        base, side = bone.rsplit("_", 1)
        sign = 1.0 if side == "L" else -1.0
        for joint, share in shares.items():
            coordinate[column[joint]] = coordinates.index[f"{bone}.{TWIST_COORDINATE[base]}"]
            left_out[column[joint]] = sign * (1.0 - share)
    for bend in bends:
        for helper, share in bend.shares.items():
            helper_of[column[helper]] = column[bend.joint]
            helper_share[column[helper]] = share
    bind = built.chain.frames(coordinates.bind).rotations
    return Drive(node, coordinate, left_out, helper_of, helper_share, bind)
