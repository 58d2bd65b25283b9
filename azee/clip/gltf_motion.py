"""Motion from glTF: animations of GLB and VRM files, and VRM Animations.

A recording stands at rest with the world's axes at every joint, so rotations are counted from the
nodes' rest posture. Bones that a VRM extension names get these names.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee.clip.recording import Recording
from azee_rig.importing.accessors import read_array
from azee_rig.importing.container import GltfFile, label, read_gltf
from azee_rig.importing.fault import BodyError
from azee_rig.importing.nodes import Nodes, read_nodes
from azee_rig.importing.vrm import humanoid
from azee_rig.rotation import to_matrices, to_quaternions
from azee_rig.skeleton import Skeleton

Floats = NDArray[np.float64]

FPS = 30.0
"""Frames a second at which a recording is sampled where its keys are further apart."""
MOST_FRAMES = 100_000
PATHS = {"rotation": "VEC4", "translation": "VEC3", "scale": "VEC3"}


class GltfMotionError(ValueError):
    """A glTF file without motion that can be read. The message is for the user."""


def read_gltf_motion(path: Path) -> Recording:
    """Read the first animation of a .glb, .gltf, .vrm or .vrma file.

    Raises: GltfMotionError: there is none, or the file is damaged. OSError.
    """
    try:
        file = read_gltf(path)
        nodes = read_nodes(file)
        animations = file.all("animations")
        if not animations:
            raise GltfMotionError("it has no animation")
        tracks = _tracks(file, animations[0])
        notes = []
        if len(animations) > 1:
            notes.append(f"it has {len(animations)} animations: the first is taken")
        return _recording(file, nodes, tracks, tuple(notes))
    except BodyError as error:
        raise GltfMotionError(error.message) from error
    except (KeyError, TypeError, IndexError, AttributeError) as error:
        raise GltfMotionError("its animation is damaged") from error


def _tracks(
    file: GltfFile, animation: Mapping[str, Any]
) -> dict[tuple[int, str], tuple[Floats, Floats, str]]:
    """Return times, values and interpolation of what moves, by node and path."""
    found = {}
    for channel in animation["channels"]:
        target = channel["target"]
        node, kind = target.get("node"), target.get("path")
        if node is None or kind not in PATHS:
            continue
        file.one("nodes", node)
        sampler = animation["samplers"][channel["sampler"]]
        times = read_array(file, sampler["input"], "SCALAR").astype(np.float64).ravel()
        values = read_array(file, sampler["output"], PATHS[kind]).astype(np.float64)
        how = sampler.get("interpolation", "LINEAR")
        keys = 3 * len(times) if how == "CUBICSPLINE" else len(times)
        if not len(times) or len(values) != keys or (np.diff(times) <= 0.0).any():
            raise GltfMotionError("its animation is damaged: its keys do not fit each other")
        if not (np.isfinite(times).all() and np.isfinite(values).all()):
            raise GltfMotionError("its animation holds numbers that are none")
        found[node, kind] = times, values, how
    if not found:
        raise GltfMotionError("its animation moves no node")
    return found


def _recording(
    file: GltfFile,
    nodes: Nodes,
    tracks: Mapping[tuple[int, str], tuple[Floats, Floats, str]],
    notes: tuple[str, ...],
) -> Recording:
    times = _times([times for times, _, _ in tracks.values()])
    joints = _joints(file, nodes, {node for node, _ in tracks})
    count = len(times)
    world: dict[int, Floats] = {}
    for node in nodes.order:
        local = np.tile(nodes.local[node], (count, 1, 1))
        if any((node, kind) in tracks for kind in PATHS):
            local = _moved(nodes.local[node], node, tracks, times)
        parent = nodes.parents[node]
        world[node] = world[parent] @ local if parent >= 0 else local
    index = {node: j for j, node in enumerate(joints)}
    parents = np.array([index.get(nodes.parents[node], -1) for node in joints])
    places = np.array([nodes.world[node][:3, 3] for node in joints])
    offsets = np.where((parents >= 0)[:, None], places - places[parents], places)
    turned = np.stack([_turn(world[n]) @ _turn(nodes.world[n]).T for n in joints], axis=1)
    now = np.stack([world[node][:, :3, 3] for node in joints], axis=1)
    rotations, translations = np.array(turned), np.array(now)
    below = parents >= 0
    above = np.swapaxes(turned[:, parents[below]], -1, -2)
    rotations[:, below] = above @ turned[:, below]
    translations[:, below] = (above @ (now[:, below] - now[:, parents[below]])[..., None])[..., 0]
    called = {node: bone for bone, node in _humanoid(file).items()}
    names = _unique([called.get(n) or nodes.names[n] or f"joint_{n}" for n in joints])
    return Recording(
        skeleton=Skeleton(names, parents, offsets),
        tips={},
        times=times - times[0],
        rotations=to_quaternions(rotations),
        translations=translations,
        notes=notes,
    )


def _times(keys: list[Floats]) -> Floats:
    """Return even times over all keys, or the keys themselves where they are denser."""
    start, end = min(t[0] for t in keys), max(t[-1] for t in keys)
    longest: Floats = max(keys, key=len)
    if len(longest) > 1 and longest[0] == start and longest[-1] == end:
        step = (end - start) / (len(longest) - 1)
        if step <= 1.5 / FPS:
            return longest
    count = int(np.floor((end - start) * FPS + 1e-6)) + 1
    if count > MOST_FRAMES:
        raise GltfMotionError(f"its animation is {end - start:.0f} s long")
    return np.asarray(start + np.arange(count) / FPS)


def _joints(file: GltfFile, nodes: Nodes, moved: set[int]) -> tuple[int, ...]:
    """Return the nodes of skins and of VRM's bones, those that move, and those between them."""
    held = {n for skin in file.all("skins") for n in skin.get("joints", ()) if isinstance(n, int)}
    held |= set(_humanoid(file).values())
    if not held:
        held = set(moved)
    roots = [n for n in held if not any(a in held for a in nodes.above(n))]
    common = set(nodes.above(roots[0])) | {roots[0]}
    for root in roots[1:]:
        common &= set(nodes.above(root)) | {root}
    if not common:
        raise GltfMotionError("its joints hang on no common root")
    top = max(common, key=lambda n: nodes.depth[n])
    between = {a for n in held for a in (n, *nodes.above(n)) if a == top or top in nodes.above(a)}
    return tuple(n for n in nodes.order if n in between)


def _humanoid(file: GltfFile) -> dict[str, int]:
    """Return nodes by VRM's names of bones, of an avatar or of an animation."""
    extensions = file.document.get("extensions")
    found = extensions.get("VRMC_vrm_animation") if isinstance(extensions, dict) else None
    if not isinstance(found, dict):
        return humanoid(file)
    bones = found["humanoid"]["humanBones"]
    return {label(name): file_node(file, row["node"]) for name, row in bones.items()}


def file_node(file: GltfFile, number: Any) -> int:
    """Return a number of a node that is there. Raises: BodyError."""
    file.one("nodes", number)
    return int(number)


def _moved(
    rest: Floats,
    node: int,
    tracks: Mapping[tuple[int, str], tuple[Floats, Floats, str]],
    times: Floats,
) -> Floats:
    """Return the local transforms (T, 4, 4) of a node."""
    sizes = np.linalg.norm(rest[:3, :3], axis=0)
    turn = np.tile(rest[:3, :3] / sizes, (len(times), 1, 1))
    if (node, "rotation") in tracks:
        q = _sampled(*tracks[node, "rotation"], times, turns=True)
        turn = to_matrices(np.roll(q, 1, axis=-1))
    scale = np.tile(sizes, (len(times), 1))
    if (node, "scale") in tracks:
        scale = _sampled(*tracks[node, "scale"], times, turns=False)
    local = np.tile(rest, (len(times), 1, 1))
    local[:, :3, :3] = turn * scale[:, None]
    if (node, "translation") in tracks:
        local[:, :3, 3] = _sampled(*tracks[node, "translation"], times, turns=False)
    return local


def _sampled(keys: Floats, values: Floats, how: str, times: Floats, *, turns: bool) -> Floats:
    """Return values (T, k) between keys, as glTF 2.0 interpolates; quaternions of length 1."""
    k = np.clip(np.searchsorted(keys, times, side="right") - 1, 0, len(keys) - 1)
    following = np.minimum(k + 1, len(keys) - 1)
    step = keys[following] - keys[k]
    share = np.clip((times - keys[k]) / np.where(step > 0.0, step, 1.0), 0.0, 1.0)[:, None]
    if how == "CUBICSPLINE":
        (incoming, at, outgoing), t = values.reshape(len(keys), 3, -1).swapaxes(0, 1), share
        out = (2 * t**3 - 3 * t**2 + 1) * at[k] + (3 * t**2 - 2 * t**3) * at[following]
        tangents = (t**3 - 2 * t**2 + t) * outgoing[k] + (t**3 - t**2) * incoming[following]
        out = out + step[:, None] * tangents
    elif how == "STEP":
        out = values[k]
    elif turns:
        out = _slerp(values[k], values[following], share)
    else:
        out = (1.0 - share) * values[k] + share * values[following]
    if turns:
        out = out / np.maximum(np.linalg.norm(out, axis=-1, keepdims=True), 1e-12)
    return np.asarray(out)


def _slerp(a: Floats, b: Floats, share: Floats) -> Floats:
    """Spherical linear interpolation of quaternions (T, 4) the shorter way (Shoemake 1985)."""
    cosine = (a * b).sum(axis=-1, keepdims=True)
    b = np.where(cosine < 0.0, -b, b)
    angle = np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))
    sine = np.sin(angle)
    near = sine < 1e-6
    safe = np.where(near, 1.0, sine)
    first = np.where(near, 1.0 - share, np.sin((1.0 - share) * angle) / safe)
    second = np.where(near, share, np.sin(share * angle) / safe)
    return np.asarray(first * a + second * b)


def _turn(transforms: Floats) -> Floats:
    """Rotations (…, 3, 3) of transforms (…, 4, 4) that turn and scale."""
    R = transforms[..., :3, :3]
    return np.asarray(R / np.maximum(np.linalg.norm(R, axis=-2, keepdims=True), 1e-12))


def _unique(names: list[str]) -> tuple[str, ...]:
    taken: set[str] = set()
    for n, name in enumerate(names):
        while name in taken:
            name = f"{name}_{n}"
        taken.add(name)
        names[n] = name
    return tuple(names)
