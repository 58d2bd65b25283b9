"""What operators on numbers, lists, decisions and operators give, and what names mean."""

from __future__ import annotations

import pytest
from evaluations import content, value

from azee.lang.constants import CONSTANTS
from azee.lang.values import Kind, ListValue, OperatorValue
from azee_solver.geometry import (
    Side,
)


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


def test_the_elements_of_a_list_stand_deeper_than_its_line() -> None:
    definitions = "def all\n    azop 'items 'nodefault 'gap .2 seq(^items, 'gap = ^gap)\n"
    in_lines = """:all
    'items list
        :info-about
            'topic :all
                'items list
                    :bien
                    :arbre
                        'loc ^Lssp
            'info :chat
        :mignon
    'gap .1
"""
    inner = "info-about(all(list(:bien, arbre(^Lssp))), :chat)"
    assert content(in_lines, definitions) == content(
        f"all(list({inner}, :mignon), .1)", definitions
    )


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
