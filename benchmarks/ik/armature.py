"""The signer's bones alone, in a form that any solver of inverse kinematics can take.

The armature has trunk, arms and fingers with the signer's joints and limits, one node per bone and
one angle per axis. It has no couplings, head, helper joints, skin or capsules.
"""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import numpy as np

from azee_rig.chain import Chain
from azee_rig.coordinates import Coordinates
from azee_rig.rig import BoneNodes, Capsules, Rig, RigSite

TRUNK = {"back_1.1": "back_1", "back_2.1": "back_2"}
LEFT_OUT = ("neck", "head", "eye", "elbow", "carpus", "back")


def bare_armature(body: Rig) -> Rig:
    """Return the armature of a body, with its sites at their places in the zero pose."""
    chain = body.chain
    kept = {
        b: TRUNK.get(name, name)
        for b, name in enumerate(chain.names)
        if name in TRUNK or not name.startswith(LEFT_OUT)
    }
    order = list(kept)
    above = {b: _carrier(body, b, kept) for b in range(len(chain.names))}
    at_zero = chain.frames(np.zeros(len(body.coordinates)))
    parents, offsets, zero = [], [], []
    start, axis, scale, names = [0], [], [], []
    for b in order:
        parent = above[int(chain.parents[b])] if chain.parents[b] >= 0 else -1
        parents.append(order.index(parent) if parent >= 0 else -1)
        base = at_zero.rotations[parent] if parent >= 0 else np.eye(3)
        origin = at_zero.positions[parent] if parent >= 0 else np.zeros(3)
        offsets.append(base.T @ (at_zero.positions[b] - origin))
        zero.append(base.T @ at_zero.rotations[b])
        for d in range(int(chain.dof_start[b]), int(chain.dof_start[b + 1])):
            name = body.coordinates.names[int(chain.dof_coordinate[d])]
            coupled = abs(chain.dof_scale[d]) != 1.0 and chain.names[b] not in TRUNK
            if name.split(".")[0] == kept[b] and not coupled:
                axis.append(int(chain.dof_axis[d]))
                scale.append(float(np.sign(chain.dof_scale[d])))
                names.append(name)
        start.append(len(axis))
    old = [body.coordinates.index[name] for name in names]
    given: dict[str, Any] = {
        "name": f"{body.name}'s bare armature",
        "coordinates": Coordinates(
            tuple(names),
            *(
                getattr(body.coordinates, field)[old]
                for field in ("lower", "upper", "idle", "bind", "stiffness")
            ),
        ),
        "chain": Chain(
            tuple(kept.values()),
            np.array(parents),
            np.array(offsets),
            np.array(zero),
            np.array(start),
            np.array(axis),
            np.array(scale),
            np.arange(len(names)),
        ),
        "bones": {name: BoneNodes(n, n) for n, name in enumerate(kept.values())},
        "sites": {},
        "capsules": _no_capsules(),
        "landmarks": body.landmarks,
        "signing_space": body.signing_space,
        "skeletal_morphs": {},
        "face_morphs": {},
    }
    for site in body.sites.values():
        if site.node < 0 or part_left_out(chain.names[site.node]):
            continue
        carrier = above[site.node]
        turn = at_zero.rotations[carrier].T
        world = site.point(at_zero)
        given["sites"][site.name] = RigSite(
            site.name,
            kept[carrier],
            order.index(carrier),
            turn @ (world - at_zero.positions[carrier]),
            turn @ at_zero.rotations[site.node] @ site.normal,
        )
    # Nodes that only the skin needs are left out.
    everything: dict[str, Any] = {f.name: given.get(f.name) for f in fields(Rig)}
    return Rig(**everything)


def pinned(body: Rig) -> Rig:
    """Return a body whose sites are fixed in the frame of one node, as at the zero pose.

    Sites near joints depend on several nodes, which the residuals of other methods do not support.
    """
    at_zero = body.chain.frames(np.zeros(len(body.coordinates)))
    sites = {}
    for name, site in body.sites.items():
        if site.node < 0:
            continue  # what stands still has no frame to be fixed in
        turn = at_zero.rotations[site.node].T
        local = turn @ (site.point(at_zero) - at_zero.positions[site.node])
        sites[name] = replace(site, position=local, normal=turn @ site.outward(at_zero), shares=())
    return replace(body, sites=sites)


def part_left_out(node: str) -> bool:
    """Whether sites of a node are left out with the node."""
    return node.startswith(("neck", "head", "eye"))


def _carrier(body: Rig, node: int, kept: dict[int, str]) -> int:
    while node not in kept:
        node = int(body.chain.parents[node])
    return node


def _no_capsules() -> Capsules:
    """Return one capsule that no other must avoid."""
    pairs = np.empty((0, 2), dtype=np.int64)
    ends = np.zeros((1, 3))
    return Capsules(("trunk",), np.zeros(1, dtype=np.int64), ends, ends, np.ones(1), pairs, pairs)
