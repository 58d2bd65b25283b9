"""Lines of AZee with their depth."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

from azee.lexicon.numbers import number

Line: TypeAlias = tuple[int, str]
"""How deep a line is indented, and its text."""
_WIDEST = 90
_INDENT = "    "


def joined_text(lines: Sequence[Line]) -> str:
    """Return lines as a text."""
    return "".join(f"{_INDENT * depth}{text}\n" for depth, text in lines)


def key_lines(length_s: float, constraints: Sequence[str]) -> list[Line]:
    """Return a `key` with constraints in force for some time."""
    if len(constraints) == 1:
        return [(0, f"key {number(length_s)} ({constraints[0]})")]
    return [
        (0, f"key {number(length_s)}"),
        (1, "cstr"),
        *((2, constraint) for constraint in constraints),
    ]


def block_lines(name: str, score: Sequence[Line], rule: str | None) -> list[Line]:
    """Return a block of a `sync`: its name, its score, and when it is."""
    first = score[0][1]
    lines: list[Line]
    if len(score) == 1 and len(first) < _WIDEST:
        lines = [(0, f"'{name} ({first})")]
    else:
        lines = [(0, f"'{name}"), *score]
    return lines if rule is None else [*lines, (0, rule)]
