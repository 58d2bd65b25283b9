from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from azee.export.pictures import canvas
from azee.export.pictures.camera import VIEWS, Camera, camera
from azee.export.pictures.picture import contact_sheet, picture, render
from azee.export.pictures.raster import coarsen
from azee_rig.mesh import BodyMesh, Part
from azee_rig.rig import Rig

Floats = NDArray[np.float64]
EYE = Camera(np.array([0.0, 0.0, 4.0]), np.zeros(3), np.radians(30.0))


def squares(*depths_and_colours: tuple[float, tuple[float, float, float]]) -> BodyMesh:
    """Squares of side 1 that face the eye, at some depths."""
    vertices, triangles, parts, colours = [], [], [], []
    for n, (z, colour) in enumerate(depths_and_colours):
        vertices += [[-0.5, -0.5, z], [0.5, -0.5, z], [0.5, 0.5, z], [-0.5, 0.5, z]]
        triangles += [[4 * n, 4 * n + 1, 4 * n + 2], [4 * n, 4 * n + 2, 4 * n + 3]]
        parts.append(Part(f"p{n}", 2 * n, 2 * n + 2, (*colour, 1.0), 1.0))
        colours += [[1.0, 1.0, 1.0]] * 4
    count = len(vertices)
    return BodyMesh(
        vertices=np.array(vertices),
        triangles=np.array(triangles),
        parts=tuple(parts),
        colours=np.array(colours),
        joints=np.zeros((count, 1), dtype=np.int64),
        weights=np.ones((count, 1)),
        units=(),
        unit_start=np.zeros(1, dtype=np.int64),
        unit_rows=np.zeros(0, dtype=np.int64),
        unit_deltas=np.zeros((0, 3)),
        joint_count=1,
    )


def pixels(image: Image.Image) -> NDArray[np.uint8]:
    return np.asarray(image)


def test_what_is_nearer_hides_what_is_behind() -> None:
    red, green = (0.5, 0.02, 0.02), (0.02, 0.5, 0.02)
    for mesh in (squares((0.0, red), (-0.5, green)), squares((-0.5, green), (0.0, red))):
        middle = pixels(render(mesh.vertices, mesh, EYE, (60, 60)))[30, 30]
        assert middle[0] > 3 * middle[1]


def test_it_covers_the_place_that_perspective_gives() -> None:
    mesh = squares((0.0, (0.5, 0.5, 0.5)))
    alpha = pixels(render(mesh.vertices, mesh, EYE, (100, 100), transparent=True))[:, :, 3]
    side = 100 * 0.5 / (4.0 * np.tan(np.radians(15.0)))
    assert np.count_nonzero(alpha == 255) == pytest.approx(side**2, rel=0.05)
    assert alpha[50, 50] == 255
    assert alpha[5, 5] == 0


def test_both_faces_are_drawn_and_nothing_behind_the_eye() -> None:
    mesh = squares((0.0, (0.5, 0.5, 0.5)))
    back = Camera(np.array([0.0, 0.0, -4.0]), np.zeros(3), EYE.height_rad)
    assert pixels(render(mesh.vertices, mesh, back, (40, 40), transparent=True))[20, 20, 3] == 255
    away = Camera(EYE.eye, np.array([0.0, 0.0, 8.0]), EYE.height_rad)
    assert not pixels(render(mesh.vertices, mesh, away, (40, 40), transparent=True))[:, :, 3].any()


def test_a_shadow_falls_on_what_is_behind() -> None:
    grey = (0.5, 0.5, 0.5)
    mesh = squares((0.0, grey), (0.1, grey))
    small = np.array(mesh.vertices)
    small[4:] *= (0.3, 0.3, 1.0)
    lit = pixels(render(small, mesh, EYE, (120, 120))).astype(int).sum(axis=2)
    # The light comes from above, a little from the right: the shadow shows below the small square.
    assert lit[71, 58] < 0.8 * lit[71, 80]
    assert lit[46, 60] > 0.95 * lit[46, 80]


def wall_with_shadow(*boxes: tuple[float, float, float, float, float]) -> NDArray[np.int64]:
    """Brightness of a wall of 1 m and 400 pixels, behind plates: x, y, height, width, length."""
    grey = (0.5, 0.5, 0.5)
    mesh = squares((0.0, grey), *((height, grey) for _, _, height, _, _ in boxes))
    places = np.array(mesh.vertices)
    for n, (x, y, _, width, length) in enumerate(boxes, 1):
        places[4 * n : 4 * n + 4] *= (width, length, 1.0)
        places[4 * n : 4 * n + 4] += (x, y, 0.0)
    far = Camera(np.array([0.0, 0.0, 40.0]), np.zeros(3), 2.0 * np.arctan(0.5 / 40.0))
    return np.asarray(pixels(render(places, mesh, far, (400, 400))).astype(int).sum(axis=2))


def test_a_shadow_is_sharp_where_things_touch_and_dissolves_with_distance() -> None:
    def soft_rows(height: float) -> int:
        below = wall_with_shadow((0.0, 0.0, height, 0.3, 0.3))[262:330, 190]
        assert (np.diff(below) >= 0).all(), "it fades out evenly"
        dark, light = below.min(), below[-1]
        assert dark < 0.75 * light
        return int(((below > dark + 0.1 * (light - dark)) & (below < light - 4)).sum())

    near, far = soft_rows(0.04), soft_rows(0.16)
    assert near <= 16
    assert far > 2.5 * near


def test_the_shadow_of_a_hand_before_the_belly_has_no_fingers() -> None:
    fingers = [(0.028 * n, 0.0, 0.15, 0.015, 0.08) for n in range(4)]
    shadow = wall_with_shadow(*fingers)
    y = 200 + int(400 * 0.15 * 0.72 / 0.95)
    x = 200 - int(400 * 0.15 * 0.28 / 0.95)
    across = shadow[y, x - 30 : x + 60]
    assert across.min() < 0.92 * shadow[y, 380], "there is a shadow"
    falls = np.sign(np.diff(across))
    assert np.count_nonzero(np.diff(falls[falls != 0])) == 1, "it is one dark place"


def test_a_surface_does_not_shade_itself() -> None:
    tilted = squares((0.0, (0.5, 0.5, 0.5)))
    places = tilted.vertices @ np.array([[1.0, 0, 0], [0, 0.8, 0.6], [0, -0.6, 0.8]])
    for sign in (1.0, -1.0):
        image = pixels(render(places * (1.0, 1.0, sign), tilted, EYE, (90, 90)))[30:60, 30:60]
        assert np.ptp(image.astype(int), axis=(0, 1)).max() <= 12, "no stripes"


def test_tiles_that_hide_no_light_are_left_out_without_a_trace(
    signer: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    q = signer.coordinates.idle + 0.3 * np.sin(np.arange(len(signer.coordinates)))
    drawn = [pixels(picture(signer, q, view, size=(160, 200))) for view in ("front", "face")]

    def unknowing(depth: Floats, tiles: NDArray[np.float32], rows: NDArray[np.int64]) -> None:
        coarsen(depth, tiles, rows)
        tiles[:, :, 3] = -1e30

    monkeypatch.setattr(canvas, "coarsen", unknowing)
    for view, before in zip(("front", "face"), drawn, strict=True):
        assert np.array_equal(pixels(picture(signer, q, view, size=(160, 200))), before)


def test_the_same_input_gives_the_same_bytes(signer: Rig) -> None:
    idle = signer.coordinates.idle
    one, two = (picture(signer, idle, "face", {"jawOpen": 0.5}, (80, 90)) for _ in range(2))
    assert one.tobytes() == two.tobytes()
    assert one.size == (80, 90)


@pytest.mark.parametrize("view", [*VIEWS, "right hand palm", "left hand tips"])
def test_every_view_shows_the_body(signer: Rig, view: str) -> None:
    image = picture(signer, signer.coordinates.idle, view, size=(48, 60), transparent=True)
    alpha = pixels(image)[:, :, 3]
    assert np.count_nonzero(alpha) / alpha.size > 0.05
    assert alpha[30, 24] > 0, "what is looked at is in the middle"


def test_the_hands_cameras_follow_the_hands(signer: Rig) -> None:
    q = np.array(signer.coordinates.idle)
    low = camera(signer, q, "right hand").target[1]
    q[signer.coordinates.index["arm_R.flexion"]] += 1.0
    assert camera(signer, q, "right hand").target[1] > low + 0.1
    with pytest.raises(KeyError):
        camera(signer, q, "from nowhere")


def test_brows_blinks_and_hands_can_be_told_from_the_pictures(signer: Rig) -> None:
    idle = signer.coordinates.idle
    still = pixels(picture(signer, idle, "face", size=(240, 270))).astype(int)
    for morph in ("AU1", "AU4", "AU43", "AU26", "AU12"):
        changed = pixels(picture(signer, idle, "face", signer.face_morphs[morph], (240, 270)))
        differing = (np.abs(changed.astype(int) - still).max(axis=2) > 24).sum()
        assert differing > 60, morph


def test_a_sheet_sets_pictures_in_rows() -> None:
    images = [(f"no. {i}", Image.new("RGB", (30, 20), (i * 40, 0, 0))) for i in range(5)]
    sheet = contact_sheet(images, 2)
    assert sheet.size == (60, 3 * (20 + 22))
    assert sheet.getpixel((45, 10)) == (40, 0, 0)
    assert contact_sheet([("", images[0][1])]).size == (30, 20)
