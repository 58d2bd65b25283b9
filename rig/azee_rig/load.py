"""Loads a rig that ships, or one from a folder."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from azee_rig.chain import Chain
from azee_rig.coordinates import Coordinates
from azee_rig.drive import Drive
from azee_rig.rig import BoneNodes, Capsules, Landmarks, Rig, RigSite
from azee_rig.skeleton import Skeleton, frozen

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
    folder = _SHIPPED / name_or_path
    if str(name_or_path) not in shipped_rigs():
        folder = Path(name_or_path)
        if not (folder / "rig.json").is_file():
            known = ", ".join(shipped_rigs())
            raise RigError(
                f"there is no rig `{name_or_path}`: neither one that ships ({known}) "
                "nor a folder with a rig.json"
            )
    path = folder / "rig.json"
    try:
        return _read(json.loads(path.read_text(encoding="utf-8")), folder)
    except (OSError, ValueError, KeyError, TypeError, IndexError) as error:
        raise RigError(f"cannot read the rig in {path}: {error}") from error


def _read(content: dict[str, Any], folder: Path) -> Rig:
    rows = content["coordinates"]
    coordinates = Coordinates(
        tuple(row["name"] for row in rows),
        *([row[key] for row in rows] for key in ("lower", "upper", "idle", "bind", "stiffness")),
    )
    chain = _read_chain(content["nodes"], coordinates)
    drive = content["drive"]
    capsules = content["capsules"]
    landmarks = content["landmarks"]
    skeleton = content["skeleton"]
    return Rig(
        name=content["name"],
        skeleton=Skeleton(tuple(skeleton["names"]), skeleton["parents"], skeleton["offsets_m"]),
        coordinates=coordinates,
        chain=chain,
        drive=Drive(
            *([row[key] for row in drive] for key in ("node", "twist", "left_out", "half_of")),
            bind=chain.frames(coordinates.bind).rotations,
        ),
        bones={bone: BoneNodes(*nodes) for bone, nodes in content["bones"].items()},
        sites={
            row["name"]: RigSite(
                row["name"],
                row["bone"],
                row["node"],
                frozen(row["position_m"], np.float64),
                frozen(row["normal"], np.float64),
            )
            for row in content["sites"]
        },
        capsules=Capsules(
            tuple(row["name"] for row in capsules),
            *([row[key] for row in capsules] for key in ("node", "a_m", "b_m", "radius_m")),
            pairs=content["pairs"],
            finger_pairs=content["finger_pairs"],
        ),
        landmarks=Landmarks(
            frozen(landmarks["shoulder_middle_m"], np.float64),
            *(landmarks[k] for k in ("upper_arm_m", "forearm_m", "arm_m", "reference_arm_m")),
        ),
        signing_space={
            name: frozen(point, np.float64) for name, point in content["signing_space_m"].items()
        },
        skeletal_morphs=content["skeletal_morphs"],
        face_morphs=content["face_morphs"],
        unexpressed_morphs=content["unexpressed_morphs"],
        units=tuple(content["units"]),
        lids={unit: (name, weight) for unit, (name, weight) in content["lids"].items()},
        folder=folder,
    )


def _read_chain(nodes: list[dict[str, Any]], coordinates: Coordinates) -> Chain:
    turns = [turn for node in nodes for turn in node["turns"]]
    starts = np.cumsum([0, *(len(node["turns"]) for node in nodes)])
    if not math.isfinite(sum(scale for _, scale, _ in turns)):
        raise ValueError("a turn has no finite share")
    return Chain(
        names=tuple(node["name"] for node in nodes),
        parents=[node["parent"] for node in nodes],
        offsets=[node["offset_m"] for node in nodes],
        zero=[node["zero"] for node in nodes],
        dof_start=starts,
        dof_axis=[axis for axis, _, _ in turns],
        dof_scale=[scale for _, scale, _ in turns],
        dof_coordinate=[coordinates.index[name] for _, _, name in turns],
    )
