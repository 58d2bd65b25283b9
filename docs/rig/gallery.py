"""Rebuilds the pictures of this folder: what the signer looks like, and its axes.

    python docs/rig/gallery.py [FOLDER]

The project must be installed. A change to the body, its limits or its morphs is looked at here
before it is committed.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from azee.export.pictures.atlas import SITE_VIEWS, bone_sheet, morph_sheet, site_panels
from azee.export.pictures.camera import Camera, camera, from_direction
from azee.export.pictures.picture import contact_sheet, picture, render
from azee_rig.build.plain import plain
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_rig.skin import skin

Floats = NDArray[np.float64]
POSTURES = json.loads((Path(__file__).parent / "postures.json").read_text(encoding="utf-8"))


def posture(rig: Rig, *layers: Mapping[str, float]) -> Floats:
    """Return coordinates of idle with some set in degrees, kept inside the limits."""
    q = np.array(rig.coordinates.idle)
    for layer in layers:
        for name, degrees in layer.items():
            for side in "LR" if "{S}" in name else [""]:
                q[rig.coordinates.index[name.format(S=side)]] = np.radians(degrees)
    return np.clip(q, rig.coordinates.lower, rig.coordinates.upper)


def face(rig: Rig, morphs: Mapping[str, float]) -> dict[str, float]:
    """Return unit weights of some AZee morphs together."""
    units: dict[str, float] = {}
    for morph, weight in morphs.items():
        for unit, share in rig.face_morphs[morph].items():
            units[unit] = units.get(unit, 0.0) + share * weight
    return units


def body_sheet(rig: Rig) -> Image.Image:
    """Show bind and idle from four sides, and the arms raised."""
    size = (300, 375)
    bind = np.array(rig.coordinates.bind)
    rows = [("bind", bind), ("idle", np.array(rig.coordinates.idle))]
    rows += [(name, posture(rig, layer)) for name, layer in POSTURES["arms"].items()]
    shown = []
    for name, q in rows:
        vertices = rig.skin(rig.pose(q))
        for view in ("front", "three-quarter", "side", "back"):
            eye = camera(rig, q, view)
            up = np.array([0.0, 0.12, 0.0])
            wider = Camera(eye.eye + up, eye.target + up, eye.height_rad * 1.2)
            shown.append((f"{name}, {view}", render(vertices, rig.mesh, wider, size)))
    return contact_sheet(shown, 8)


def hand_sheet(rig: Rig) -> Image.Image:
    """Show each hand posture from the palm and from the back."""
    shown = []
    for name, layer in POSTURES["hands"].items():
        q = posture(rig, POSTURES["show_hands"], layer)
        vertices = rig.skin(rig.pose(q))
        for side in ("palm", "back", "thumb"):
            eye = camera(rig, q, f"right hand {side}")
            shown.append((f"{name}, {side}", render(vertices, rig.mesh, eye, (260, 260))))
    return contact_sheet(shown, 6)


def face_sheet(rig: Rig) -> Image.Image:
    """Show some expressions, and the eyes turned."""
    q = np.array(rig.coordinates.idle)
    shown = [
        (name, picture(rig, q, "face", face(rig, morphs), (260, 290)))
        for name, morphs in POSTURES["faces"].items()
    ]
    for name, yaw, pitch in (("to the left", 30, 0), ("up", 0, 20), ("down", 0, -20)):
        turned = posture(rig, {"eye_{S}.yaw": yaw, "eye_{S}.pitch": pitch})
        shown.append((f"eyes {name}", picture(rig, turned, "face", size=(260, 290))))
    sides = ("face three-quarter", "face side")
    shown += [(v, picture(rig, q, v, size=(260, 290))) for v in sides]
    return contact_sheet(shown[:18], 6)


def shoulder_sheet(rig: Rig) -> Image.Image:
    """Show raised arms skinned plainly, without helper joints and rhythm, and as they ship."""
    raised = [
        (f"{motion} {angle}", {**POSTURES["raised"], f"arm_{{S}}.{motion}": angle})
        for motion, angles in (("abduction", (90, 120, 150)), ("flexion", (90, 125, 150)))
        for angle in angles
    ]
    rigid, mesh = plain(rig)
    target = rig.landmarks.shoulder_middle
    shown = []
    for view, towards_eye in (("front", (0.0, 0.05, 1.0)), ("back", (-0.3, 0.1, -1.0))):
        eye = from_direction(target, np.array(towards_eye), 0.24)
        for when, body, its_mesh in (("plain", rigid, mesh), ("ours", rig, rig.mesh)):
            for name, layer in raised:
                vertices = skin(its_mesh, body.skeleton, body.pose(posture(rig, layer)))
                picture_of = render(vertices, its_mesh, eye, (250, 220))
                shown.append((f"{name}, {view}, {when}", picture_of))
    return contact_sheet(shown, 6)


def main(folder: Path) -> None:
    """Write all sheets."""
    rig = load_rig()
    for name, sheet in (
        ("body", body_sheet),
        ("shoulders", shoulder_sheet),
        ("hands", hand_sheet),
        ("faces", face_sheet),
        ("morphs", morph_sheet),
        ("axes", bone_sheet),
    ):
        small(sheet(rig), 128 if name == "morphs" else 256).save(
            folder / f"{name}.png", optimize=True
        )
    for region in SITE_VIEWS:
        panels = contact_sheet(site_panels(rig, region), 3)
        panels.quantize(128, method=Image.Quantize.MAXCOVERAGE).save(
            folder / f"sites-{region}.png", optimize=True
        )


def small(image: Image.Image, colours: int = 256) -> Image.Image:
    """Few colours: a third of the bytes, and lips stay red. 256 are dithered, 128 are not."""
    palette = image.quantize(colours, method=Image.Quantize.MAXCOVERAGE, kmeans=1)
    smooth = Image.Dither.FLOYDSTEINBERG if colours == 256 else Image.Dither.NONE
    return image.quantize(palette=palette, dither=smooth)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
