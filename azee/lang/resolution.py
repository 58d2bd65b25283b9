"""Resolves step by step, so that deep texts need no deep stack.

A generator makes the code of an expression. It yields the inner expressions, each with the names
visible to it, and is sent their code. `run` keeps the waiting generators on a list.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from typing import Any, TypeAlias, TypeVar

from azee.lang.code import Code
from azee_grammar.syntax import Expr

Visible: TypeAlias = frozenset[str]
"""Parameters and local names that are visible to an expression."""

Request: TypeAlias = tuple[Expr, Visible]

T = TypeVar("T")
Steps: TypeAlias = Generator[Request, Code, T]


def run(steps: Steps[T], start: Callable[[Expr, Visible], Steps[Code]]) -> T:
    """Return the result of the steps; `start` begins the steps of an inner expression."""
    waiting: list[Steps[Any]] = [steps]
    answer: Any = None  # the result for which the last of them waits; None begins it
    while waiting:
        try:
            request = waiting[-1].send(answer)
        except StopIteration as done:
            waiting.pop()
            answer = done.value
        else:
            waiting.append(start(*request))
            answer = None
    result: T = answer
    return result
