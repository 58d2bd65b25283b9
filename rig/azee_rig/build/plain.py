"""The same body with plain skinning, for comparison: no helpers, spread twist or rhythm."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from azee_rig.mesh import BodyMesh
from azee_rig.rig import Rig


def plain(rig: Rig) -> tuple[Rig, BodyMesh]:
    """Return a rig of rigid bones, and its mesh: every joint turns as its bone does.

    Skin on a helper returns to the joints on both sides of the bend, by the helper's share of it,
    and a limb's skin to the limb's first joint. A raised arm does not lift its shoulder.
    """
    drive, chain = rig.drive, rig.chain
    back = np.eye(len(drive.node))
    for j in np.flatnonzero(drive.twist_coordinate >= 0):
        first = int(np.flatnonzero(drive.node == drive.node[j])[0])
        back[j] = np.eye(len(back))[first]
    for j in np.flatnonzero(drive.helper_of >= 0):
        bends, share = int(drive.helper_of[j]), float(drive.helper_share[j])
        near = int(rig.skeleton.parents[j])
        back[j] = share * back[bends] + (1.0 - share) * back[near]
    scale = np.array(chain.dof_scale)
    for b, name in enumerate(chain.names):
        dofs = range(chain.dof_start[b], chain.dof_start[b + 1])
        for d in dofs:
            coordinate = rig.coordinates.names[chain.dof_coordinate[d]]
            lifts = name.startswith("clav") and coordinate.startswith("arm")
            later = {chain.dof_coordinate[e] for e in dofs if e > d}
            undone = name.startswith("arm") and chain.dof_coordinate[d] in later
            if lifts or undone:
                scale[d] = 0.0
    still = replace(chain, dof_scale=scale)
    bind = still.frames(rig.coordinates.bind).rotations
    rigid = replace(drive, twist_left_out=np.zeros(len(drive.node)), bind=bind)
    dense = rig.mesh.dense_weights @ back
    joints = np.argsort(-dense, axis=1, kind="stable")[:, :8]
    weights = np.take_along_axis(dense, joints, axis=1)
    mesh = replace(rig.mesh, joints=joints, weights=weights)
    return replace(rig, chain=still, drive=rigid), mesh
