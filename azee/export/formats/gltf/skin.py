"""The skeleton as glTF nodes, and the skin that binds a mesh to them."""

from __future__ import annotations

import numpy as np

from azee.export.formats.gltf.document import Document
from azee_rig.skeleton import Skeleton


def add_joints(document: Document, skeleton: Skeleton) -> tuple[int, ...]:
    """Add a node per joint, with its own name, in the rest pose; returns the nodes' indices.

    In the rest pose every joint's axes are the world's, so a node needs only its offset.
    """
    start = len(document.objects.get("nodes", ()))
    children: list[list[int]] = [[] for _ in skeleton.names]
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            children[parent].append(start + joint)
    return tuple(
        document.add(
            "nodes",
            name=name,
            translation=[float(np.float32(x)) for x in offset],
            children=below or None,
        )
        for name, offset, below in zip(skeleton.names, skeleton.offsets, children, strict=True)
    )


def add_skin(document: Document, skeleton: Skeleton, nodes: tuple[int, ...]) -> int:
    """Add the skin over the joints' nodes; its inverse bind matrices undo the rest positions."""
    inverse = np.tile(np.eye(4, dtype=np.float32), (len(nodes), 1, 1))
    inverse[:, :3, 3] = -skeleton.rest_positions
    by_column = inverse.transpose(0, 2, 1).reshape(-1, 16)
    roots = [node for node, parent in zip(nodes, skeleton.parents, strict=True) if parent < 0]
    return document.add(
        "skins",
        joints=list(nodes),
        skeleton=roots[0] if len(roots) == 1 else None,
        inverseBindMatrices=document.accessor(by_column),
    )
