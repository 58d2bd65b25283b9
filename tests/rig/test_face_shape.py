"""The measure of a face that others made, on faces of a few points whose sizes are known."""

from __future__ import annotations

from dataclasses import astuple
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from azee_rig.build.sites import FaceShape
from azee_rig.importing.face_shape import SIGNER, face_shape

APART_M = 0.07
EYES = {f"eye_{s}": np.array([x, 1.6, 0.05]) for s, x in (("L", 0.035), ("R", -0.035))}
LEVEL, CHEEK, NOSE, CHIN, BESIDE = 0.09, 0.10, 0.06, 0.11, 0.01
"""Metres from the middle of the eyes: half the width at their height and below it, ways ahead to
the tip of the nose and down to the chin, and how far ahead the skin beside an eye is."""


def measured(hat_m: float = 0.4, **changed: Any) -> FaceShape:
    """Measure a face of points (x, y, z) from the middle of the eyes, some of them changed.

    hat_m: how high what is not skin reaches above the eyes. Each point is on both sides, but a
    mole is on one.
    """
    points = {
        "temple": (LEVEL, 0.0, -0.03),
        "cheek": (CHEEK, -0.06, -0.03),
        "beside": (0.4 * CHEEK, 0.01, BESIDE),
        "nose": (0.0, -0.04, NOSE),
        "nostril": (0.31 * CHEEK, -0.045, NOSE + 0.03),
        "chin": (0.0, -CHIN, 0.8 * NOSE),
        "throat": (0.0, -2 * CHIN, 0.1 * NOSE),
        "crown": (0.0, 0.15, -0.05),
        "occiput": (0.0, 0.02, -0.12),
    } | changed
    rows = [
        (s * x, y, z)
        for name, (x, y, z) in points.items()
        for s in ((1,) if name == "mole" else (1, -1))
    ]
    hat, other = (0.0, hat_m, 0.0), (0.9, 0.0, 0.9)
    vertices = np.array([*rows, hat, other]) + (EYES["eye_L"] + EYES["eye_R"]) / 2
    count = len(rows)
    triangles = np.array([(n, (n + 1) % count, count + 1) for n in range(count)] + [(count,) * 3])
    surface: Any = SimpleNamespace(
        mesh=SimpleNamespace(vertices=vertices, triangles=triangles),
        roles=np.array(["skin"] * count + ["hair"]),
        share=lambda joints: np.r_[np.ones(count), 1.0, 0.4] if joints == ["head"] else None,
    )
    anatomy: Any = SimpleNamespace(origin=EYES.__getitem__)
    return face_shape(surface, anatomy, "head")


def shares(**sizes: float) -> FaceShape:
    return FaceShape(**{name: m / (SIGNER[name] * APART_M) for name, m in sizes.items()})


def test_a_face_has_the_sizes_of_its_points() -> None:
    """The crown is hair's, too; what hangs on another joint does not count; nor does a nostril."""
    wanted = shares(out=LEVEL, up=0.4, down=CHIN, ahead=NOSE, back=0.12)
    assert astuple(measured()) == pytest.approx(astuple(wanted))


def test_the_wider_side_tells_how_wide_a_face_is() -> None:
    for side in (1.0, -1.0):
        found = measured(mole=(side * 1.05 * LEVEL, 0.0, -0.03))
        assert found.out == pytest.approx(1.05 * LEVEL / (SIGNER["out"] * APART_M))


def test_joints_deep_behind_the_eyes_are_told_and_others_are_not() -> None:
    size = CHEEK / SIGNER["out"]
    for ahead in (0.70, 0.85):  # of the face's size; the front of an eye is at .28
        found = measured(beside=(0.4 * CHEEK, 0.01, ahead * size), nose=(0.0, -0.04, 0.15))
        deep = (ahead - 0.28) * size if ahead > 0.28 + 0.5 else 0.0
        assert found.deep == pytest.approx(deep / APART_M)
        assert found.ahead == pytest.approx((0.15 - deep) / (SIGNER["ahead"] * APART_M))
        assert found.back == pytest.approx((0.12 + deep) / (SIGNER["back"] * APART_M))


@pytest.mark.parametrize(
    ("x", "y", "told"),
    [(0.4, 0.24, True), (0.4, 0.26, False), (0.21, 0.01, True), (0.19, 0.01, False),
     (0.49, 0.01, True), (0.51, 0.01, False)],
)  # fmt: skip
def test_the_skin_beside_an_eye_tells_how_deep_it_lies(x: float, y: float, told: bool) -> None:
    """Within a quarter of the half width from their height, and a fifth to a half aside."""
    size = CHEEK / SIGNER["out"]
    lid = (x * CHEEK, y * CHEEK, 0.85 * size)
    found = measured(lid=lid, nose=(0.0, -0.04, 0.15))
    assert found.deep == pytest.approx((0.85 - 0.28) * size / APART_M if told else 0.0)


def test_a_face_like_the_signer_s_is_measured_by_its_eyes_alone() -> None:
    like = {name: share * APART_M for name, share in SIGNER.items()}
    points: dict[str, Any] = {
        "temple": (like["out"], 0.0, -0.03),
        "cheek": (0.5 * like["out"], -0.06, -0.03),
        "nose": (0.0, -0.04, like["ahead"]),
        "nostril": (0.0, -0.04, like["ahead"]),
        "chin": (0.0, -like["down"], 0.8 * like["ahead"]),
        "occiput": (0.0, 0.02, -like["back"]),
        "crown": (0.0, 0.5 * like["up"], -0.05),
    }
    for share, usual in ((0.79, False), (0.81, True), (1.0, True), (1.24, True), (1.26, False)):
        found = measured(share * like["up"], **points)
        assert (found == FaceShape()) == usual
        assert found.up == pytest.approx(1.0 if usual else share)


@pytest.mark.parametrize("lacking", ["chin", "face"])
def test_what_is_no_face_is_not_measured(lacking: str) -> None:
    flat = (0.0, 0.0, 0.0)
    if lacking == "chin":
        assert measured(chin=flat, throat=flat, nose=(0.0, 0.04, NOSE), cheek=(CHEEK, 0.06, 0),
                        nostril=flat) == FaceShape()  # fmt: skip
    else:
        names = "temple cheek beside nose nostril chin throat crown occiput"
        points: dict[str, Any] = dict.fromkeys(names.split(), flat)
        assert measured(**points) == FaceShape()


def test_a_face_without_a_middle_or_without_a_side_is_not_measured() -> None:
    """A mask with a hole where nose and chin would be; and one that lies below the eyes."""
    apart = 0.4 * CHEEK
    hole: dict[str, Any] = {
        name: (apart, y, z)
        for name, (y, z) in {
            "nose": (-0.04, NOSE), "nostril": (-0.045, NOSE), "chin": (-CHIN, NOSE),
            "throat": (-2 * CHIN, 0.0), "crown": (0.15, -0.05), "occiput": (0.02, -0.12),
        }.items()
    }  # fmt: skip
    assert measured(**hole) == FaceShape()
    low: dict[str, Any] = {"temple": (LEVEL, -0.07, -0.03), "beside": (0.4 * CHEEK, -0.07, BESIDE),
           "nose": (0.0, -0.07, NOSE), "nostril": (0.0, -0.07, NOSE),
           "crown": (0.0, -0.07, -0.05), "occiput": (0.0, -0.07, -0.12)}  # fmt: skip
    assert measured(**low) == FaceShape()
