"""Resolving step by step: deep texts need no deep stack.

Code of an expression is made by a generator that yields the expressions inside it, each with the
names it sees, and is sent their code. `run` keeps the generators that wait on a list.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from typing import Any, TypeAlias, TypeVar

from azee.lang.code import Code
from azee_grammar.syntax import Expr

Visible: TypeAlias = frozenset[str]
"""Parameters and local names that an expression sees."""

Request: TypeAlias = tuple[Expr, Visible]

T = TypeVar("T")
Steps: TypeAlias = Generator[Request, Code, T]


def run(steps: Steps[T], start: Callable[[Expr, Visible], Steps[Code]]) -> T:
    """Return what the steps return; `start` begins the steps of an expression they ask for."""
    waiting: list[Steps[Any]] = [steps]
    answer: Any = None  # what the last of them waits for; None begins it
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
