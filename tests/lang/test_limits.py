"""Texts that would go on or grow without end, or that are nested deep, and the limits they meet."""

from __future__ import annotations

import pytest
from evaluations import found, problems, program

from azee.lang import values
from azee.lang.machine import Limits

DOUBLING = """
def f
    azop 'n 0
        if
            lt ^n 30
            seq(list(f(add(^n, 1)), f(add(^n, 1))))
            blank .1
:f
"""
TRIPLING = """
def f
    azop 'n 0 seq(list(g(^n), g(^n), g(^n)))
def g
    azop 'n 0 seq(list(h(^n), h(^n), h(^n)))
def h
    azop 'n 0 blank(^n)
:f
"""
HOSTILE = {
    "a rule that applies itself": "def f\n    :f\n:f",
    "two rules that apply each other": "def f\n    :g\ndef g\n    seq(list(:f))\n:f",
    "a rule that doubles itself": DOUBLING,
    "names that double a value": "let 'a (list 1 1)\n    "
    + "\n    ".join("    " * k + "let 'a (list ^a ^a)" for k in range(40))
    + "\n    "
    + "    " * 40
    + "^a",
    "a large range": "seq(map(.nb-5, range(1, 99999999)))",
    "a large range of ranges": "seq(map(azop('x, 0, range(1, 100000)), range(1, 100000)))",
    "a fold that grows": "seq(fold(azop('a, 0, 'b, 0, list(^a, ^a)), 1, range(1, 100)))",
    "a chain of vectors": "key(1, look(fold(azop('a, 0, 'b, 0, oppvect(^a)), ^up, range(1, 999))))",
    "a default that applies its rule": "def f\n    azop 'x f() ^x\n:f",
    "an operator applied to itself": "let 'f azop('g, 0, apply(^g, ^g)) apply(^f, ^f)",
    "deep text": "blank " + "add(1, " * 300 + "1" + ")" * 300,
}
SLOW = {"a rule that doubles itself", "a large range of ranges"}
ENDS = {"recursion-limit", "step-limit", "size-limit"}


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=pytest.mark.slow) if name in SLOW else name for name in HOSTILE],
)
def test_a_hostile_text_ends_in_its_diagnostic(name: str) -> None:
    reported = problems(HOSTILE[name])
    assert reported
    assert {p.code for p in reported} <= ENDS


DEEP = {
    "let('x, 1, ": ")",
    "if(lt(1, 2), ": ", blank(1))",
    "sync('A, ": ")",
    "apply(azop('x, 1, ": "))",
    "nth(list(": "), 1)",
    "mirror(": ")",
    "nth(map(azop('x, 1, ": "), list(1)), 1)",
    "info-about(blank(1), ": ")",
    "fixed(seq(list(": ")))",
}
SLOW_DEPTHS = {("info-about(blank(1), ", times) for times in (150, 199)}


@pytest.mark.parametrize(
    ("opening", "times"),
    [
        pytest.param(opening, times, marks=[pytest.mark.slow] * ((opening, times) in SLOW_DEPTHS))
        for times in (40, 95, 150, 199, 400)
        for opening in DEEP
    ],
)
def test_deep_texts_are_evaluated_or_refused(opening: str, times: int) -> None:
    reported = found(opening * times + "blank(1)" + DEEP[opening] * times)
    codes = {entry.partition(" ")[0] for entry in reported}
    assert codes <= {"recursion-limit"}
    if times == 40:
        assert not codes


def test_a_deep_value_can_be_mirrored() -> None:
    opposite = "fold(azop('v, ^up, 'n, 0, oppvect(^v)), ^up, range(1, 195))"
    assert found(f"key(1, mirror(look({opposite})))") == []


def test_depth_is_that_of_nesting_not_of_length() -> None:
    assert found("seq map(azop('n, 0, blank(mul(^n, .01))), range(1, 500))") == []
    text = "let 'n 1 seq(list(" + ", ".join(["blank(add(^n, 1))"] * 500) + "))"
    assert found(text) == []


@pytest.mark.parametrize(
    "text",
    ["blank {}", "sync 'A (blank 0) 'B (blank 1) 'start/dur 'A:end {}"],
    ids=["alone", "block"],
)
def test_a_score_lasts_a_day_and_no_longer(text: str) -> None:
    assert found(text.format(86400)) == []
    (code,) = found(text.format("86400.1"))
    assert code.startswith("size-limit")


def test_steps_are_counted_and_limited() -> None:
    assert program(TRIPLING).check() == ()
    limited = program(TRIPLING, limits=Limits(steps=100))
    assert [p.code for p in limited.check()] == ["step-limit"]


def test_values_without_parts_are_one_deep_and_one_large() -> None:
    """So that the limits of depth and size count what people write."""
    kinds = [v for v in vars(values).values() if isinstance(getattr(v, "depth", None), int)]
    assert len(kinds) > 5
    assert {(kind.depth, kind.size) for kind in kinds} == {(1, 1)}
