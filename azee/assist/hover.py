"""Describes the word at a place."""

from __future__ import annotations

from dataclasses import dataclass

from azee.assist import description
from azee.assist.completion import visible_locals
from azee.assist.description import Description, What
from azee.assist.expected import expected
from azee.assist.knowledge import Knowledge
from azee.assist.place import Place, place


@dataclass(frozen=True, slots=True)
class Hover:
    """A description of the word in `[start, end)`."""

    start: int
    end: int
    described: Description


def hover(text: str, offset: int, knowledge: Knowledge) -> Hover | None:
    """Describe the word at an offset, that is, inside it, at its beginning or right behind it."""
    where = place(text, offset)
    if where.token is None and offset < len(text):
        where = place(text, offset + 1)
    token = where.token
    if token is None or where.silent:
        return None
    whole = place(text, token.end)
    found = _meaning(whole, knowledge)
    return Hover(token.start, token.end, found) if found else None


def _meaning(where: Place, knowledge: Knowledge) -> Description | None:
    token = where.token
    assert token is not None
    match token.kind:
        case "RULE" | "REFERENCE" | "POSTURE" | "NAME":
            found = knowledge.rule(token.text)
            return description.rule(found, knowledge) if found else None
        case "OPERATOR":
            return next(iter(description.describe(token.text, knowledge)), None)
        case "DEF" | "USE":
            return next(iter(description.describe(where.word, knowledge)), None)
        case "BONE":
            return description.bone(token.text)
        case "SITE":
            return description.site(token.text)
        case "SIDE":
            return description.side(token.text)
        case "PARAMETER":
            named = (d for d in visible_locals(where, knowledge) if d.title == f"^{token.text}")
            return next(named, None) or description.constant(token.text)
        case "SYMBOL":
            return _symbol(where, token.text, knowledge)
        case _:
            return None


def _symbol(where: Place, name: str, knowledge: Knowledge) -> Description | None:
    for described in expected(where, knowledge).symbols:
        if described.title == f"'{name}":
            return described
    head = where.frame.head
    if head is not None and head.text == "morph":
        return description.morph(name)
    if head is not None and head.text == "sync":
        return Description(What.BLOCK, f"'{name}", f"'{name}", "a block of this sync")
    return None
