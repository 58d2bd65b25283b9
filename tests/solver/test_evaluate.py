"""Symbolic geometry and constraints as numbers, on the body of sticks."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from stick_body import stick_body

from azee_rig.chain import Frames
from azee_solver.binding import BindingError
from azee_solver.constraint import (
    BoneAxis,
    Constraint,
    Look,
    LookAt,
    Morph,
    Orient,
    Origin,
    Place,
    Relation,
    Rotate,
    Trill,
)
from azee_solver.evaluate import Evaluator, angle
from azee_solver.geometry import (
    Arc,
    Between,
    Bone,
    Circle,
    Cross,
    Dir,
    FreePoint,
    JointPoint,
    Moving,
    NamedPoint,
    Nrm,
    Opp,
    Out,
    Point,
    Rotated,
    Scale,
    Side,
    SigningSpace,
    Site,
    SitePoint,
    Straight,
    Through,
    Towards,
    Unit,
    VDiff,
    Vec,
    Vector,
    VSum,
    VTranslate,
    WorldPoint,
)
from azee_solver.handshape import straight

S, W = Side.STRONG, Side.WEAK
UP, FORWARD = Vec(0.0, 1.0, 0.0), Vec(0.0, 0.0, 1.0)
RIG = stick_body()
HERE = Origin("x.azee", 3, 5)


def posture(**degrees: float) -> tuple[NDArray[np.float64], Frames]:
    """Zero pose with some coordinates, `f_arm_R__flexion=90`."""
    q = np.zeros(len(RIG.coordinates))
    for name, value in degrees.items():
        q[RIG.coordinates.index[name.replace("__", ".")]] = math.radians(value)
    return q, RIG.chain.frames(q)


ZERO, ZERO_FRAMES = posture()
RIGHT = Evaluator(RIG, Side.RIGHT)


@pytest.mark.parametrize(
    ("expr", "wanted"),
    [
        (Vec(1.0, 2.0, 3.0), (1, 2, 3)),
        (Out(S), (-1, 0, 0)),
        (Out(W), (1, 0, 0)),
        (Out(Side.LEFT), (1, 0, 0)),
        (Dir(Bone("palm", S)), (0, -1, 0)),
        (Nrm(Bone("palm", S)), (1, 0, 0)),
        (Opp(Nrm(Bone("head"))), (0, 0, -1)),
        (Unit(Scale(UP, -4.0)), (0, -1, 0)),
        (VSum((UP, FORWARD, UP)), (0, 2, 1)),
        (VSum(()), (0, 0, 0)),
        (VDiff(UP, FORWARD), (0, 1, -1)),
        (Cross(UP, FORWARD), (1, 0, 0)),
        (Towards(JointPoint(Bone("palm", S)), JointPoint(Bone("f_arm", S))), (0, 1, 0)),
        (Rotated(UP, Scale(FORWARD, 7.0), math.pi / 2), (-1, 0, 0)),
    ],
)
def test_vectors(expr: Vector, wanted: tuple[float, float, float]) -> None:
    np.testing.assert_allclose(RIGHT.vector(expr, ZERO_FRAMES), wanted, atol=1e-12)


@pytest.mark.parametrize(
    ("expr", "wanted"),
    [
        (FreePoint(0.1, 0.2, 0.0), (0.11, 1.45 + 0.22, 0)),
        (NamedPoint(SigningSpace.MSSP), (0, 1.2, 0.35)),
        (NamedPoint(SigningSpace.SSSP), (-0.25, 1.2, 0.3)),
        (NamedPoint(SigningSpace.WSSP), (0.25, 1.2, 0.3)),
        (SitePoint(Site("EL", S)), (-0.18, 1.15, -0.04)),
        (JointPoint(Bone("f_arm", W)), (0.18, 1.15, 0)),
        (VTranslate(WorldPoint(1.0, 0.0, 0.0), Scale(UP, 0.1)), (1, 0.11, 0)),
        (Between(WorldPoint(0.0, 0.0, 0.0), WorldPoint(0.0, 4.0, 0.0), 0.25), (0, 1, 0)),
    ],
)
def test_points(expr: Point, wanted: tuple[float, float, float]) -> None:
    np.testing.assert_allclose(RIGHT.point(expr, ZERO_FRAMES), wanted, atol=1e-12)


def test_strong_is_the_left_hand_of_a_left_handed_signer() -> None:
    left = Evaluator(RIG, Side.LEFT)
    np.testing.assert_allclose(left.vector(Out(S), ZERO_FRAMES), [1, 0, 0])
    np.testing.assert_allclose(
        left.point(NamedPoint(SigningSpace.SSSP), ZERO_FRAMES), RIG.signing_space["Lssp"]
    )


def test_geometry_follows_the_posture_for_many_postures_at_once() -> None:
    many = np.stack([posture(f_arm_R__flexion=a)[0] for a in (0.0, 45.0, 90.0)])
    frames = RIG.chain.frames(many)
    dirs = RIGHT.vector(Dir(Bone("f_arm", S)), frames)
    h = math.sqrt(0.5)
    np.testing.assert_allclose(dirs, np.array([[0, -1, 0], [0, -h, h], [0, 0, 1]]), atol=1e-12)
    tip = RIGHT.point(VTranslate(SitePoint(Site("M_TIP", S)), UP), frames)
    assert tip.shape == (3, 3)
    assert RIGHT.vector(Cross(Dir(Bone("f_arm", S)), UP), frames).shape == (3, 3)


def test_paths_scale_with_the_body_and_follow_the_posture() -> None:
    a, b = np.array([0.0, 0, 0]), np.array([1.0, 0, 0])
    assert RIGHT.path(Straight(), a, b, 0.5).tolist() == [0.5, 0, 0]
    assert RIGHT.path(Straight(), a, b, np.linspace(0, 1, 7)).shape == (7, 3)
    apex = RIGHT.path(Arc(Scale(UP, 0.2)), a, b, 0.5)
    np.testing.assert_allclose(apex, [0.5, 0.22, 0], atol=1e-12)
    low = RIGHT.path(Circle(FORWARD, 0.1, 1.0), a, a, 0.5)
    np.testing.assert_allclose(low, [0, -0.22, 0], atol=1e-12)
    through = Through((SitePoint(Site("CH")),))
    curve = RIGHT.path(through, a, b, np.linspace(0, 1, 201), ZERO_FRAMES)
    chin = RIGHT.site(Site("CH"), ZERO_FRAMES)
    assert np.linalg.norm(curve - chin, axis=1).min() < 0.02
    with pytest.raises(ValueError, match="frames"):
        RIGHT.path(through, a, b, 0.5)
    starts = np.stack([a, b, a])
    assert RIGHT.path(Arc(UP), starts, starts + b, np.linspace(0, 1, 5)).shape == (3, 5, 3)


def test_a_dynamic_point_is_on_its_path() -> None:
    point = Moving(Straight(), WorldPoint(0.0, 0.0, 0.0), WorldPoint(1.0, 0.0, 0.0))
    assert RIGHT.point(point, ZERO_FRAMES)[0] == 0.0
    assert RIGHT.point(point, ZERO_FRAMES, 0.25)[0] == 0.25
    shifted = VTranslate(point, Scale(UP, 0.0))
    assert RIGHT.point(shifted, ZERO_FRAMES, 0.25)[0] == 0.25


@pytest.mark.parametrize(
    "expr",
    [Unit(VDiff(UP, UP)), Towards(JointPoint(Bone("head")), JointPoint(Bone("head")))],
)
def test_a_direction_that_is_none_is_nan(expr: Vector) -> None:
    assert np.isnan(RIGHT.vector(expr, ZERO_FRAMES)).all()
    orient = Orient(BoneAxis.DIR, Bone("head"), Relation.ALONG, expr)
    assert np.isnan(RIGHT.residual(orient, ZERO_FRAMES, ZERO)[0])


@pytest.mark.parametrize(
    ("constraint", "wanted", "unit"),
    [
        (Place(Site("EL", S), WorldPoint(-0.18, 1.15, 0.0)), 0.04, "m"),
        (Place(Site("EL", S), WorldPoint(-0.18, 1.15, 0.0), 0.04 / 1.1), 0.0, "m"),
        (Place(Site("EL", S), SitePoint(Site("EL", W))), 0.36, "m"),
        (Place(Site("EL", S), SitePoint(Site("EL", S)), 0.1), 0.11, "m"),
        (Orient(BoneAxis.DIR, Bone("palm", S), Relation.ALONG, UP), math.pi, "rad"),
        (Orient(BoneAxis.DIR, Bone("palm", S), Relation.ACROSS, FORWARD), 0.0, "rad"),
        (Orient(BoneAxis.DIR, Bone("palm", S), Relation.ACROSS, UP), math.pi / 2, "rad"),
        (Orient(BoneAxis.DIR, Bone("palm", S), Relation.ACROSS, Vec(0.0, -1.0, 1.0)), 0.25, "pi"),
        (Orient(BoneAxis.NRM, Bone("head"), Relation.ALONG, Vec(0.0, 3.0, 3.0)), 0.25, "pi"),
        (Look(FORWARD), 0.0, "rad"),
        (Look(Vec(1.0, 0.0, 1.0)), 0.25, "pi"),
        (LookAt(WorldPoint(0.03, 1.68, 1.0)), math.atan(0.06 / 0.92), "rad"),
        (Rotate(Bone("head"), UP, 0.3), 0.3, "rad"),
        (Morph("index_bend", S, 0.5), math.pi / 4 + straight("index_R_1.flexion"), "rad"),
    ],
)
def test_residuals(constraint: Constraint, wanted: float, unit: str) -> None:
    residual, measured_in = RIGHT.residual(constraint, ZERO_FRAMES, ZERO)
    if unit == "pi":
        wanted, unit = wanted * math.pi, "rad"
    assert residual == pytest.approx(wanted, abs=1e-12)
    assert measured_in == unit


def test_a_rotation_is_counted_in_the_parent_s_frame() -> None:
    q, frames = posture(back_2__axial=20, head__flexion=15)
    nod = Rotate(Bone("head"), Vec(1.0, 0.0, 0.0), math.radians(15))
    assert RIGHT.residual(nod, frames, q)[0] < 1e-9
    about_world = Rotate(Bone("head"), Cross(Dir(Bone("head")), FORWARD), math.radians(15))
    assert RIGHT.residual(about_world, frames, q)[0] > 1e-3


def test_morphs_in_force_together_add() -> None:
    q, frames = posture(index_R_1__flexion=45 + math.degrees(straight("index_R_1.flexion")))
    half, quarter = Morph("index_bend", S, 0.25), Morph("index_bend", Side.RIGHT, 0.25)
    assert RIGHT.residual(half, frames, q)[0] == pytest.approx(math.radians(22.5))
    assert RIGHT.residual(half, frames, q, among=[half, quarter])[0] == pytest.approx(0.0)


@pytest.mark.parametrize(
    ("constraint", "code", "name", "text"),
    [
        (Place(Site("NOSE"), FreePoint(0, 0, 0), origin=HERE), "rig-lacks-site", "NOSE", "@NOSE"),
        (Look(Dir(Bone("tail", S)), origin=HERE), "rig-lacks-bone", "tail_R", "!tail(s)"),
        (Morph("grin", None, 1.0, origin=HERE), "rig-lacks-morph", "grin", "'grin"),
        (Morph("purr", S, 1.0, origin=HERE), "rig-lacks-morph", "purr_R", "'purr s"),
        (
            Orient(BoneAxis.DIR, Bone("palm", S), Relation.ALONG, Dir(Bone("wing")), origin=HERE),
            "rig-lacks-bone",
            "wing",
            "!wing",
        ),
    ],
)
def test_what_the_rig_lacks_is_said_with_its_origin(
    constraint: Constraint, code: str, name: str, text: str
) -> None:
    with pytest.raises(BindingError) as caught:
        RIGHT.residual(constraint, ZERO_FRAMES, ZERO)
    assert (caught.value.code, caught.value.name, caught.value.origin) == (code, name, HERE)
    with pytest.raises(BindingError) as checked:
        RIGHT.binding.check(constraint)
    assert (checked.value.text, checked.value.origin) == (text, HERE)


@pytest.mark.parametrize(
    "constraint", [Morph("smile", None, 1.0), Trill(Bone("palm", S), UP, 4.0, 0.1)]
)
def test_what_no_posture_meets_has_no_residual(constraint: Constraint) -> None:
    RIGHT.binding.check(constraint)
    with pytest.raises(ValueError, match="no posture"):
        RIGHT.residual(constraint, ZERO_FRAMES, ZERO)


def test_angles_are_exact_near_their_ends() -> None:
    a = np.array([0.0, 1.0, 0.0])
    for small in (1e-9, 1e-5):
        b = np.array([math.sin(small), math.cos(small), 0.0])
        assert angle(a, 5 * b) == pytest.approx(small, rel=1e-6)
        assert angle(a, -b) == pytest.approx(math.pi - small, rel=1e-12)
