"""Sheets that show what a body has: its sites, the axes of its bones, its limits, its morphs."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from azee.export.files import replace_file
from azee.export.pictures.camera import Camera, camera, from_direction, projected
from azee.export.pictures.marks import INK, Mark, View
from azee.export.pictures.picture import contact_sheet, picture, render
from azee.export.pictures.typeface import typeface
from azee_rig.rig import Rig

Floats = NDArray[np.float64]

AXIS_COLOURS = ((200, 60, 50), (40, 150, 60), (50, 90, 210))
HAND = ("palm", "thumb", "index", "middle", "ring", "little")
SITE_VIEWS: Mapping[str, Sequence[str]] = {
    "body": ("front", "back", "side"),
    "head": ("face", "face side", "head left"),
    "hand": tuple(f"right hand {side}" for side in ("palm", "back", "thumb", "little", "tips")),
}
"""Views that share the sites of a region; each site is labelled in the view that shows it best."""
HAND_UP: Mapping[str, float] = {
    "arm_R.flexion": 40.0,
    "arm_R.abduction": 8.0,
    "arm_R.rotation": 0.0,
    "f_arm_R.flexion": 132.0,
    "f_arm_R.pronation": 75.0,
    "palm_R.flexion": 0.0,
    "palm_R.deviation": 0.0,
    "index_R_1.deviation": 16.0,
    "middle_R_1.deviation": 0.0,
    "ring_R_1.deviation": -16.0,
    "little_R_1.deviation": -36.0,
}
"""Degrees."""

MORPH_VIEW_M = 0.105
"""Half the height of the picture of a morph: from the forehead to under the chin."""
FROM_THE_SIDE = frozenset({"AU29"})


def site_sheet(rig: Rig) -> Image.Image:
    """Show every site as a labelled dot, except those of the left hand, which mirrors the right."""
    return contact_sheet([panel for region in SITE_VIEWS for panel in site_panels(rig, region)], 4)


def site_panels(rig: Rig, region: str) -> list[tuple[str, Image.Image]]:
    """Show the sites of a region of SITE_VIEWS; rings are those that no view shows.

    Body and head are in the bind pose; the right hand is held up, fingers apart.
    """
    q = np.array(rig.coordinates.bind)
    if region == "hand":
        for name, degrees in HAND_UP.items():
            i = rig.coordinates.index[name]
            q[i] = np.clip(np.radians(degrees), rig.coordinates.lower[i], rig.coordinates.upper[i])
    frames, vertices = rig.chain.frames(q), rig.skin(rig.pose(q))
    marks = [
        Mark(name, site.point(frames), site.outward(frames))
        for name, site in rig.sites.items()
        if _region(site.bone) == region
    ]
    views = SITE_VIEWS[region]
    shown = [View(vertices, rig.mesh, camera(rig, q, view), (460, 560)) for view in views]
    best = np.argmax([view.shown(marks) for view in shown], axis=0)
    panels = []
    for k, (name, view) in enumerate(zip(views, shown, strict=True)):
        own = [mark for mark, b in zip(marks, best, strict=True) if b == k]
        panels.append((f"{name} ({len(own)} sites)", view.drawn(own)))
    return panels


def _region(bone: str) -> str:
    """Return the region of SITE_VIEWS for a bone's sites; none for the left hand's."""
    if bone.startswith(HAND):
        return "hand" if "_R" in bone else ""
    return "head" if bone.startswith(("head", "eye", "neck")) else "body"


def bone_sheet(rig: Rig) -> Image.Image:
    """Show the zero pose with every bone's axes: x red, dir green, nrm blue."""
    q = np.clip(np.zeros(len(rig.coordinates)), rig.coordinates.lower, rig.coordinates.upper)
    trunk = [b for b in rig.bones if not b.startswith(HAND)]
    right_hand = [b for b in rig.bones if b.startswith(HAND) and "_R" in b]
    arms_off = np.array(q)
    for side in "LR":
        arms_off[rig.coordinates.index[f"arm_{side}.abduction"]] = np.radians(25.0)
    palm = camera(rig, arms_off, "right hand back")
    near = Camera(palm.eye, palm.target, palm.height_rad * 0.9)
    front = camera(rig, q, "front")
    return contact_sheet(
        [
            ("zero pose, front", _with_axes(rig, q, front, trunk, 0.07)),
            ("zero pose, from its right", _with_axes(rig, q, camera(rig, q, "side"), trunk, 0.07)),
            ("arms 25° off, front", _with_axes(rig, arms_off, front, trunk, 0.07)),
            ("right hand, onto its back", _with_axes(rig, arms_off, near, right_hand, 0.016)),
        ]
    )


def _with_axes(rig: Rig, q: Floats, eye: Camera, bones: list[str], length: float) -> Image.Image:
    size = (460, 575)
    image = render(rig.skin(rig.pose(q)), rig.mesh, eye, size)
    image = Image.blend(image, Image.new("RGB", size, "white"), 0.6)
    draw = ImageDraw.Draw(image)
    font = typeface(11)
    frames = rig.chain.frames(q)
    for bone in bones:
        nodes = rig.bones[bone]
        start = frames.positions[nodes.origin_node]
        ends = start + length * frames.rotations[nodes.node].T
        screen = projected(np.vstack([start, ends]), eye, *size)[0][:, :2]
        (x, y), *tips = ((float(u), float(v)) for u, v in screen)
        for tip, colour in zip(tips, AXIS_COLOURS, strict=True):
            draw.line([(x, y), tip], fill=colour, width=2)
        draw.ellipse([x - 2, y - 2, x + 2, y + 2], fill=INK)
        if not bone.endswith("_L"):
            draw.text((x + 5, y - 13), bone, fill=INK, font=font)
    return image


def limit_sheet(rig: Rig) -> Image.Image:
    """Show each coordinate of trunk, head and right side at both of its limits, others at idle."""
    c = rig.coordinates
    shown = []
    for i, name in enumerate(c.names):
        if "_L" in name:
            continue
        view = _limit_view(name)
        for limit in (c.lower[i], c.upper[i]):
            q = np.array(c.idle)
            q[i] = limit
            image = picture(rig, q, view, size=(176, 190))
            shown.append((f"{name} {np.degrees(limit):.0f}°", image))
    return contact_sheet(shown, 10)


def _limit_view(coordinate: str) -> str:
    """Return the view that shows the movement of a coordinate best."""
    bone = coordinate.partition(".")[0]
    if bone.startswith("palm"):
        return "right hand"
    if bone.startswith(HAND):
        flexes = coordinate.endswith("flexion") and not bone.startswith("thumb")
        return "right hand thumb" if flexes else "right hand palm"
    if bone.startswith("eye"):
        return "face"
    return "three-quarter"


def morph_sheet(rig: Rig) -> Image.Image:
    """Show every facial morph of AZee at weight 1; first the neutral face.

    A morph that the face cannot show has a tile with a text that says so. The thrust of the chin is
    shown from the side.
    """
    q, size = rig.coordinates.idle, (160, 176)
    eyes = rig.chain.frames(q).positions[[rig.bones[f"eye_{side}"].node for side in "LR"]]
    middle = eyes.mean(axis=0) + np.array([0.0, -0.03, -0.03])
    views = {
        side: from_direction(middle, np.array(towards_eye), MORPH_VIEW_M)
        for side, towards_eye in (("front", (0.0, 0.03, 1.0)), ("side", (-1.0, 0.03, 0.25)))
    }
    pose = rig.pose(q)
    shown = [("at rest", render(rig.skin(pose), rig.mesh, views["front"], size))]
    for name in (*rig.face_morphs, *rig.unexpressed_morphs):
        if name in rig.face_morphs:
            vertices = rig.skin(pose, rig.face_morphs[name])
            view = views["side" if name in FROM_THE_SIDE else "front"]
            tile = render(vertices, rig.mesh, view, size)
        else:
            tile = Image.new("RGB", size, (235, 235, 235))
            ImageDraw.Draw(tile).text((12, 96), "cannot be shown", fill=INK)
        shown.append((name, tile))
    return contact_sheet(shown, 12)


SHEETS: Mapping[str, Callable[[Rig], Image.Image]] = {
    "sites": site_sheet,
    "bones": bone_sheet,
    "limits": limit_sheet,
    "morphs": morph_sheet,
}


def write_sheet(what: str, rig: Rig, path: str | Path) -> None:
    """Draw one of SHEETS to a PNG. Raises: OSError: the file cannot be written."""
    data = io.BytesIO()
    SHEETS[what](rig).save(data, "PNG", optimize=True)
    with replace_file(path) as file:
        file.write(data.getvalue())
