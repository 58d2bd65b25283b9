"""A clip's motion as one glTF animation: joint rotations, the root's path and morph weights."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee.export.gltf.document import Document
from azee.motion.clip import Clip, Label
from azee_rig.skeleton import Pose

STILL = 1e-6
"""Change of a quaternion, a position in metres or a weight that nobody can see."""


def add_animation(
    document: Document,
    clip: Clip,
    pose: Pose,
    nodes: Sequence[int],
    root_offset: NDArray[np.float64],
    mesh_node: int,
    targets: Sequence[str],
) -> int:
    """Add the animation of a clip; returns its index.

    Only what moves has a key per frame. A joint that is turned but never moves has a single key,
    so that the nodes themselves keep the rest posture that retargeting tools start from; one
    that stays at rest has none.

    Args: pose: (T, J) postures of the clip's frames. nodes: the joints' nodes, the first the
        root's. root_offset: (3,) rest position of the root. targets: names of the mesh's morph
        targets, all of the clip's units among them.
    """
    times = (clip.times - clip.times[0]).astype(np.float32)
    every = document.accessor(times, bounds=True)
    once: list[int] = []
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []

    def channel(node: int, path: str, values: NDArray[np.floating[Any]], rest: Any) -> None:
        """Values one row a frame; left out where they never leave `rest`."""
        if np.abs(values - rest).max(initial=0) < STILL:
            return
        moves = np.abs(values - values[0]).max() >= STILL
        if not moves and not once:
            once.append(document.accessor(times[:1], bounds=True))
        rows = values if moves else values[:1]
        samplers.append(
            {
                "input": every if moves else once[0],
                "output": document.accessor(rows.astype(np.float32).reshape(_shape(path, rows))),
            }
        )
        target = {"node": node, "path": path}
        channels.append({"sampler": len(samplers) - 1, "target": target})

    channel(nodes[0], "translation", root_offset + pose.root_translation, root_offset)
    for joint, node in enumerate(nodes):
        rotations = _continuous(pose.rotations[:, joint])
        channel(node, "rotation", np.roll(rotations, -1, axis=-1), (0, 0, 0, 1))
    if targets:
        weights = np.zeros((len(times), len(targets)))
        weights[:, [targets.index(unit) for unit in clip.units]] = clip.unit_weights
        channel(mesh_node, "weights", weights, 0)
    return document.add(
        "animations",
        name=_title(clip.labels),
        samplers=samplers,
        channels=channels,
        extras={"labels": _labels(clip.labels, clip.times[0])},
    )


def _shape(path: str, rows: NDArray[np.floating[Any]]) -> tuple[int, ...]:
    return (-1,) if path == "weights" else rows.shape


def _continuous(rotations: NDArray[np.float64]) -> NDArray[np.float64]:
    """Choose of q and −q, frame by frame, the one on the side of the frame before; w ≥ 0 first."""
    dots = (rotations[1:] * rotations[:-1]).sum(axis=-1)
    first = -1.0 if rotations[0, 0] < 0 else 1.0
    signs = np.cumprod(np.concatenate([[first], np.where(dots < 0, -1.0, 1.0)]))
    return rotations * signs[:, None]


def _title(labels: Sequence[Label]) -> str:
    """Name of the animation: what is signed at the outermost level."""
    return " ".join(label.text for label in labels if label.depth == 0) or "azee"


def _labels(labels: Sequence[Label], start_s: float) -> list[dict[str, Any]]:
    """Every label with its path: the texts of the labels it stands in, its own last."""
    stack: list[str] = []
    rows = []
    for label in labels:
        stack[label.depth :] = [label.text]
        rows.append(
            {
                "text": label.text,
                "path": list(stack),
                "start_s": round(label.start_s - start_s, 6),
                "end_s": round(label.end_s - start_s, 6),
            }
        )
    return rows
