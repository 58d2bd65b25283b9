"""What every native operator gives for its operands."""

from __future__ import annotations

import ast
import math
import re
from pathlib import Path

import pytest
from evaluations import constraints, content, value

from azee.lang.registry import NATIVES
from azee_grammar.diagnostic import AZeeError
from azee_solver.constraint import (
    BoneAxis,
    Look,
    LookAt,
    Manner,
    Morph,
    Orient,
    Origin,
    Place,
    Relation,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.geometry import (
    Arc,
    Around,
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
    Rotated,
    Scale,
    Side,
    SigningSpace,
    Site,
    SitePoint,
    Slide,
    Straight,
    Swing,
    Through,
    Towards,
    Unit,
    VDiff,
    Vec,
    VSum,
    VTranslate,
    Was,
    Wave,
    Zigzag,
)

UP, FWD = Vec(0, 1, 0), Vec(0, 0, 1)
PALM = Bone("palm", Side.STRONG)
TIP = Site("I_TIP", Side.STRONG)
MSSP = NamedPoint(SigningSpace.MSSP)
RSSP = NamedPoint(SigningSpace.RSSP)


@pytest.mark.parametrize("name", [n.name for n in NATIVES.values() if n.example])
def test_the_example_of_the_manual_evaluates_to_the_declared_kind(name: str) -> None:
    native = NATIVES[name]
    found = value(native.example)
    assert native.result in (None, found.kind)


def test_every_operator_but_the_items_of_a_file_has_an_example() -> None:
    assert [n.name for n in NATIVES.values() if not n.example] == ["def", "use", "places"]


def test_every_operator_is_in_an_expression_of_these_tests() -> None:
    """Its example only tells the kind: that it gives the right value takes a test of its own."""
    words: set[str] = set()
    for path in Path(__file__).parent.glob("*.py"):
        nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
        prose = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
        for node in nodes:
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                words |= set() if id(node) in prose else {*re.findall(r"[\w/-]+", node.value)}
    assert NATIVES.keys() - words == set()


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("vec 1 -.5 0", Vec(1, -0.5, 0)),
        ("dir !palm(s)", Dir(PALM)),
        ("nrm !palm(s)", Nrm(PALM)),
        ("oppvect ^up", Opp(UP)),
        ("out w", Out(Side.WEAK)),
        ("in L", Opp(Out(Side.LEFT))),
        ("unit ^up", Unit(UP)),
        ("scale ^up .1", Scale(UP, 0.1)),
        ("vsum ^up ^fwd ^up", VSum((UP, FWD, UP))),
        ("vdiff ^up ^fwd", VDiff(UP, FWD)),
        ("cross ^up ^fwd", Cross(UP, FWD)),
        ("towards @I_TIP(s) ^Mssp", Towards(SitePoint(TIP), MSSP)),
        ("rotated ^up ^fwd 90", Rotated(UP, FWD, math.pi / 2)),
        ("swing ^up ^fwd", Swing(UP, FWD)),
        ("was 'A @I_TIP(s)", Was("A", SitePoint(TIP))),
        ("point 0 -.2 .3", FreePoint(0, -0.2, 0.3)),
        ("vtranslate ^Mssp ^up", VTranslate(MSSP, UP)),
        ("between ^Mssp ^Rssp .25", Between(MSSP, RSSP, 0.25)),
        ("midpoint ^Mssp ^Rssp", Between(MSSP, RSSP, 0.5)),
        ("joint !palm(s)", JointPoint(PALM)),
        ("moving straight ^Mssp ^Rssp", Moving(Straight(), MSSP, RSSP)),
        ("straight", Straight()),
        ("arc ^up", Arc(UP)),
        ("arc-vect ^up", Arc(UP)),
        ("circle ^fwd .05 2", Circle(FWD, 0.05, 2)),
        ("circle ^fwd .05", Circle(FWD, 0.05, 1)),
        ("circle ^fwd .05 'phase 90 'ratio .5", Circle(FWD, 0.05, 1, math.pi / 2, 0.5)),
        ("spiral ^fwd .02 .08 3", Circle(FWD, 0.02, 3, end_radius_m=0.08)),
        ("around ^Mssp ^fwd", Around(MSSP, FWD, 1)),
        ("around ^Mssp ^fwd -.5", Around(MSSP, FWD, -0.5)),
        ("wave ^up 2", Wave(UP, 2)),
        ("zigzag ^up", Zigzag(UP, 2)),
        ("zigzag ^up 5", Zigzag(UP, 5)),
        ("slide !palm(s)", Slide(PALM, Straight())),
        ("slide !palm(s) (arc ^up)", Slide(PALM, Arc(UP))),
        ("through ^Rssp @I_TIP(s)", Through((RSSP, SitePoint(TIP)))),
        ("through (list ^Rssp @I_TIP(s)) ^Mssp", Through((RSSP, SitePoint(TIP), MSSP))),
    ],
)
def test_geometry_stays_symbolic(expression: str, expected: object) -> None:
    assert content(expression) == expected


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("!head", Bone("head")),
        ("!palm L", Bone("palm", Side.LEFT)),
        ("!index s 2", Bone("index", Side.STRONG, 2)),
        ("!back_1", Bone("back_1")),
        ("@FH", Site("FH")),
        ("@FH R", Site("FH", Side.RIGHT)),
        ("@I_BACK w 2", Site("I_BACK", Side.WEAK, 2)),
        ("@viande(w)", Site("viande", Side.WEAK)),
    ],
)
def test_bones_and_sites_take_side_and_phalanx(expression: str, expected: object) -> None:
    assert content(expression) == expected


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("place @I_TIP(s) ^Mssp", Place(TIP, MSSP)),
        ("place @I_TIP(s) @CH 'dist .02", Place(TIP, SitePoint(Site("CH")), 0.02)),
        ("place(@I_TIP(s), ^Mssp, 'contact)", Place(TIP, MSSP, 0.0, True)),
        ("place(@I_TIP(s), ^Mssp, 'contact, 'dist = 1)", Place(TIP, MSSP, 1.0, True)),
        (
            "orient 'dir !palm(s) 'along ^up",
            Orient(BoneAxis.DIR, PALM, Relation.ALONG, UP),
        ),
        (
            "orient 'nrm !palm(s) 'across ^up",
            Orient(BoneAxis.NRM, PALM, Relation.ACROSS, UP),
        ),
        ("place @I_TIP(s) ^Mssp 'within .03", Place(TIP, MSSP, within_m=0.03)),
        (
            "orient 'nrm !palm(s) 'along ^up 'within 45",
            Orient(BoneAxis.NRM, PALM, Relation.ALONG, UP, math.pi / 4),
        ),
        (
            "transpath @I_TIP(s) straight 'manner 'slow-start",
            Transpath(TIP, Straight(), Manner.SLOW_START),
        ),
        ("turning 'dir !palm(s)", Orient(BoneAxis.DIR, PALM, Relation.ALONG, Swing(None, None))),
        (
            "shift @I_TIP(s) ^up 'from 'A 'within .1",
            Place(TIP, VTranslate(Was("A", SitePoint(TIP)), UP), within_m=0.1),
        ),
        ("morph 'index_bend s 1 'soft 0", Morph("index_bend", Side.STRONG, 1.0)),
        ("morph 'index_bend s 1 'soft", Morph("index_bend", Side.STRONG, 1.0, math.radians(40))),
        (
            "morph 'index_bend s 1 'soft 90",
            Morph("index_bend", Side.STRONG, 1.0, math.pi / 2),
        ),
        ("look ^fwd", Look(FWD)),
        ("lookat @I_TIP(s)", LookAt(SitePoint(TIP))),
        ("trill !palm(s) ^up", Trill(PALM, UP, 5.0, math.radians(12))),
        ("trill !palm(s) ^up s", Trill(PALM, UP, 5.0, math.radians(12))),
        (
            "trill !palm(s) ^up 'amp 30 'back 0 'phase 90 'cycles 2",
            Trill(PALM, UP, 5.0, math.pi / 6, 0.0, math.pi / 2, 2.0),
        ),
        (
            "trill !palm(s) ^up 'amp 90 'freq 6",
            Trill(PALM, UP, 6.0, math.pi / 2),
        ),
        ("rotate !head ^up 180", Rotate(Bone("head"), UP, math.pi)),
        ("transpath @I_TIP(s) straight", Transpath(TIP, Straight())),
        ("morph 'AU12 -.4", Morph("AU12", None, -0.4)),
        ("morph 'index_bend s 1", Morph("index_bend", Side.STRONG, 1.0)),
        ("morph 'index_bend_R 1", Morph("index_bend_R", None, 1.0)),
    ],
)
def test_a_constraint_is_a_set_of_one(expression: str, expected: object) -> None:
    assert content(expression) == (expected,)


def test_morphs_repeat_in_one_application() -> None:
    assert content("morph 'AU12 .5 'little_closed s 1 'AU12_L 0") == (
        Morph("AU12", None, 0.5),
        Morph("little_closed", Side.STRONG, 1.0),
        Morph("AU12_L", None, 0.0),
    )


def test_sets_and_lists_are_flattened() -> None:
    text = "cstr (look ^up) (cstr (look ^fwd)) (list (look ^up) (list (morph 'AU1 1 'AU2 1)))"
    assert content(text) == (
        Look(UP),
        Look(FWD),
        Look(UP),
        Morph("AU1", None, 1.0),
        Morph("AU2", None, 1.0),
    )
    assert content("cstr") == ()


def test_a_constraint_knows_where_it_was_written() -> None:
    found = constraints("cstr :#smiling", "def smiling\n    morph 'AU12 1\n")
    assert found[0].origin == Origin("text.azee", 2, 5, "smiling")
    assert constraints("\n  look ^up")[0].origin == Origin("<expression>", 2, 3, None)


def test_an_expression_with_a_mistake_has_no_value() -> None:
    with pytest.raises(AZeeError):
        value("vec 1 2")
