"""A clip's motion as one glTF animation: joint rotations, the root's path and morph weights."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip, Label
from azee.export.formats.gltf.document import Document
from azee_rig.skeleton import Pose

Floats = NDArray[np.float64]

REST = (0.0, 0.0, 0.0, 1.0)
"""No turn, as glTF writes it."""
STILL = 1e-6
"""Change of a quaternion, a position in metres or a weight that is not visible."""


def add_animation(
    document: Document,
    clip: Clip,
    pose: Pose,
    nodes: Sequence[int],
    root_offset: Floats,
    mesh_node: int,
    targets: Sequence[str],
) -> int:
    """Add the animation of a clip; returns its index.

    Only joints that move have a key per frame. A joint that is turned but never moves has a single
    key, so that the nodes keep the rest pose from which retargeting tools start. A joint that stays
    in the rest pose has none. A clip that stays there has one key, of the root.

    Args: pose: (T, J) postures of the clip's frames. nodes: the joints' nodes, the first the
        root's. root_offset: (3,) rest position of the root. targets: names of the mesh's morph
        targets, all of the clip's units among them.
    """
    times = (clip.times - clip.times[0]).astype(np.float32)
    known: dict[int, int] = {}
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []

    def channel(node: int, path: str, values: Floats, rest: Sequence[float] | Floats) -> None:
        """Add a channel with one row per frame; none if the values never leave `rest`."""
        if np.abs(values - rest).max(initial=0) >= STILL:
            moves = np.abs(values - values[0]).max() >= STILL
            keys(node, path, values if moves else values[:1])

    def keys(node: int, path: str, rows: Floats) -> None:
        inputs = _times(document, times[: len(rows)], known)
        flat = rows.astype(np.float32).reshape((-1,) if path == "weights" else rows.shape)
        samplers.append({"input": inputs, "output": document.accessor(flat)})
        channels.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})

    channel(nodes[0], "translation", root_offset + pose.root_translation, root_offset)
    for joint, node in enumerate(nodes):
        channel(node, "rotation", _xyzw(pose.rotations[:, joint]), REST)
    if targets:
        weights = np.zeros((len(times), len(targets)))
        weights[:, [targets.index(unit) for unit in clip.units]] = clip.unit_weights
        channel(mesh_node, "weights", weights, [0.0])
    if not channels:
        keys(nodes[0], "rotation", np.array([REST]))
    return document.add(
        "animations",
        name=_title(clip.labels),
        samplers=samplers,
        channels=channels,
        extras={"labels": _labels(clip.labels, clip.times[0])},
    )


def add_tracks(document: Document, clip: Clip, rows: Mapping[tuple[int, str], Floats]) -> int:
    """Add an animation of the rows given, (T, …) by node and path; returns its index.

    Rotations are (T, 4) wxyz. What never moves has one key.
    """
    times = (clip.times - clip.times[0]).astype(np.float32)
    known: dict[int, int] = {}
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []
    for (node, path), values in rows.items():
        values = _xyzw(values) if path == "rotation" else values
        kept = values if np.abs(values - values[0]).max() >= STILL else values[:1]
        flat = kept.astype(np.float32).reshape((-1,) if path == "weights" else kept.shape)
        inputs = _times(document, times[: len(kept)], known)
        samplers.append({"input": inputs, "output": document.accessor(flat)})
        channels.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})
    return document.add(
        "animations",
        name=_title(clip.labels),
        samplers=samplers,
        channels=channels,
        extras={"labels": _labels(clip.labels, clip.times[0])},
    )


def _times(document: Document, times: NDArray[np.float32], known: dict[int, int]) -> int:
    """Return the accessor of key times, one for all channels with as many keys."""
    if len(times) not in known:
        known[len(times)] = document.accessor(times, bounds=True)
    return known[len(times)]


def _xyzw(rotations: Floats) -> Floats:
    """Return quaternions in glTF's order; of q and −q the one nearer to the frame before."""
    dots = (rotations[1:] * rotations[:-1]).sum(axis=-1)
    first = -1.0 if rotations[0, 0] < 0 else 1.0
    signs = np.cumprod(np.concatenate([[first], np.where(dots < 0, -1.0, 1.0)]))
    return np.roll(rotations * signs[:, None], -1, axis=-1)


def _title(labels: Sequence[Label]) -> str:
    """Return the name of the animation: the labels of the outermost level."""
    return " ".join(label.text for label in labels if label.depth == 0) or "azee"


def _labels(labels: Sequence[Label], start_s: float) -> list[dict[str, Any]]:
    """Labels as extras, on the animation's time line."""
    return [
        {
            "text": label.text,
            "path": list(label.path),
            "start_s": round(label.start_s - start_s, 6),
            "end_s": round(label.end_s - start_s, 6),
        }
        for label in labels
    ]
