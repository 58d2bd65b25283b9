"""Rebuilds bodies.png: the bodies that ship side by side, idle and signing.

python docs/rig/bodies_gallery.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from gallery import small
from PIL import Image

import azee
from azee.export.pictures.camera import Camera, camera
from azee.export.pictures.picture import contact_sheet, picture, render
from azee_rig.load import load_rig, shipped_rigs
from azee_rig.rig import Rig

SIZE = (300, 375)
EXAMPLES = Path(__file__).parents[2] / "examples"
MOMENTS = {"tree": (0.5, "front"), "person-aged-52": (0.28, "front")}
"""Part of the way through an example, and the view."""


def whole(rig: Rig, view: str) -> Image.Image:
    """Draw a body from head to feet, all bodies at one scale."""
    q = np.array(rig.coordinates.idle)
    eye = camera(rig, q, view)
    middle = np.array([0.0, 0.98, 0.0])
    away = eye.eye - eye.target
    far = 5.0 * away / np.linalg.norm(away)
    wide = Camera(middle + far, middle, 2.0 * np.arctan2(1.05, 5.0))
    return render(rig.skin(rig.pose(q)), rig.mesh, wide, SIZE)


def main(folder: Path, bodies: tuple[str, ...]) -> None:
    """Draw each body: standing, from two sides, its face, and in each example."""
    shown = []
    for name in bodies:
        rig = load_rig(name)
        title = Path(name).name
        shown += [(f"{title}, {view}", whole(rig, view)) for view in ("front", "three-quarter")]
        shown.append((f"{title}, face", picture(rig, rig.coordinates.idle, "face", size=SIZE)))
        for example, (share, view) in MOMENTS.items():
            made = azee.compile(EXAMPLES / example / f"{example}.azee", name, life=False)
            frame = int(share * len(made.clip.times))
            units = dict(zip(made.clip.units, made.clip.unit_weights[frame], strict=True))
            image = picture(rig, made.clip.coordinates[frame], view, units, SIZE)
            shown.append((f"{title}, {example}", image))
    small(contact_sheet(shown, 3 + len(MOMENTS)), 128).save(folder / "bodies.png", optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent,
         tuple(sys.argv[2:]) or shipped_rigs())  # fmt: skip
