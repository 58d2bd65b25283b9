"""Short ways to evaluate texts, and to say what is wrong with them."""

from __future__ import annotations

from pathlib import Path

from any_recordings import AnyRecordings

from azee.lang.machine import DEFAULT_LIMITS, Limits
from azee.lang.program import Program, load
from azee.lang.values import ConstraintsValue, Value
from azee.score.score import Group, Score
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.source import Source
from azee_solver.constraint import Constraint

NAME = "text.azee"


def program(text: str, *libraries: Path, limits: Limits = DEFAULT_LIMITS) -> Program:
    return load(Source(NAME, text), libraries, limits, recordings=AnyRecordings())


def value(expression: str, definitions: str = "") -> Value:
    """What an expression evaluates to."""
    return program(definitions).value(expression)


def content(expression: str, definitions: str = "") -> object:
    """The content of the value of an expression."""
    return value(expression, definitions).content


def constraints(expression: str, definitions: str = "") -> tuple[Constraint, ...]:
    """The constraint set that an expression evaluates to."""
    found = value(expression, definitions)
    assert isinstance(found, ConstraintsValue)
    return found.content


def group(expression: str, definitions: str = "") -> Group:
    """The score with blocks that an expression evaluates to."""
    found = content(expression, definitions)
    assert isinstance(found, Group)
    return found


def times(found: Group) -> dict[str, tuple[float, float]]:
    """When each block starts and ends, by its name."""
    return {
        b.name: (float(b.interval_in_parent.start), float(b.interval_in_parent.end))
        for b in found.blocks
    }


def score(text: str) -> Score:
    """The score of a text of one utterance or more."""
    return program(text).score()


def problems(text: str, *libraries: Path) -> list[Diagnostic]:
    """All that is wrong with a text."""
    return list(program(text, *libraries).check())


def found(text: str, *libraries: Path) -> list[str]:
    """Codes and places of all that is wrong: `unknown-rule 1:3`."""
    return [place(problem) for problem in problems(text, *libraries)]


def place(problem: Diagnostic) -> str:
    if problem.span is None:
        return f"{problem.code} -"
    return f"{problem.code} {problem.span.line}:{problem.span.column}"
