"""A rig: a body that can be posed by coordinates and dressed in skin."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeAlias
from weakref import WeakKeyDictionary, WeakValueDictionary

import numpy as np
from numpy.typing import NDArray

from azee_rig.chain import Chain, Frames
from azee_rig.coordinates import Coordinates
from azee_rig.drive import Drive
from azee_rig.mesh import BodyMesh, read_mesh
from azee_rig.skeleton import Pose, Skeleton, frozen
from azee_rig.skin import joint_frames, skin

Floats = NDArray[np.float64]
Stamp: TypeAlias = tuple[tuple[str, int, int], ...]
"""State of a folder: name, modification time in nanoseconds and size of each file, sorted."""

SHIPPED = Path(__file__).absolute().parent / "data"
"""The folders of the bodies that ship."""
MESH = "mesh.npz"


@dataclass(frozen=True, slots=True)
class BoneNodes:
    """Where an AZee bone lives in the chain.

    node: its frame carries the bone's dir and nrm. origin_node: its origin is the proximal joint.
    They differ where one bone is spread over several nodes (back_1, back_2, neck).
    """

    node: int
    origin_node: int


@dataclass(frozen=True, eq=False, slots=True)
class SiteShare:
    """What a further node adds to a site: a vector and a normal (3,) that turn with the node."""

    node: int
    vector: Floats
    normal: Floats


@dataclass(frozen=True, eq=False, slots=True)
class RigSite:
    """A named point of the skin, which rides on its node and, near joints, on others with it.

    With R_k the nodes' rotations and p the origin of the site's own node, the point is
    p + R · position + Σ_k R_k · vector_k and the outward normal the unit vector along
    R · normal + Σ_k R_k · normal_k: smooth in all coordinates, and as near to the blended skin
    as the shares were fitted. A site without shares is fixed in its node's frame.

    node: the one that carries it; −1 is the world, on whose legs nothing moves. position, normal:
    (3,) in its frame, metres.
    """

    name: str
    bone: str
    node: int
    position: Floats
    normal: Floats
    shares: tuple[SiteShare, ...] = ()

    @property
    def nodes(self) -> tuple[int, ...]:
        """All nodes that move it, its own first; none where it stands still."""
        own = (self.node,) if self.node >= 0 else ()
        return (*own, *(share.node for share in self.shares))

    def point(self, frames: Frames) -> Floats:
        """Where it is in some postures, (…, 3) metres in the world."""
        point = self._turned(frames, self.node, self.position)
        if self.node >= 0:
            point = point + frames.positions[..., self.node, :]
        for share in self.shares:
            point = point + self._turned(frames, share.node, share.vector)
        return np.asarray(point)

    def outward(self, frames: Frames) -> Floats:
        """Outward unit normal of the skin there, (…, 3) in the world."""
        normal = self._turned(frames, self.node, self.normal)
        if not self.shares:
            return normal
        for share in self.shares:
            normal = normal + self._turned(frames, share.node, share.normal)
        return np.asarray(normal / np.linalg.norm(normal, axis=-1, keepdims=True))

    @staticmethod
    def _turned(frames: Frames, node: int, vector: Floats) -> Floats:
        if node < 0:
            return np.broadcast_to(vector, (*frames.positions.shape[:-2], 3))
        return np.asarray(frames.rotations[..., node, :, :] @ vector)


@dataclass(frozen=True, eq=False)
class Capsules:
    """The body as K capsules, for collision.

    node: (K,). a, b: (K, 3) ends of the axis in the node's frame. radius: (K,). All in metres.
    pairs: (P, 2) capsules that must not overlap: arms and hands against trunk, head and each
    other. finger_pairs: (Q, 2) the same with the fingers, a group of its own.
    """

    names: tuple[str, ...]
    node: NDArray[np.int64]
    a: Floats
    b: Floats
    radius: Floats
    pairs: NDArray[np.int64]
    finger_pairs: NDArray[np.int64]

    def __post_init__(self) -> None:
        for name in ("node", "pairs", "finger_pairs"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.int64))
        for name in ("a", "b", "radius"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.float64))


@dataclass(frozen=True, eq=False, slots=True)
class Landmarks:
    """Measures of the body, metres.

    shoulder_middle: (3,) middle of the shoulder line in the world, at idle. arm_m: upper arm and
    forearm, shoulder to wrist. reference_arm_m: the same of the reference signer, whose metres
    AZee's free points and vectors count; arm_m / reference_arm_m scales them to this body.
    """

    shoulder_middle: Floats
    upper_arm_m: float
    forearm_m: float
    arm_m: float
    reference_arm_m: float


@dataclass(frozen=True, eq=False)
class Rig:
    """A body, with the maps from AZee's names to it.

    It is immutable and can be shared; a copy is the rig itself. A pickle leaves out the mesh,
    which is read from `folder` again.

    bones: all 44 AZee bones. sites: AZee's body sites. signing_space: world points (3,) Mssp,
    Rssp, Lssp and addressee. skeletal_morphs: radians that a morph of weight 1 adds to each
    coordinate. face_morphs: weights that a morph of weight 1 adds to each face unit.
    unexpressed_morphs: AZee morphs that this face cannot show, with the reason.
    units: names of the face units. lids: per unit a coordinate of an eye and the weight per
    radian, in effect where it is positive. folder: where the mesh lies, to be read when first
    asked for.
    """

    name: str
    skeleton: Skeleton
    coordinates: Coordinates
    chain: Chain
    drive: Drive
    bones: Mapping[str, BoneNodes]
    sites: Mapping[str, RigSite]
    capsules: Capsules
    landmarks: Landmarks
    signing_space: Mapping[str, Floats]
    skeletal_morphs: Mapping[str, Mapping[str, float]]
    face_morphs: Mapping[str, Mapping[str, float]]
    unexpressed_morphs: Mapping[str, str]
    units: tuple[str, ...]
    lids: Mapping[str, tuple[str, float]]
    folder: Path

    def __post_init__(self) -> None:
        for f in fields(self):
            object.__setattr__(self, f.name, _fixed(getattr(self, f.name)))

    def __copy__(self) -> Rig:
        return self

    def __deepcopy__(self, _: dict[int, Any]) -> Rig:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        state = {f.name: _plain(getattr(self, f.name)) for f in fields(self)}
        folder = state["folder"]
        if isinstance(folder, Path) and folder.parent == SHIPPED:
            state["folder"] = folder.name  # the reader may be installed elsewhere
        return _restored, (state, _STAMPS.get(self))

    @cached_property
    def mesh(self) -> BodyMesh:
        """The body's surface."""
        return read_mesh(self.folder / MESH)

    def pose(self, q: Floats) -> Pose:
        """Local rotations of the body's joints for coordinates q (…, V), radians.

        Twist is shared along upper arm and forearm; helper joints follow their neighbours.
        """
        return self.drive.pose(q, self.coordinates.bind, self.chain, self.skeleton)

    def lid_weights(self, q: Floats) -> dict[str, Floats]:
        """Weights (…) of the face units with which lids follow the eyes of q (…, V).

        They are added to those of the expression; `skin` leaves that to its caller.
        """
        q = np.asarray(q, dtype=np.float64)
        return {
            unit: np.maximum(per_rad * q[..., self.coordinates.index[coordinate]], 0.0)
            for unit, (coordinate, per_rad) in self.lids.items()
        }

    def joint_positions(self, pose: Pose) -> Floats:
        """World positions (…, J, 3) of the body's joints, metres."""
        return joint_frames(self.skeleton, pose)[0]

    def skin(self, pose: Pose, unit_weights: Mapping[str, float] | Floats | None = None) -> Floats:
        """World positions (N, 3) of the mesh's vertices in one posture, metres.

        Args: unit_weights: weight per face unit, by name or as (len(units),) in order.
        """
        if isinstance(unit_weights, Mapping):
            weights = np.zeros(len(self.units))
            for unit, weight in unit_weights.items():
                weights[self.units.index(unit)] = weight
            unit_weights = weights
        return skin(self.mesh, self.skeleton, pose, unit_weights)


_SHARED: WeakValueDictionary[tuple[Path, Stamp], Rig] = WeakValueDictionary()
_STAMPS: WeakKeyDictionary[Rig, Stamp] = WeakKeyDictionary()
"""Rigs in use that were loaded, here or before they were pickled, and the state of their folder."""


def shared(rig: Rig, stamp: Stamp) -> Rig:
    """Return the rig in use that was read from the same state of the same folder, else this one."""
    one = _SHARED.setdefault((rig.folder, stamp), rig)
    _STAMPS[one] = stamp
    return one


def _restored(state: dict[str, Any], stamp: Stamp | None) -> Rig:
    """Return the rig that was pickled."""
    folder = state["folder"]
    rig = Rig(**state | {"folder": SHIPPED / folder if isinstance(folder, str) else folder})
    _make_read_only(rig)  # numpy's pickles forget that arrays were
    return rig if stamp is None else shared(rig, stamp)


def _fixed(value: Any) -> Any:
    """Return a mapping, and mappings in it, as read-only views of copies."""
    if not isinstance(value, Mapping):
        return value
    return MappingProxyType({key: _fixed(inner) for key, inner in value.items()})


def _plain(value: Any) -> Any:
    """Return a mapping, and mappings in it, as dictionaries, which can be pickled."""
    if not isinstance(value, Mapping):
        return value
    return {key: _plain(inner) for key, inner in value.items()}


def _make_read_only(value: Any) -> None:
    if isinstance(value, np.ndarray):
        value.setflags(write=False)
    elif is_dataclass(value):
        for f in fields(value):
            _make_read_only(getattr(value, f.name))
    elif isinstance(value, Mapping | tuple):
        for inner in value.values() if isinstance(value, Mapping) else value:
            _make_read_only(inner)
