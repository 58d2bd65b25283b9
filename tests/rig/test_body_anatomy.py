"""Where bones without joints begin, and how a palm lies, on joints and skin made by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from body_families import make_body
from joint_names import FAMILIES
from numpy.typing import NDArray

from azee_rig.importing.body_anatomy import Model, body_anatomy
from azee_rig.importing.bone_map import ARM, DIGITS, PHALANGES, SIDES, TRUNK, BoneMap
from azee_rig.importing.container import read_gltf
from azee_rig.importing.reduced import Reduced
from azee_rig.importing.scene import read_scene

Floats = NDArray[np.float64]

ALONG_NRM = np.array([0.0, 0.0, 1.0])
"""Knuckles that a model puts one forearm's length along the palm's normal tell that normal."""
MODEL = Model(
    {f"{d}_{s}_{k}": ALONG_NRM for d in DIGITS for s in SIDES for k in PHALANGES},
    {s: (np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])) for s in SIDES},
)
SLAB = np.array([[x, y, 0.0] for y in (-0.7, -0.66, -0.62, -0.58) for x in (-0.03, 0.03)])
"""Skin below a wrist, thin from front to back."""


def standing(skin: Floats, fingers: tuple[str, ...] = ()) -> tuple[Reduced, BoneMap]:
    """A body whose arms hang straight down, with the same skin on both hands.

    The first joints of fingers lie below the wrist, one behind the other.
    """
    places = {name: np.array([0.0, 0.2 * k, 0.0]) for k, name in enumerate(TRUNK)}
    owner: list[str] = ["head"]
    for side, sign in (("L", 1.0), ("R", -1.0)):
        for name, down in zip(ARM, (0.0, 0.0, -0.25, -0.5), strict=True):
            aside = 0.05 if name == "clav" else 0.2
            places[f"{name}_{side}"] = np.array([sign * aside, down, 0.0])
        for k, finger in enumerate(fingers):
            knuckle = np.array([sign * 0.2, -0.6, -0.03 * k])
            places |= {f"{finger}_{side}_{n}": knuckle - (0.0, 0.03 * n, 0.0) for n in PHALANGES}
        owner += [f"palm_{side}"] * len(skin)
    names = tuple(places)
    weights = np.array([[float(name == one) for name in names] for one in owner])
    reduced = Reduced(names, np.zeros(len(names), int), np.array([*places.values()]), weights)
    return reduced, BoneMap({name: (name,) for name in names}, TRUNK[0])


def palm_normals(skin: Floats, fingers: tuple[str, ...] = ()) -> dict[str, Floats]:
    """Normal of the palm by side, as the invented knuckles of the little finger show it."""
    reduced, bones = standing(skin, fingers)
    hands = [skin + np.array([sign * 0.2, 0.0, 0.0]) for sign in (1.0, -1.0)]
    vertices = np.vstack([[[0.0, 0.9, 0.0]], *hands])
    eyes = {s: np.array([0.0, 0.7, 0.1]) for s in SIDES}
    anatomy = body_anatomy(reduced, bones, {}, eyes, vertices, MODEL)
    found = {}
    for side in SIDES:
        away = anatomy.joints[f"little_{side}_1"][0] - anatomy.joints[f"palm_{side}"][0]
        found[side] = away / np.linalg.norm(away)
    return found


@pytest.mark.parametrize(
    ("skin", "fingers", "inward"),
    [
        (SLAB, (), 0.0),
        (SLAB[:7], (), 1.0),
        (SLAB, ("index",), 0.0),
        (SLAB, ("index", "middle"), 1.0),
        (SLAB, ("index", "middle", "ring"), 1.0),
    ],
    ids=["skin", "too little skin", "one finger", "two fingers", "three fingers"],
)
def test_a_palm_lies_as_two_knuckles_do_else_as_its_skin_does(
    skin: Floats, fingers: tuple[str, ...], inward: float
) -> None:
    """Fingers one behind the other: the palm faces the thigh. Thin from front to back: it does not.

    Eight vertices tell how skin lies, fewer do not.
    """
    for side, normal in palm_normals(skin, fingers).items():
        assert normal[0] == pytest.approx(-inward if side == "L" else inward, abs=1e-6)


@pytest.mark.parametrize("metre", [1.0, 100.0])
@pytest.mark.parametrize(
    ("moved_m", "posed"), [(0.0, False), (-0.001, False), (-0.01, True), (0.01, True)]
)
def test_nodes_that_stand_elsewhere_than_they_were_bound_are_a_posture(
    tmp_path: Path, metre: float, moved_m: float, posed: bool
) -> None:
    """More than a thousandth of the body's height away, whatever its unit and the direction."""
    file = make_body(FAMILIES["ready-player-me"]).file(unit=1.0 / metre)
    head = next(node for node in file.nodes if node.get("name") == "Head")
    head["translation"][0] += moved_m * metre
    assert read_scene(read_gltf(file.write(tmp_path / "body.glb"))).posed == posed
