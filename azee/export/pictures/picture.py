"""Pictures of a posed body, without a display and without a graphics driver.

A camera looks at the body; the light is soft and comes from the front left above, so that hands
stand out from the trunk and fingers from each other. Colours are linear until the last step.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from azee.export.pictures.camera import Camera, camera, projected
from azee.export.pictures.canvas import SoftwareCanvas
from azee.export.pictures.posed import SAMPLES
from azee.export.pictures.raster import fill
from azee.export.pictures.typeface import typeface
from azee_rig.mesh import BodyMesh
from azee_rig.rig import Rig

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def render(
    vertices: Floats,
    mesh: BodyMesh,
    camera: Camera,
    size: tuple[int, int] = (480, 600),
    *,
    transparent: bool = False,
    samples: int = SAMPLES,
) -> Image.Image:
    """Draw a posed mesh: vertices (N, 3) as `Rig.skin` gives them, size in pixels.

    Returns: RGB, or RGBA with an empty background when `transparent`.
    """
    return Image.fromarray(SoftwareCanvas(mesh, size, samples).draw(vertices, camera, transparent))


def picture(
    rig: Rig,
    q: Floats,
    view: str = "front",
    unit_weights: Mapping[str, float] | None = None,
    size: tuple[int, int] = (480, 600),
    *,
    transparent: bool = False,
    samples: int = SAMPLES,
) -> Image.Image:
    """Draw a rig in posture q (V,) with a face, through a named camera.

    Args: unit_weights: of the expression, by face unit; the lids follow the eyes by themselves.
    """
    face = {unit: float(weight) for unit, weight in rig.lid_weights(q).items()}
    for unit, weight in (unit_weights or {}).items():
        face[unit] = face.get(unit, 0.0) + weight
    vertices = rig.skin(rig.pose(q), face)
    eye = camera(rig, q, view)
    return render(vertices, rig.mesh, eye, size, transparent=transparent, samples=samples)


CAPTION_PX, CAPTION_LEFT = 13, 6
"""Height of the letters of a caption, and where it begins, in pixels."""


def contact_sheet(
    pictures: Sequence[tuple[str, Image.Image]], columns: int | None = None
) -> Image.Image:
    """Return pictures of one size side by side, each with a caption; rows of `columns`."""
    columns = columns or len(pictures)
    width, height = pictures[0][1].size
    band = 22 if any(caption for caption, _ in pictures) else 0
    rows = -(-len(pictures) // columns)
    sheet = Image.new("RGB", (columns * width, rows * (height + band)), "white")
    draw = ImageDraw.Draw(sheet)
    font = typeface(CAPTION_PX)
    for i, (caption, image) in enumerate(pictures):
        x, y = i % columns * width, i // columns * (height + band)
        sheet.paste(image, (x, y))
        draw.text((x + CAPTION_LEFT, y + height + 3), caption, fill=(40, 40, 40), font=font)
    return sheet


def depth_map(vertices: Floats, triangles: Ints, camera: Camera, size: tuple[int, int]) -> Floats:
    """Return the distance of each pixel along the view, (H, W) metres; infinite if empty."""
    screen, _ = projected(vertices, camera, *size)
    depth = np.full((size[1], size[0]), 1e30)
    fill(screen, np.array(triangles), depth, np.full(depth.shape, -1, dtype=np.int32))
    return np.where(depth < 0.0, -1.0 / depth, np.inf)
