"""A clip and its body as one GLB file (glTF 2.0): skinned mesh, morph targets, one animation."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from azee.clip.clip import Clip
from azee.export.files import replace_file
from azee.export.formats.gltf.animation import add_animation
from azee.export.formats.gltf.document import Document
from azee.export.formats.gltf.mesh import add_mesh
from azee.export.formats.gltf.skin import add_joints, add_skin
from azee.export.formats.moving_body import MovingBody, postures
from azee.score.provenance import Provenance
from azee_rig.skeleton import Pose


def write_glb(
    clip: Clip, rig: MovingBody, path: str | Path, provenance: Provenance | None = None
) -> None:
    """Write a GLB that any glTF viewer plays.

    Joints keep the rig's names and bind pose; morph targets are the rig's face units, by name; the
    animation's extras hold the clip's labels. glTF's frame is ours: metres, Y up, the signer looks
    along +Z. The asset's extras hold the provenance of the text, if it is given.

    Raises: OSError: the file cannot be written.
    """
    document, nodes, body = _bound_body(rig)
    if provenance is not None:
        document.asset["extras"] = {"provenance": provenance.as_json()}
    add_animation(
        document,
        clip,
        _pose(clip, rig),
        nodes,
        rig.skeleton.offsets[0],
        body,
        rig.mesh.units,
    )
    _write(document, rig, nodes, body, path)


def write_body(rig: MovingBody, path: str | Path) -> None:
    """Write a GLB of a body alone, in its bind pose and without an animation.

    Raises: OSError: the file cannot be written.
    """
    document, nodes, body = _bound_body(rig)
    _write(document, rig, nodes, body, path)


def _bound_body(rig: MovingBody) -> tuple[Document, tuple[int, ...], int]:
    """Return a document with joints, mesh and skin; the joints' nodes and the mesh's node."""
    document = Document(generator="azee")
    nodes = add_joints(document, rig.skeleton)
    mesh = add_mesh(document, rig.mesh, rig.name)
    skin = add_skin(document, rig.skeleton, nodes)
    return document, nodes, document.add("nodes", name=f"{rig.name}_mesh", mesh=mesh, skin=skin)


def _write(
    document: Document, rig: MovingBody, nodes: tuple[int, ...], body: int, path: str | Path
) -> None:
    parents = rig.skeleton.parents
    roots = [node for node, parent in zip(nodes, parents, strict=True) if parent < 0]
    scene = document.add("scenes", name=rig.name, nodes=[*roots, body])
    with replace_file(path) as file:
        file.writelines(document.glb_parts(scene=scene))


def _pose(clip: Clip, rig: MovingBody) -> Pose:
    """Return all postures of a clip, (T, J)."""
    count, joints = len(clip.times), len(rig.skeleton.names)
    whole = Pose(np.empty((count, 3)), np.empty((count, joints, 4)))
    for frames, pose in postures(clip, rig):
        whole.root_translation[frames] = pose.root_translation
        whole.rotations[frames] = pose.rotations
    return whole
