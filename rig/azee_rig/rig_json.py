"""Reads a rig's description, rig.json: what every value must be is said here, once.

What the values say of each other is held together by `azee_rig.soundness`.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee_rig.chain import Chain
from azee_rig.coordinates import Coordinates
from azee_rig.drive import Drive
from azee_rig.fields import mapping, names, number, numbers, rows, text, whole, wholes
from azee_rig.rig import BoneNodes, Capsules, Landmarks, Rig, RigSite, SiteShare
from azee_rig.skeleton import Skeleton

MESH_DIGEST = "mesh_sha256"
"""Key of the SHA-256 of the mesh that a description was made with, in hexadecimal digits."""
_TABLE = Path(__file__).parent / "data" / "coordinates.csv"
_PLACES = ("Mssp", "Rssp", "Lssp", "addressee")


def read_description(content: object, folder: Path) -> Rig:
    """Return the rig that a description tells of, without its mesh.

    Raises: KeyError: something is missing. ValueError: something is not what it must be.
    """
    content = mapping(content, "rig.json")
    skeleton = mapping(content["skeleton"], "skeleton")
    coordinates = _coordinates(content)
    chain = _chain(content, coordinates)
    joints = names(skeleton["names"], "skeleton.names")
    signing_space = mapping(content["signing_space_m"], "signing_space_m")
    return Rig(
        name=text(content["name"], "name"),
        skeleton=Skeleton(
            joints,
            wholes(skeleton["parents"], (len(joints),), "skeleton.parents"),
            numbers(skeleton["offsets_m"], (len(joints), 3), "skeleton.offsets_m"),
        ),
        coordinates=coordinates,
        chain=chain,
        drive=_drive(content, chain, coordinates),
        bones={
            bone: BoneNodes(*wholes(nodes, (2,), f"bones.{bone}").tolist())
            for bone, nodes in mapping(content["bones"], "bones").items()
        },
        sites=_sites(content),
        capsules=_capsules(content),
        landmarks=_landmarks(content),
        signing_space={name: _point(signing_space[name], "signing_space_m") for name in _PLACES}
        | {name: _point(place, "signing_space_m") for name, place in signing_space.items()},
        skeletal_morphs=_weights(content, "skeletal_morphs"),
        face_morphs=_weights(content, "face_morphs"),
        unexpressed_morphs={
            morph: text(reason, "unexpressed_morphs")
            for morph, reason in mapping(
                content["unexpressed_morphs"], "unexpressed_morphs"
            ).items()
        },
        units=names(content["units"], "units"),
        lids=_lids(content),
        folder=folder,
    )


def _coordinates(content: Mapping[str, Any]) -> Coordinates:
    found = rows(content["coordinates"], "coordinates")
    named = names([row["name"] for row in found], "coordinates")
    lacking = [name for name in _known_coordinates() if name not in named]
    if lacking:
        raise ValueError(f"`coordinates` has no `{lacking[0]}`")
    return Coordinates(
        named,
        *(
            _column(found, key, (), "coordinates")
            for key in ("lower", "upper", "idle", "bind", "stiffness")
        ),
    )


def _known_coordinates() -> list[str]:
    """Names of all coordinates that a body has: the table's, with {S} for both sides."""
    with _TABLE.open(encoding="utf-8", newline="") as file:
        listed = [row["coordinate"] for row in csv.DictReader(file)]
    return [name.format(S=side) for name in listed for side in ("LR" if "{S}" in name else "L")]


def _chain(content: Mapping[str, Any], coordinates: Coordinates) -> Chain:
    nodes = rows(content["nodes"], "nodes")
    turns = [turn for node in nodes for turn in _turns(node)]
    return Chain(
        names=names([node["name"] for node in nodes], "nodes"),
        parents=_ints(nodes, "parent", "nodes"),
        offsets=_column(nodes, "offset_m", (3,), "nodes"),
        zero=_column(nodes, "zero", (3, 3), "nodes"),
        dof_start=np.cumsum([0, *(len(node["turns"]) for node in nodes)]),
        dof_axis=wholes([axis for axis, _, _ in turns], (len(turns),), "nodes.turns"),
        dof_scale=numbers([scale for _, scale, _ in turns], (len(turns),), "nodes.turns"),
        dof_coordinate=np.array(
            [_index_of(coordinates, name, "nodes.turns") for _, _, name in turns]
        ),
    )


def _turns(node: Mapping[str, Any]) -> list[Any]:
    turns = node["turns"]
    if isinstance(turns, list) and all(isinstance(t, list) and len(t) == 3 for t in turns):
        return turns
    raise ValueError("`nodes.turns` is not a list of axis, scale and coordinate")


def _index_of(coordinates: Coordinates, name: object, place: str) -> int:
    name = text(name, place)
    if name not in coordinates.index:
        raise ValueError(f"`{place}` names a coordinate `{name}`, which is not there")
    return coordinates.index[name]


def _drive(content: Mapping[str, Any], chain: Chain, coordinates: Coordinates) -> Drive:
    found = rows(content["drive"], "drive")
    return Drive(
        node=_ints(found, "node", "drive"),
        twist_coordinate=_ints(found, "twist", "drive"),
        twist_left_out=_column(found, "left_out", (), "drive"),
        helper_of=_ints(found, "helper_of", "drive"),
        helper_share=_column(found, "share", (), "drive"),
        bind=_bind(chain, coordinates),
    )


def _bind(chain: Chain, coordinates: Coordinates) -> NDArray[np.float64]:
    """Frames of the nodes in the mesh's own posture, of a chain that is whole."""
    from azee_rig.soundness import check_chain

    check_chain(chain, len(coordinates))
    return chain.frames(coordinates.bind).rotations


def _capsules(content: Mapping[str, Any]) -> Capsules:
    found = rows(content["capsules"], "capsules")
    return Capsules(
        names=names([row["name"] for row in found], "capsules"),
        node=_ints(found, "node", "capsules"),
        a=_column(found, "a_m", (3,), "capsules"),
        b=_column(found, "b_m", (3,), "capsules"),
        radius=_column(found, "radius_m", (), "capsules"),
        pairs=wholes(content["pairs"], (None, 2), "pairs"),
        finger_pairs=wholes(content["finger_pairs"], (None, 2), "finger_pairs"),
    )


def _landmarks(content: Mapping[str, Any]) -> Landmarks:
    found = mapping(content["landmarks"], "landmarks")
    lengths = [
        number(found[key], f"landmarks.{key}")
        for key in ("upper_arm_m", "forearm_m", "arm_m", "reference_arm_m")
    ]
    if min(lengths) <= 0.0:
        raise ValueError("`landmarks` has an arm of no length")
    return Landmarks(_point(found["shoulder_middle_m"], "landmarks.shoulder_middle_m"), *lengths)


def _sites(content: Mapping[str, Any]) -> dict[str, RigSite]:
    found = rows(content["sites"], "sites")
    named = names([row["name"] for row in found], "sites")
    return {name: _site(name, row) for name, row in zip(named, found, strict=True)}


def _site(name: str, row: Mapping[str, Any]) -> RigSite:
    place = f"sites.{name}"
    return RigSite(
        name,
        text(row["bone"], place),
        whole(row["node"], place),
        _point(row["position_m"], place),
        _point(row["normal"], place),
        tuple(
            SiteShare(
                whole(share["node"], place),
                _point(share["vector_m"], place),
                _point(share["normal"], place),
            )
            for share in rows(row["shares"], place)
        ),
    )


def _weights(content: Mapping[str, Any], key: str) -> dict[str, dict[str, float]]:
    return {
        text(morph, key): {
            name: number(weight, f"{key}.{morph}")
            for name, weight in mapping(moves, f"{key}.{morph}").items()
        }
        for morph, moves in mapping(content[key], key).items()
    }


def _lids(content: Mapping[str, Any]) -> dict[str, tuple[str, float]]:
    found = {}
    for unit, row in mapping(content["lids"], "lids").items():
        if not isinstance(row, list) or len(row) != 2:
            raise ValueError(f"`lids.{unit}` is not a coordinate and a weight")
        found[unit] = (text(row[0], f"lids.{unit}"), number(row[1], f"lids.{unit}"))
    return found


def _point(xyz: object, place: str) -> NDArray[np.float64]:
    point = numbers(xyz, (3,), place)
    point.setflags(write=False)
    return point


def _column(found: object, key: str, shape: tuple[int, ...], place: str) -> NDArray[np.float64]:
    listed = rows(found, place)
    return numbers([row[key] for row in listed], (len(listed), *shape), f"{place}.{key}")


def _ints(found: object, key: str, place: str) -> NDArray[np.int64]:
    listed = rows(found, place)
    return wholes([row[key] for row in listed], (len(listed),), f"{place}.{key}")
