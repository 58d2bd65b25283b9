"""A clip as a VRM Animation (VRMC_vrm_animation 1.0), which every VRM avatar can play."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.export.files import replace_file
from azee.export.formats.gltf.animation import add_tracks
from azee.export.formats.gltf.document import Document
from azee.export.formats.vrm.expressions import expression
from azee.export.formats.vrm.humanoid import bones_of
from azee.export.formats.vrm.turns import human_motion
from azee_rig.rig import Rig

Floats = NDArray[np.float64]

EXTENSION = "VRMC_vrm_animation"
SPEC_VERSION = "1.0"


def write_vrma(clip: Clip, rig: Rig, path: str | Path) -> None:
    """Write a clip as a VRM Animation.

    Its skeleton stands in VRM's T-pose with the body's own lengths; its hips stay where they are.
    Weights of expressions are between 0 and 1, as VRM has them. Eyes turn by `lookAt`.

    Raises: OSError: the file cannot be written.
    """
    motion = human_motion(clip, rig)
    document = Document(generator="azee")
    bones = bones_of(rig)
    node = {name: n for n, name in enumerate(bones)}
    for name in bones:
        below = [node[other] for other, bone in bones.items() if bone.parent == name]
        document.add(
            "nodes",
            name=name,
            translation=np.float32(motion.offsets[name]).tolist(),
            children=below or None,
        )
    look = document.add("nodes", name="lookAt")
    rows: dict[tuple[int, str], Floats] = {
        (node[name], "rotation"): turns for name, turns in motion.rotations.items()
    }
    rows[look, "rotation"] = motion.gaze
    expressions: dict[str, dict[str, Any]] = {}
    weights: dict[tuple[str, str], Floats] = {}
    for u, unit in enumerate(clip.units):
        key = expression(unit)
        weights[key] = weights.get(key, 0.0) + clip.unit_weights[:, u]
    for (kind, name), weight in weights.items():
        shown = document.add("nodes", name=f"expression {name}")
        expressions.setdefault(kind, {})[name] = {"node": shown}
        moved = np.zeros((len(clip.times), 3))
        moved[:, 0] = np.clip(weight, 0.0, 1.0)
        rows[shown, "translation"] = moved
    add_tracks(document, clip, rows)
    roots = [
        node["hips"],
        look,
        *(e["node"] for group in expressions.values() for e in group.values()),
    ]
    scene = document.add("scenes", nodes=roots)
    extension = {
        "specVersion": SPEC_VERSION,
        "humanoid": {"humanBones": {name: {"node": n} for name, n in node.items()}},
        "expressions": expressions or None,
        "lookAt": {"node": look, "offsetFromHeadBone": np.round(motion.eyes, 6).tolist()},
    }
    with replace_file(path) as file:
        file.writelines(
            document.glb_parts(
                scene=scene,
                extensionsUsed=[EXTENSION],
                extensions={EXTENSION: {k: v for k, v in extension.items() if v is not None}},
            )
        )
