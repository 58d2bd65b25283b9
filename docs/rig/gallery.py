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
from PIL import Image, ImageDraw, ImageFont

from azee.export.picture import Camera, camera, contact_sheet, picture, render
from azee_rig.load import load_rig
from azee_rig.rig import Rig

Floats = NDArray[np.float64]
POSTURES = json.loads((Path(__file__).parent / "postures.json").read_text(encoding="utf-8"))
AXIS_COLOURS = ((200, 60, 50), (40, 150, 60), (50, 90, 210))


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


def morph_sheet(rig: Rig) -> Image.Image:
    """Show every facial morph of AZee that the face can show, at weight 1."""
    q = np.array(rig.coordinates.idle)
    return contact_sheet(
        [
            (name, picture(rig, q, "face", face(rig, {name: 1.0}), (150, 165)))
            for name in rig.face_morphs
        ],
        12,
    )


def axes_sheet(rig: Rig) -> Image.Image:
    """Show the zero pose with every bone's axes: x red, dir green, nrm blue."""
    q = np.clip(np.zeros(len(rig.coordinates)), rig.coordinates.lower, rig.coordinates.upper)
    hand = ("palm", "thumb", "index", "middle", "ring", "little")
    trunk = [b for b in rig.bones if not b.startswith(hand)]
    right_hand = [b for b in rig.bones if b.startswith(hand) and "_R" in b]
    arms_off = np.array(q)
    for side in "LR":
        arms_off[rig.coordinates.index[f"arm_{side}.abduction"]] = np.radians(25.0)
    palm = camera(rig, arms_off, "right hand back")
    near = Camera(palm.eye, palm.target, palm.height_rad * 0.9)
    return contact_sheet(
        [
            ("zero pose, front", _with_axes(rig, q, camera(rig, q, "front"), trunk, 0.07)),
            ("zero pose, from its right", _with_axes(rig, q, camera(rig, q, "side"), trunk, 0.07)),
            (
                "arms 25° off, front",
                _with_axes(rig, arms_off, camera(rig, q, "front"), trunk, 0.07),
            ),
            ("right hand, onto its back", _with_axes(rig, arms_off, near, right_hand, 0.016)),
        ]
    )


def _with_axes(rig: Rig, q: Floats, eye: Camera, bones: list[str], length: float) -> Image.Image:
    size = (460, 575)
    image = render(rig.skin(rig.pose(q)), rig.mesh, eye, size)
    image = Image.blend(image, Image.new("RGB", size, "white"), 0.6)
    draw = ImageDraw.Draw(image)
    font = ImageFont.load_default(11)
    frames = rig.chain.frames(q)
    scale = size[1] / 2.0 / np.tan(eye.height_rad / 2.0)

    def on_screen(point: Floats) -> tuple[float, float]:
        x, y, z = eye.axes @ (point - eye.eye)
        return size[0] / 2.0 - scale * x / z, size[1] / 2.0 + scale * y / z

    for bone in bones:
        nodes = rig.bones[bone]
        start = frames.positions[nodes.origin_node]
        for axis, colour in enumerate(AXIS_COLOURS):
            end = start + length * frames.rotations[nodes.node][:, axis]
            draw.line([on_screen(start), on_screen(end)], fill=colour, width=2)
        x, y = on_screen(start)
        draw.ellipse([x - 2, y - 2, x + 2, y + 2], fill=(20, 20, 40))
        if not bone.endswith("_L"):
            draw.text((x + 5, y - 13), bone, fill=(20, 20, 40), font=font)
    return image


def main(folder: Path) -> None:
    """Write all sheets."""
    rig = load_rig()
    for name, sheet in (
        ("body", body_sheet),
        ("hands", hand_sheet),
        ("faces", face_sheet),
        ("morphs", morph_sheet),
        ("axes", axes_sheet),
    ):
        _small(sheet(rig)).save(folder / f"{name}.png", optimize=True)


def _small(image: Image.Image) -> Image.Image:
    """256 colours with dithering: a third of the bytes, and lips stay red."""
    palette = image.quantize(256, method=Image.Quantize.MAXCOVERAGE, kmeans=1)
    return image.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
