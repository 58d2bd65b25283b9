"""Which rules of a text name the shape that a hand has."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.lang.program import Program, load
from azee.lang.values import ConstraintsValue
from azee.posing.handshapes import shape_names
from azee_grammar.source import Source
from azee_rig.rig import Rig
from azee_solver.evaluate import Evaluator, evaluator
from azee_solver.geometry import Side

TEXT = """\
def plain-fist
    azop
        'side
        ^s
        :#fist('side = ^side)
def smiling-fist
    azop
        'side
        ^s
        cstr
            :#fist('side = ^side)
            morph 'AU12 .5
"""


def posture(
    program: Program, body: Evaluator, rule: str, off_deg: float = 0.0
) -> NDArray[np.float64]:
    """The idle body with a hand as a rule has it, each of its joints off by an angle."""
    limits = body.rig.coordinates
    value = program.value(rule)
    assert isinstance(value, ConstraintsValue)
    asked = body.binding.presets(value.content)
    q = np.array(limits.idle)
    q[[*asked]] = [*asked.values()]
    q = np.clip(q, limits.lower, limits.upper)
    q[[*asked]] += np.radians(off_deg)
    return q


def test_a_rule_that_also_moves_the_face_is_no_shape_of_a_hand(signer: Rig) -> None:
    program, body = load(Source("text.azee", TEXT)), evaluator(signer, Side.RIGHT)
    assert not program.check()
    q = posture(program, body, ":#plain-fist")
    found = [shape.text for shape in shape_names(program, body, q, Side.STRONG)]
    assert {":#fist", ":#plain-fist"} <= {*found}
    assert ":#smiling-fist" not in found


def test_a_rule_that_also_moves_the_shoulder_or_the_other_hand_is_no_shape_of_a_hand(
    signer: Rig,
) -> None:
    text = ""
    for name, also in (
        ("one-fist", "morph 'fingers_spread ^side 0"),
        ("shrugging-fist", "morph 'shoulder_raise ^side .2"),
        ("two-fists", ":#fist('side = w)"),
    ):
        text += f"def {name}\n    azop\n        'side\n        ^s\n        cstr\n"
        text += f"            :#fist('side = ^side)\n            {also}\n"
    program, body = load(Source("text.azee", text)), evaluator(signer, Side.RIGHT)
    for name, named in (("one-fist", True), ("shrugging-fist", False), ("two-fists", False)):
        q = posture(program, body, f":#{name}")
        found = [shape.text for shape in shape_names(program, body, q, Side.STRONG)]
        assert (f":#{name}" in found) == named


@pytest.mark.parametrize(
    ("also", "named"),
    [
        ("place @T_PAD(^side) @I_BACK(^side, 2) 'contact", True),
        ("place @PA(^side) @CH", False),
        ("orient 'dir !thumb(^side, 3) 'along dir(!palm(^side))", True),
        ("orient 'dir !palm(^side) 'along ^up", False),
        ("look ^fwd", False),
        ("trill !palm(^side) ^up", False),
    ],
)
def test_a_shape_may_say_where_digits_are_but_not_where_the_hand_is(
    signer: Rig, also: str, named: bool
) -> None:
    text = (
        "def held\n    azop\n        'side\n        ^s\n        cstr\n"
        f"            :#fist('side = ^side)\n            {also}\n"
    )
    program, body = load(Source("text.azee", text)), evaluator(signer, Side.RIGHT)
    q = posture(program, body, ":#held")
    found = [shape.text for shape in shape_names(program, body, q, Side.STRONG)]
    assert (":#held" in found) == named


@pytest.mark.parametrize(("off_deg", "named"), [(0.0, True), (24.9, True), (25.1, False)])
def test_a_shape_is_named_if_it_is_within_25_degrees(
    signer: Rig, off_deg: float, named: bool
) -> None:
    program, body = load(Source("text.azee", "")), evaluator(signer, Side.RIGHT)
    q = posture(program, body, ":#fist", off_deg)
    found = {shape.text: shape for shape in shape_names(program, body, q, Side.STRONG)}
    assert (":#fist" in found) == named
    if named:
        assert np.degrees(found[":#fist"].off_rad) == pytest.approx(off_deg, abs=1e-6)


def test_the_nearest_shape_comes_first(signer: Rig) -> None:
    program, body = load(Source("text.azee", TEXT)), evaluator(signer, Side.RIGHT)
    q = posture(program, body, ":#flat-hand", 8.0)
    off = [shape.off_rad for shape in shape_names(program, body, q, Side.STRONG)]
    assert off == sorted(off)
    assert len({*off}) > 2


@pytest.mark.parametrize(("off_deg", "cost"), [(8.0, 1.0), (16.0, 4.0)])
def test_a_shape_costs_the_square_of_how_far_it_is_in_units_of_8_degrees(
    signer: Rig, off_deg: float, cost: float
) -> None:
    program, body = load(Source("text.azee", "")), evaluator(signer, Side.RIGHT)
    q = posture(program, body, ":#fist", off_deg)
    (fist,) = (s for s in shape_names(program, body, q, Side.STRONG) if s.text == ":#fist")
    assert fist.cost == pytest.approx(cost)


def test_the_shape_of_the_weak_hand_is_told_with_its_side(signer: Rig) -> None:
    program, body = load(Source("text.azee", "")), evaluator(signer, Side.RIGHT)
    q = posture(program, body, ":#fist('side = w)")
    weak, strong = (shape_names(program, body, q, side) for side in (Side.WEAK, Side.STRONG))
    assert weak[0].text == ":#fist('side = w)"
    assert weak[0].off_rad == pytest.approx(0.0, abs=1e-9)
    assert all(shape.off_rad > 0.01 for shape in strong)


def test_a_shape_says_where_ten_joints_of_the_hand_are(signer: Rig) -> None:
    """Three closed fingers are nine joints, and the knuckle of the fourth is one more."""
    nine = ["I_closed", "M_closed", "R_closed"]
    text = ""
    for name, morphs in (("nine", nine), ("ten", [*nine, "little_bend"])):
        asked = "".join(f"            morph '{morph} ^side 1\n" for morph in morphs)
        text += f"def {name}\n    azop\n        'side\n        ^s\n        cstr\n{asked}"
    program, body = load(Source("text.azee", text)), evaluator(signer, Side.RIGHT)
    q = posture(program, body, ":#ten")
    found = [shape.text for shape in shape_names(program, body, q, Side.STRONG)]
    assert ":#ten" in found
    assert ":#nine" not in found


def test_a_rule_that_must_be_told_something_is_no_shape(signer: Rig) -> None:
    """Be it its side, which a rule that shapes a hand has of its own."""
    text = ""
    for name, default in (("told", "'nodefault"), ("untold", "^s")):
        text += (
            f"def {name}\n    azop\n        'side\n        {default}\n        'apart\n        0\n"
        )
        text += "        cstr\n            :#fist('side = ^side)\n"
        text += "            morph 'fingers_spread ^side ^apart\n"
    program, body = load(Source("text.azee", text)), evaluator(signer, Side.RIGHT)
    q = posture(program, body, ":#told('side = w)")
    found = [shape.text for shape in shape_names(program, body, q, Side.WEAK)]
    assert ":#untold('side = w)" in found
    assert ":#told('side = w)" not in found


def test_a_name_of_two_libraries_is_left_out_and_those_after_it_are_not(
    signer: Rig, tmp_path: Path
) -> None:
    rule = "def {}\n    azop\n        'side\n        ^s\n        :#fist('side = ^side)\n"
    for library, names in {"one": ["same"], "other": ["same", "own"]}.items():
        (tmp_path / library).mkdir()
        text = "use 'core\n" + "".join(rule.format(name) for name in names)
        (tmp_path / library / "all.azee").write_text(text, encoding="utf-8")
    program = load(Source("text.azee", "use 'one\nuse 'other\n"), [tmp_path])
    body = evaluator(signer, Side.RIGHT)
    q = posture(program, body, ":#own")
    found = [shape.text for shape in shape_names(program, body, q, Side.STRONG)]
    assert ":#own" in found
    assert ":#fist" in found
    assert ":#same" not in found
