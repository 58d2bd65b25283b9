"""Loads a rig that ships, or one from a folder."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee_rig.chain import Chain
from azee_rig.coordinates import Coordinates
from azee_rig.drive import Drive
from azee_rig.rig import BoneNodes, Capsules, Landmarks, Rig, RigSite, SiteShare
from azee_rig.skeleton import Skeleton

_SHIPPED = Path(__file__).parent / "data"


class RigError(Exception):
    """A rig that is not there or cannot be read. The message is for the user."""


def shipped_rigs() -> tuple[str, ...]:
    """Names of the rigs that ship."""
    return tuple(sorted(p.parent.name for p in _SHIPPED.glob("*/rig.json")))


def load_rig(name_or_path: str | Path = "signer") -> Rig:
    """Load a rig by the name of one that ships, or by its folder.

    Raises: RigError: no such rig, or its files cannot be read.
    """
    ships = str(name_or_path) in shipped_rigs()
    folder = _SHIPPED / name_or_path if ships else Path(name_or_path)
    path = folder / "rig.json"
    if not path.is_file():
        known = ", ".join(shipped_rigs())
        raise RigError(
            f"there is no rig `{name_or_path}`: neither one that ships ({known}) "
            "nor a folder with a rig.json"
        )
    try:
        return _read(json.loads(path.read_text(encoding="utf-8")), folder)
    except KeyError as error:
        raise RigError(f"cannot read the rig in {path}: {error} is missing") from error
    except (OSError, ValueError, TypeError, IndexError, AttributeError) as error:
        raise RigError(f"cannot read the rig in {path}: {error}") from error


def _read(content: Mapping[str, Any], folder: Path) -> Rig:
    coordinates = _read_coordinates(content["coordinates"])
    chain = _read_chain(content["nodes"], coordinates)
    skeleton = content["skeleton"]
    landmarks = content["landmarks"]
    return Rig(
        name=content["name"],
        skeleton=Skeleton(
            tuple(skeleton["names"]),
            np.array(skeleton["parents"], dtype=np.int64),
            np.array(skeleton["offsets_m"], dtype=np.float64),
        ),
        coordinates=coordinates,
        chain=chain,
        drive=_read_drive(content["drive"], chain, coordinates),
        bones={bone: BoneNodes(*nodes) for bone, nodes in content["bones"].items()},
        sites={row["name"]: _read_site(row) for row in content["sites"]},
        capsules=_read_capsules(content),
        landmarks=Landmarks(
            _point(landmarks["shoulder_middle_m"]),
            *(landmarks[k] for k in ("upper_arm_m", "forearm_m", "arm_m", "reference_arm_m")),
        ),
        signing_space={name: _point(place) for name, place in content["signing_space_m"].items()},
        skeletal_morphs=content["skeletal_morphs"],
        face_morphs=content["face_morphs"],
        unexpressed_morphs=content["unexpressed_morphs"],
        units=tuple(content["units"]),
        lids={unit: (name, weight) for unit, (name, weight) in content["lids"].items()},
        folder=folder,
    )


def _read_coordinates(rows: Sequence[Mapping[str, Any]]) -> Coordinates:
    return Coordinates(
        names=tuple(row["name"] for row in rows),
        lower=_floats(rows, "lower"),
        upper=_floats(rows, "upper"),
        idle=_floats(rows, "idle"),
        bind=_floats(rows, "bind"),
        stiffness=_floats(rows, "stiffness"),
    )


def _read_chain(nodes: Sequence[Mapping[str, Any]], coordinates: Coordinates) -> Chain:
    turns = [turn for node in nodes for turn in node["turns"]]
    return Chain(
        names=tuple(node["name"] for node in nodes),
        parents=_ints(nodes, "parent"),
        offsets=_floats(nodes, "offset_m"),
        zero=_floats(nodes, "zero"),
        dof_start=np.cumsum([0, *(len(node["turns"]) for node in nodes)]),
        dof_axis=np.array([axis for axis, _, _ in turns]),
        dof_scale=np.array([scale for _, scale, _ in turns]),
        dof_coordinate=np.array([coordinates.index[name] for _, _, name in turns]),
    )


def _read_drive(rows: Sequence[Mapping[str, Any]], chain: Chain, coordinates: Coordinates) -> Drive:
    return Drive(
        node=_ints(rows, "node"),
        twist_coordinate=_ints(rows, "twist"),
        twist_left_out=_floats(rows, "left_out"),
        helper_of=_ints(rows, "helper_of"),
        helper_share=_floats(rows, "share"),
        bind=chain.frames(coordinates.bind).rotations,
    )


def _read_capsules(content: Mapping[str, Any]) -> Capsules:
    rows = content["capsules"]
    return Capsules(
        names=tuple(row["name"] for row in rows),
        node=_ints(rows, "node"),
        a=_floats(rows, "a_m"),
        b=_floats(rows, "b_m"),
        radius=_floats(rows, "radius_m"),
        pairs=np.array(content["pairs"], dtype=np.int64).reshape(-1, 2),
        finger_pairs=np.array(content["finger_pairs"], dtype=np.int64).reshape(-1, 2),
    )


def _read_site(row: Mapping[str, Any]) -> RigSite:
    return RigSite(
        row["name"],
        row["bone"],
        row["node"],
        _point(row["position_m"]),
        _point(row["normal"]),
        tuple(
            SiteShare(share["node"], _point(share["vector_m"]), _point(share["normal"]))
            for share in row["shares"]
        ),
    )


def _point(xyz: Sequence[float]) -> NDArray[np.float64]:
    point = np.array(xyz, dtype=np.float64)
    point.setflags(write=False)
    return point


def _floats(rows: Sequence[Mapping[str, Any]], key: str) -> NDArray[np.float64]:
    return np.array([row[key] for row in rows], dtype=np.float64)


def _ints(rows: Sequence[Mapping[str, Any]], key: str) -> NDArray[np.int64]:
    return np.array([row[key] for row in rows], dtype=np.int64)
