"""Lids lie on the eyes: nothing of an eyeball shows but between them, whatever the face does."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.export.pictures.camera import from_direction, projected
from azee.export.pictures.raster import fill
from azee_rig.rig import Rig

SIZE = (520, 240)


def _seen(rig: Rig, morphs: Mapping[str, float], yaw: float, pitch: float) -> NDArray[np.bool_]:
    """Pixels (H, W) of eyeballs in a picture of both eyes, without the hairs before them."""
    q = np.array(rig.coordinates.idle)
    for side in "LR":
        q[rig.coordinates.index[f"eye_{side}.yaw"]] = np.radians(yaw)
        q[rig.coordinates.index[f"eye_{side}.pitch"]] = np.radians(pitch)
    units = {unit: float(weight) for unit, weight in rig.lid_weights(q).items()}
    for morph, weight in morphs.items():
        for unit, share in rig.face_morphs[morph].items():
            units[unit] = units.get(unit, 0.0) + weight * share
    eyes = rig.chain.frames(q).positions[[rig.bones[f"eye_{side}"].node for side in "LR"]]
    view = from_direction(eyes.mean(axis=0), np.array([0.0, 0.03, 1.0]), 0.028)
    screen = projected(rig.skin(rig.pose(q), units), view, *SIZE)[0]
    depth, seen = np.full(SIZE[::-1], 1e30), np.full(SIZE[::-1], -1, dtype=np.int32)
    triangles = np.array(rig.mesh.triangles)
    (lashes,) = (p for p in rig.mesh.parts if p.name == "lashes")
    triangles[lashes.start : lashes.stop] = 0
    fill(np.ascontiguousarray(screen), triangles, depth, seen)
    (part,) = (p for p in rig.mesh.parts if p.name == "eyes")
    return np.asarray((seen >= part.start) & (seen < part.stop))


def _pieces(seen: NDArray[np.bool_]) -> int:
    """Runs of eyeball in a column of pixels, the most of any column."""
    starts = np.diff(np.pad(seen.astype(np.int64), ((1, 0), (0, 0))), axis=0) == 1
    return int(starts.sum(axis=0).max())


@pytest.mark.parametrize(
    ("morphs", "yaw", "pitch"),
    [
        ({}, 0, 0),
        ({"AU12": 1, "AU6": 1, "AU7": 1}, 0, 0),
        ({"AU12_a": 1, "AU6_a": 1}, 0, 0),
        ({"AU4": 1, "AU7": 1, "AU9": 1}, 0, -20),
        ({"AU1": 1, "AU2": 1, "AU5": 1}, 0, 20),
        ({}, 30, 0),
        ({}, -30, 15),
        ({}, 0, -25),
    ],
)
def test_eyes_show_between_the_lids_only(
    signer: Rig, morphs: Mapping[str, float], yaw: float, pitch: float
) -> None:
    assert _pieces(_seen(signer, morphs, yaw, pitch)) == 1


def test_a_blink_hides_the_eyes_wherever_they_look(signer: Rig) -> None:
    for yaw, pitch in ((0, 0), (30, 0), (0, -20), (-30, 20)):
        assert not _seen(signer, {"AU43": 1}, yaw, pitch).any()
    left = _seen(signer, {"AU43_L": 1}, 0, 0)
    assert left[:, : SIZE[0] // 2].any(), "the right eye is open: left in the picture"
    assert not left[:, SIZE[0] // 2 :].any()


def test_lids_open_as_the_gaze_rises(signer: Rig) -> None:
    down, rest, up = (_seen(signer, {}, 0, pitch).sum() for pitch in (-20, 0, 20))
    assert down < 0.8 * rest < rest < 0.95 * up
