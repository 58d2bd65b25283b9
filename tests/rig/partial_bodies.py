"""Proposals for parts of a body, and for one with further joints or other names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from body_families import Body

from azee_rig.importing.bone_map import BoneMap
from azee_rig.importing.propose import propose
from azee_rig.importing.skeleton_tree import Tree

FINGERS = "Thumb Index Middle Ring Pinky"


ARMS = f"Shoulder Arm Hand {FINGERS}"


LEG_JOINTS = tuple(f"{side}{joint}" for side in ("Left", "Right")
                   for joint in ("UpLeg", "Leg", "Foot"))  # fmt: skip


def with_joints(body: Body, *more: tuple[str, str]) -> BoneMap:
    """Propose for the body with further joints, each a name and the joint that it hangs on."""
    names, parents, places = list(body.names), list(body.parents), list(body.places)
    for name, above in more:
        up = names.index(above)
        names.append(name)
        parents.append(up)
        places.append(places[up] + np.array([0.03, 0.0, 0.0]))
    return propose(Tree(tuple(names), np.array(parents), np.array(places)))


def part_of(body: Body, keep: str, root: str) -> BoneMap:
    """Propose for a part of the body: what hangs on `root`, without joints that `keep` drops."""
    tree = Tree(body.names, np.array(body.parents), body.places)
    below = tree.below(body.names.index(root))
    kept = [j for j in below if not any(word in body.names[j] for word in keep.split())]
    number = {j: i for i, j in enumerate(kept)}
    parents = [number.get(body.parents[j], -1) for j in kept]
    return propose(Tree(tree.named(kept), np.array(parents), body.places[kept]))


def with_names(body: Body, names: Mapping[str, str]) -> Body:
    """Return the body with other names for some joints."""
    assert names.keys() <= set(body.names)
    return replace(body, names=tuple(names.get(name, name) for name in body.names))


def renamed(body: Body, names: Mapping[str, str]) -> BoneMap:
    return with_joints(with_names(body, names))


def inserted(body: Body, name: str, child: str) -> Body:
    """Return the body with a joint between one and what that hangs on, half way."""
    at = body.names.index(child)
    up = body.parents[at]
    parents = [p + (p >= at) for p in body.parents]
    parents[at] = at
    return replace(
        body,
        names=(*body.names[:at], name, *body.names[at:]),
        parents=(*parents[:at], up, *parents[at:]),
        places=np.insert(body.places, at, (body.places[up] + body.places[at]) / 2.0, axis=0),
    )
