"""The skeleton of an imported body, and how its joints follow the chain."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.anatomy import Anatomy
from azee_rig.build.chain_builder import BuiltChain
from azee_rig.coordinates import Coordinates
from azee_rig.drive import Drive
from azee_rig.importing.bone_map import BoneMap
from azee_rig.importing.reduced import Reduced
from azee_rig.skeleton import Skeleton

Floats = NDArray[np.float64]

TURNS = {"arm": "rotation", "f_arm": "pronation"}
FOLLOWING = {"arm": "f_arm", "f_arm": "palm"}


@dataclass(frozen=True, eq=False, slots=True)
class Limbs:
    """A skeleton and its drive. flesh: by AZee bone the joints that carry its skin."""

    skeleton: Skeleton
    drive: Drive
    flesh: Mapping[str, tuple[str, ...]]


def build_limbs(
    reduced: Reduced,
    bones: BoneMap,
    eyes: Mapping[str, str],
    anatomy: Anatomy,
    built: BuiltChain,
    coordinates: Coordinates,
    vertices: Floats,
) -> Limbs:
    """Drive a body's own joints.

    The place of a joint's skin along the limb, from its start (none) to its end (all), gives the
    share of the limb's twist that the joint takes. So a forearm of one joint turns by half, and one
    with twist joints turns evenly.

    Args: eyes: joint of each eye, by side, if there is one.
    """
    chains = dict(bones.bones) | {f"eye_{side}": (joint,) for side, joint in eyes.items()}
    places = dict(zip(reduced.names, reduced.places, strict=True))
    node = np.full(len(reduced.names), -1)
    coordinate = np.full(len(reduced.names), -1)
    left_out = np.zeros(len(reduced.names))
    flesh = {bone: chains.get(bone, ()) for bone in anatomy.joints}
    for bone, chain in chains.items():
        nodes = built.bones[bone]
        for i, joint in enumerate(chain):
            places[joint] = anatomy.joints[bone][i]
            node[reduced.names.index(joint)] = min(nodes.origin_node + i, nodes.node)
    for base in TURNS:
        for side in "LR":
            bone = f"{base}_{side}"
            twists = bones.twists.get(bone, ())
            flesh[bone] = (*chains[bone], *twists)
            for joint in flesh[bone]:
                j = reduced.names.index(joint)
                node[j] = built.bones[bone].node
                share = _along(reduced, anatomy, bone, joint, vertices)
                if joint in twists:
                    places[joint] = _on_axis(anatomy, bone, places[joint])
                coordinate[j] = coordinates.index[f"{bone}.{TURNS[base]}"]
                left_out[j] = (1.0 if side == "L" else -1.0) * (1.0 - share)
    where = np.array([places[name] for name in reduced.names])
    offsets = np.array(
        [p if up < 0 else p - where[up] for p, up in zip(where, reduced.parents, strict=True)]
    )
    skeleton = Skeleton(reduced.names, reduced.parents, offsets)
    drive = Drive(
        node=node,
        twist_coordinate=coordinate,
        twist_left_out=left_out,
        helper_of=np.full(len(node), -1),
        helper_share=np.zeros(len(node)),
        bind=built.chain.frames(coordinates.bind).rotations,
    )
    return Limbs(skeleton, drive, {"root": (reduced.names[0],), **flesh})


def _limb(anatomy: Anatomy, bone: str) -> tuple[Floats, Floats]:
    base, side = bone.rsplit("_", 1)
    start = anatomy.origin(bone)
    return start, anatomy.origin(f"{FOLLOWING[base]}_{side}") - start


def _on_axis(anatomy: Anatomy, bone: str, place: Floats) -> Floats:
    start, way = _limb(anatomy, bone)
    return np.asarray(start + way * ((place - start) @ way) / (way @ way))


def _along(reduced: Reduced, anatomy: Anatomy, bone: str, joint: str, vertices: Floats) -> float:
    """Return the middle of a joint's skin along its limb, 0 … 1."""
    start, way = _limb(anatomy, bone)
    weights = reduced.weights[:, reduced.names.index(joint)]
    at = np.clip((vertices - start) @ way / (way @ way), 0.0, 1.0)
    total = float(weights.sum())
    return float((weights * at).sum() / total) if total > 0.0 else 0.5
