"""What every native operator gives for its operands."""

from __future__ import annotations

import ast
import math
import re
from fractions import Fraction
from pathlib import Path

import pytest
from evaluations import constraints, content, group, times, value

from azee.lang.constants import CONSTANTS
from azee.lang.registry import NATIVES
from azee.lang.values import Kind, ListValue, OperatorValue, SymbolValue
from azee.score.score import Blank, Hold, Key
from azee_grammar.diagnostic import AZeeError
from azee_solver.constraint import (
    BoneAxis,
    Look,
    LookAt,
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
    assert [n.name for n in NATIVES.values() if not n.example] == ["def", "use"]


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
        ("turning 'dir !palm(s)", Orient(BoneAxis.DIR, PALM, Relation.ALONG, Swing(None, None))),
        (
            "shift @I_TIP(s) ^up 'from 'A 'within .1",
            Place(TIP, VTranslate(Was("A", SitePoint(TIP)), UP), within_m=0.1),
        ),
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


# Numbers, lists, decisions --------------------------------------------------------------------


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("add 1 2 .5", 3.5),
        ("sub 1 .25", 0.75),
        ("mul 2 3 4", 24.0),
        ("div 1 4", 0.25),
        ("neg 2", -2.0),
        ("count (list 'a 'b)", 2.0),
        ("count (list)", 0.0),
        ("nth (list 1 'b) 2", "b"),
        ("eq 1 1.0", True),
        ("eq 'a 'b", False),
        ('eq \'a "a"', False),
        ("eq s s", True),
        ("eq s w", False),
        ("eq L R", False),
        ("eq 1 ^up", False),
        ("eq (lt 1 2) (lt 2 3)", True),
        ("lt 1 1", False),
        ("le 1 1", True),
        ("not (lt 1 1)", True),
        ("and (lt 1 2) (lt 2 1)", False),
        ("or (lt 2 1) (lt 1 2)", True),
        ("if (lt 1 2) 'a 'b", "a"),
        ("if (lt 2 1) 'a 'b", "b"),
        ("let 'x 1 (add ^x ^x)", 2.0),
        ("let 'x 1 (let 'x 2 ^x)", 2.0),
        ("opposite s", Side.WEAK),
        ("opposite R", Side.LEFT),
        ("opposite ^w", Side.STRONG),
    ],
)
def test_numbers_lists_and_decisions(expression: str, expected: object) -> None:
    assert content(expression) == expected


@pytest.mark.parametrize(
    "expression",
    [
        "if (lt 1 2) 1 div(1, 0)",
        "and (lt 2 1) (lt 1 div(1, 0))",
        "or (lt 1 2) (lt 1 div(1, 0))",
        "if (lt 2 1) nth(list(), 1) 1",
    ],
)
def test_what_is_not_needed_is_not_evaluated(expression: str) -> None:
    value(expression)


def _numbers(found: object) -> list[object]:
    assert isinstance(found, ListValue)
    return [element.content for element in found.content]


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("list 1 'a 2", [1.0, "a", 2.0]),
        ("range 1 3", [1.0, 2.0, 3.0]),
        ("range .5 2", [0.5, 1.5]),
        ("range 3 1", []),
        ("map .double (range 1 3)", [2.0, 4.0, 6.0]),
        ("map .plus('y = 10) (list 1 2)", [11.0, 12.0]),
        ("map (azop 'x 'nodefault (neg ^x)) (list 1 2)", [-1.0, -2.0]),
        ("let 'k 3 (map (azop 'x 0 (mul ^x ^k)) (list 1 2))", [3.0, 6.0]),
    ],
)
def test_lists(expression: str, expected: list[object]) -> None:
    definitions = (
        "def double\n    azop 'x 'nodefault mul(^x, 2)\n"
        "def plus\n    azop 'x 'nodefault 'y 'nodefault add(^x, ^y)\n"
    )
    assert _numbers(value(expression, definitions)) == expected


def test_fold_goes_from_the_left() -> None:
    definitions = "def minus\n    azop 'a 'nodefault 'b 'nodefault sub(^a, ^b)\n"
    assert content("fold .minus 10 (list 1 2 3)", definitions) == 4
    assert content("fold .minus 10 (list)", definitions) == 10


def test_operators_are_values() -> None:
    definitions = (
        "def pair\n    azop 'a 'nodefault 'b 7 list(^a, ^b)\n"
        "def twice\n    azop 'f 'nodefault 'x 'nodefault apply(^f, apply(^f, ^x))\n"
        "def half\n    azop 'x 'nodefault div(^x, 2)\n"
    )
    assert value(".pair", definitions).kind is Kind.OPERATOR
    assert _numbers(value("apply .pair 'a 1", definitions)) == [1, 7]
    assert _numbers(value("apply (.pair 'b 2) 'a 1", definitions)) == [1, 2]
    assert _numbers(value("apply(.pair(1), 2)", definitions)) == [1, 2]
    assert content(":twice 'f .half 'x 8", definitions) == 2
    assert content("let 'f azop('x, 1, ^x) (apply ^f)", definitions) == 1
    found = value(".pair 'b 2", definitions)
    assert isinstance(found, OperatorValue)
    assert set(found.content.bound) == {"b"}


def test_defaults_are_evaluated_at_the_call_and_see_what_stands_before() -> None:
    definitions = "def f\n    azop 'a 1 'b add(^a, 1) 'c mul(^b, 2) list(^a, ^b, ^c)\n"
    assert _numbers(value(":f", definitions)) == [1, 2, 4]
    assert _numbers(value(":f 'a 5", definitions)) == [5, 6, 12]
    assert _numbers(value(":f 'b 0", definitions)) == [1, 0, 0]


def test_a_parameter_shadows_a_constant() -> None:
    assert content(":f 's L", "def f\n    azop 's R opposite(^s)\n") is Side.RIGHT


def test_a_closure_keeps_the_names_around_it() -> None:
    definitions = "def adder\n    azop 'n 'nodefault azop('x, 'nodefault, add(^x, ^n))\n"
    assert content("let 'n 100 apply(:adder('n = 1), 5)", definitions) == 6


@pytest.mark.parametrize("name", sorted(CONSTANTS))
def test_constants_are_visible_everywhere(name: str) -> None:
    assert value(f"^{name}") == CONSTANTS[name].value


# Scores ---------------------------------------------------------------------------------------


def test_durations_are_the_decimals_as_written() -> None:
    key = content("key .1 (look ^fwd)")
    assert isinstance(key, Key)
    assert key.duration == Fraction(1, 10)
    assert content("blank .3") == Blank(Fraction(3, 10))
    assert content("blank 0") == Blank(Fraction(0))
    assert content("blank add(.5, .25)") == Blank(Fraction(3, 4))


def test_hold_names_a_block_or_holds_a_score() -> None:
    assert content("hold 'A .1") == Hold(Fraction(1, 10), block="A", channels=("hands",))
    assert content("hold 'A .1 'only (list 'face 'head)") == Hold(
        Fraction(1, 10), block="A", channels=("face", "head")
    )
    held = group("hold (blank 1) .5 'only 'trunk")
    assert held.duration == Fraction(3, 2)
    assert held.block("HOLD").score == Hold(Fraction(1, 2), block="SIG", channels=("trunk",))


def test_seq_puts_one_after_the_other() -> None:
    assert times(group("seq (list (blank 1) (blank 2))")) == {"1": (0, 1), "2": (1.2, 3.2)}
    assert group("seq (list (blank 1) (blank 2)) 'gap 0").duration == 3
    assert group("seq (list) 'gap 1").duration == 0


def test_fixed_marks_a_score() -> None:
    assert content("fixed (blank 1)") == Blank(Fraction(1), fixed=True)


@pytest.mark.parametrize(
    ("expression", "text"),
    [
        ("ref 'SIG 'end", "SIG:end"),
        ("ref 'SIG 'start -.25", "SIG:start:-0.25"),
        ("ref('INFO/SIG, .5, add(.1, .2))", "INFO/SIG:0.5:0.30000000000000004"),
        ("ref 'SIG 'end .0000001", "SIG:end:0.0000001"),
    ],
)
def test_refs_can_be_computed(expression: str, text: str) -> None:
    assert value(expression) == SymbolValue(text)


def test_a_sync_with_all_its_rules() -> None:
    found = group(
        """sync
    'SIG (blank 2)
    'A (blank 1)
    'start/end 'SIG:start:.5 'SIG:end:-.25
    'B (blank 1)
    'start ref('SIG, 'end, .1)
    'C (blank 1)
    'end 'SIG:.5
    'D (blank 1)
    'start/dur 'SIG:start .25
    'E (blank 1)
    'end/dur 'SIG:end .25
    'F (blank 1)
    'with 'SIG
"""
    )
    assert times(found) == {
        "SIG": (0, 2),
        "A": (0.5, 1.75),
        "B": (2.1, 3.1),
        "C": (0, 1),
        "D": (0, 0.25),
        "E": (1.75, 2),
        "F": (0, 2),
    }


def test_a_score_knows_the_rules_it_came_from() -> None:
    key = content("tree()")
    assert isinstance(key, Key)
    assert [call.rule for call in key.calls] == ["tree", "arbre"]
    outer, inner = (call.origin for call in key.calls)
    assert outer == Origin("<expression>", 1, 1, None)
    assert inner is not None
    assert (inner.file, inner.rule) == ("lsf/arbre.azee", "tree")


def test_an_expression_with_a_mistake_has_no_value() -> None:
    with pytest.raises(AZeeError):
        value("vec 1 2")
