"""Scores made of scores, and the laws that hold for them."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from evaluations import constraints, content, group, times, value
from every_member import CONSTRAINTS, POINTS, title
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from azee.lang.relocation import Relocation
from azee.lang.resizing import Resizing
from azee.score.articulators import arm_of
from azee.score.score import Group, Key, Score, leaves
from azee_grammar.diagnostic import AZeeError
from azee_rig.rig import Rig
from azee_solver.constraint import (
    BoneAxis,
    Constraint,
    LookAt,
    Morph,
    Orient,
    Place,
    Relation,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import (
    Arc,
    Between,
    Bone,
    Circle,
    FreePoint,
    JointPoint,
    Moving,
    NamedPoint,
    Opp,
    Point,
    Scale,
    Side,
    SigningSpace,
    Site,
    SitePoint,
    Straight,
    Through,
    Towards,
    Vec,
    Vector,
    VTranslate,
    Was,
)

SIGNS = ("arbre", "armoire", "bien", "personne", "âge", "Irak", "chat", "bonjour", "nb-7")
TIP, OTHER_TIP = Site("I_TIP", Side.STRONG), Site("I_TIP", Side.WEAK)
CHIN = SitePoint(Site("CH"))
MSSP, RSSP = NamedPoint(SigningSpace.MSSP), NamedPoint(SigningSpace.RSSP)
VECTORS: tuple[Vector, ...] = (
    Vec(0.1, -0.2, 0.3),
    Scale(Vec(0.0, 1.0, 0.0), 0.1),
    Opp(Vec(0.25, 0.0, 0.0)),
)


def _score(expression: str) -> Score:
    found = content(expression)
    assert isinstance(found, Group | Key)
    return found


def _code(expression: str) -> list[str]:
    with pytest.raises(AZeeError) as raised:
        value(expression)
    return [d.code for d in raised.value.diagnostics]


def _keyed(*each: tuple[Constraint, ...]) -> Group:
    """A key of a second for each set of constraints."""
    found = group(f"seq (list {' '.join('(key 1 cstr())' for _ in each)})")
    blocks = []
    for block, those in zip(found.blocks, each, strict=True):
        key = Key(Fraction(1), constraints=those)
        blocks.append(type(block)(block.name, block.interval_in_parent, key))
    return Group(found.duration, arrangement=found.arrangement, blocks=tuple(blocks))


def _constraints(score: Score) -> list[Constraint]:
    keys = [leaf.score for leaf in leaves(score) if isinstance(leaf.score, Key)]
    return [constraint for key in keys for constraint in key.constraints]


# Relocation -----------------------------------------------------------------------------------


def test_points_in_space_are_moved_and_the_body_stays() -> None:
    found = constraints(
        """relocate
    cstr
        place @I_TIP(s) ^Rssp
        place @I_TIP(w) @CH
        place @I_TIP(R) (vtranslate ^Mssp ^up)
        place @I_TIP(L) (vtranslate @CH ^up)
        lookat ^addressee
        lookat (between @CH (point 0 0 1) .5)
        orient 'dir !palm(s) 'along towards(joint(!palm(w)), ^Rssp)
        transpath @I_TIP(s) through(^Rssp, @CH)
    vec .1 0 0
"""
    )
    v = Vec(0.1, 0.0, 0.0)
    assert found == (
        Place(TIP, VTranslate(RSSP, v)),
        Place(OTHER_TIP, CHIN),
        Place(Site("I_TIP", Side.RIGHT), VTranslate(VTranslate(MSSP, v), Vec(0.0, 1.0, 0.0))),
        Place(Site("I_TIP", Side.LEFT), VTranslate(CHIN, Vec(0.0, 1.0, 0.0))),
        LookAt(NamedPoint(SigningSpace.ADDRESSEE)),
        LookAt(Between(CHIN, VTranslate(FreePoint(0, 0, 1), v), 0.5)),
        Orient(
            BoneAxis.DIR,
            Bone("palm", Side.STRONG),
            Relation.ALONG,
            Towards(JointPoint(Bone("palm", Side.WEAK)), VTranslate(RSSP, v)),
        ),
        Transpath(TIP, Through((VTranslate(RSSP, v), CHIN))),
    )


@pytest.mark.parametrize("name", SIGNS)
@pytest.mark.parametrize("vector", ["(vec .1 -.2 .3)", "(scale (out s) .1)", "(dir !palm(w))"])
def test_there_and_back_is_the_sign(name: str, vector: str) -> None:
    there = f"relocate :{name} {vector}"
    assert _score(f"relocate ({there}) (oppvect {vector})") == _score(f":{name}")


numbers = st.integers(-64, 64).map(lambda n: n / 128)
vectors = st.builds(Vec, numbers, numbers, numbers)


@pytest.mark.long
@given(st.sampled_from(CONSTRAINTS), vectors)
def test_there_and_back_is_the_constraint(constraint: Constraint, v: Vec) -> None:
    back = Vec(-v.x, -v.y, -v.z)
    assert Relocation(back).constraint(Relocation(v).constraint(constraint)) == constraint


@pytest.mark.parametrize("vector", VECTORS)
@pytest.mark.parametrize("point", POINTS, ids=title)
def test_a_point_in_space_lies_as_much_farther(point: Point, vector: Vector, signer: Rig) -> None:
    measure = Evaluator(signer, Side.RIGHT)
    frames = signer.chain.frames(signer.coordinates.idle)

    def at(p: Point) -> NDArray[np.float64]:
        return measure.point(p, frames, 0.3)

    way = at(Relocation(vector).point(point)) - at(point)
    whole = at(VTranslate(point, vector)) - at(point)
    stays = dict.fromkeys((Between, VTranslate, SitePoint, JointPoint, Was), 0.0)
    share = {**stays, Moving: 0.7}
    np.testing.assert_allclose(way, whole * share.get(type(point), 1.0), atol=1e-12)


def test_a_relocated_sign_has_grown_by_what_was_added() -> None:
    plain, moved = value(":arbre"), value("relocate :arbre ^up")
    assert plain.size < moved.size <= plain.size + 2 * len(_constraints(_score(":arbre")))
    doubled = "relocate (relocate :arbre ^up) ^down"
    assert value(doubled).size == moved.size


# Size -----------------------------------------------------------------------------------------


def test_a_site_is_drawn_towards_the_middle_of_its_places() -> None:
    found = _score(
        "resize (seq (list (key 1 (place @I_TIP(s) ^Mssp)) (key 1 (place @I_TIP(s) ^Rssp)))) .5"
    )
    middle = Between(MSSP, RSSP, 0.5)
    assert _constraints(found) == [
        Place(TIP, Between(middle, MSSP, 0.5)),
        Place(TIP, Between(middle, RSSP, 0.5)),
    ]


def test_a_site_that_stays_is_not_moved() -> None:
    expression = "sync 'A (key 1 (place @I_TIP(s) ^Mssp)) 'B (key 1 (place @I_TIP(w) ^Rssp)) "
    whole = f"{expression}'start 'A:end"
    assert _score(f"resize ({whole}) .5") == _score(whole)


def test_what_touches_the_body_still_touches_it() -> None:
    away = VTranslate(CHIN, Vec(0.0, 0.0, 0.1))
    score = _keyed((Place(TIP, CHIN, contact=True),), (Place(TIP, away),))
    assert _constraints(Resizing.of(score, 0.5).score(score)) == [
        Place(TIP, CHIN, contact=True),
        Place(TIP, Between(CHIN, away, 0.5)),
    ]


def test_paths_trills_and_turns_become_smaller() -> None:
    up, head = Vec(0.0, 1.0, 0.0), Bone("head")
    score = _keyed(
        (
            Transpath(TIP, Arc(up)),
            Transpath(TIP, Circle(up, 0.1, 2)),
            Transpath(TIP, Straight()),
            Trill(Bone("palm", Side.STRONG), up, 5.0, 0.2),
            Rotate(head, up, 0.4),
            Rotate(Bone("index", Side.STRONG, 1), up, 0.4),
            Morph("AU12", None, 1.0),
        )
    )
    assert _constraints(Resizing.of(score, 0.5).score(score)) == [
        Transpath(TIP, Arc(Scale(up, 0.5))),
        Transpath(TIP, Circle(up, 0.05, 2)),
        Transpath(TIP, Straight()),
        Trill(Bone("palm", Side.STRONG), up, 5.0, 0.1),
        Rotate(head, up, 0.2),
        Rotate(Bone("index", Side.STRONG, 1), up, 0.4),
        Morph("AU12", None, 1.0),
    ]
    without = _constraints(Resizing.of(score, 0.0).score(score))
    assert without[1] == Transpath(TIP, Straight())


def _placed(score: Score, measure: Evaluator, rig: Rig) -> NDArray[np.float64]:
    frames = rig.chain.frames(rig.coordinates.idle)
    points = [c.point for c in _constraints(score) if isinstance(c, Place)]
    return np.array([measure.point(point, frames, 0.3) for point in points])


FREE = tuple(p for p in POINTS if not isinstance(p, SitePoint | JointPoint | Moving))
sizes = st.integers(0, 16).map(lambda n: n / 8)


@given(st.lists(st.sampled_from(FREE), min_size=2, max_size=5, unique=True), sizes, sizes)
def test_sizes_multiply_and_the_middle_stays(
    points: list[Point], first: float, second: float
) -> None:
    rig = _signer()
    measure = Evaluator(rig, Side.RIGHT)
    score = _keyed(*((Place(TIP, point),) for point in points))
    once = Resizing.of(score, first).score(score)
    twice = Resizing.of(once, second).score(once)
    whole = Resizing.of(score, first * second).score(score)
    plain, found, expected = (_placed(s, measure, rig) for s in (score, twice, whole))
    np.testing.assert_allclose(found, expected, atol=1e-9)
    middle = plain.mean(axis=0)
    np.testing.assert_allclose(found - middle, first * second * (plain - middle), atol=1e-9)


@given(st.lists(st.sampled_from((CHIN, SitePoint(OTHER_TIP))), min_size=1, max_size=5), sizes)
def test_what_is_on_the_body_has_no_size(points: list[Point], factor: float) -> None:
    score = _keyed(*((Place(TIP, point),) for point in points))
    assert Resizing.of(score, factor).score(score) == score


def _signer() -> Rig:
    from azee_rig.load import load_rig

    return load_rig("signer")


@pytest.mark.parametrize("name", SIGNS)
def test_size_one_is_the_sign(name: str) -> None:
    assert value(f"resize :{name} 1") == value(f":{name}")


# Length ---------------------------------------------------------------------------------------


lengths = st.integers(1, 400).map(lambda n: Fraction(n, 20))


@given(st.sampled_from(SIGNS), lengths)
def test_stretching_keeps_proportions(name: str, seconds: Fraction) -> None:
    plain, long = _score(f":{name}"), _score(f"stretch :{name} 'to {float(seconds)}")
    assert long.duration == seconds
    factor = seconds / plain.duration
    pairs = list(zip(leaves(plain), leaves(long), strict=True))
    assert pairs
    for before, after in pairs:
        assert after.interval.start == before.interval.start * factor
        assert after.interval.end == before.interval.end * factor


def test_stretching_by_a_factor_and_to_a_length_agree() -> None:
    long = _score("stretch :armoire 'by 2")
    assert long == _score(f"stretch :armoire 'to {float(long.duration)}")
    assert long.duration == 2 * _score(":armoire").duration
    assert _score("stretch :armoire 'by 1") == _score(":armoire")


def test_fixed_parts_keep_their_length() -> None:
    found = group("stretch (seq (list (fixed (blank 1)) (blank 1)) 'gap 0) 'to 3")
    assert times(found) == {"1": (0, 1), "2": (1, 3)}


@pytest.mark.parametrize(
    ("code", "expression"),
    [
        ("missing-argument", "stretch :bien"),
        ("missing-argument", "stretch :bien 'to 1 'by 1"),
        ("negative-duration", "stretch :bien 'to -1"),
        ("number-range", "stretch :bien 'by 0"),
        ("size-limit", "stretch :bien 'by 1000000"),
        ("cannot-stretch", "stretch (fixed (blank 1)) 'to 2"),
        ("cannot-stretch", "stretch (seq (list)) 'to 2"),
        ("number-range", "repeat :bien 0"),
        ("number-range", "repeat :bien 1.5"),
        ("number-range", "repeat :bien 1001"),
        ("number-range", "repeat :bien 2 'damping 1.5"),
        ("negative-duration", "repeat :bien 2 'gap -1"),
        ("number-range", "resize :bien -1"),
        ("number-range", "alternate :bien 2 'phase 2"),
        ("number-range", "alternate :bien 0"),
        ("unknown-morph", "alternate (key 1 (morph 'palm_l_closed 1)) 2"),
        ("unknown-block", "repeat (hold 'A 1) 2"),
        ("size-limit", "repeat (repeat (repeat :armoire 100) 100) 100"),
    ],
)
def test_changes_with_mistakes(code: str, expression: str) -> None:
    assert _code(expression) == [code]


@pytest.mark.parametrize(
    ("expression", "arm"),
    [
        ("place @I_TIP(s) ^Mssp", Side.STRONG),
        ("place @CK(L) ^Mssp", None),
        ("transpath @PA(w) straight", Side.WEAK),
        ("orient 'dir !palm(L) 'along ^up", Side.LEFT),
        ("orient 'dir !head 'along ^up", None),
        ("morph 'index_bend s 1", Side.STRONG),
        ("morph 'index_bend_R 1", Side.RIGHT),
        ("morph 'AU12 1", None),
        ("morph 'AU12_L 1", None),
        ("trill !eye(L) ^up", None),
        ("rotate !index(s, 2) ^up 10", Side.STRONG),
        ("look ^up", None),
        ("lookat ^Mssp", None),
    ],
)
def test_names_tell_which_arm_a_constraint_is_about(expression: str, arm: Side | None) -> None:
    assert arm_of(constraints(expression)[0]) is arm
