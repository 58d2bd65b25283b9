"""Texts: their letters, and texts made of others."""

from __future__ import annotations

import unicodedata
from collections.abc import Callable
from decimal import Decimal
from typing import Any

from azee.lang.machine import Machine
from azee.lang.native import Group, Native, Occurrence, Operand
from azee.lang.values import Kind, ListValue, TextValue, Value


def written(number: float) -> str:
    """Return a number as AZee writes it, without an exponent: `52`, `0.5`."""
    if number == int(number):
        return str(int(number))
    return format(Decimal(repr(number)), "f")


def letters_of(text: str) -> list[str]:
    """Return the letters of a text in order; one with its accents is one."""
    letters: list[str] = []
    for character in unicodedata.normalize("NFC", text):
        if letters and unicodedata.combining(character):
            letters[-1] += character
        else:
            letters.append(character)
    return letters


def _letters(at: Occurrence, machine: Machine, text: str) -> Value:
    letters = letters_of(text)
    machine.spend(len(letters), at.span)
    machine.require_size(len(letters) + 1, at.span)
    return ListValue(tuple(map(TextValue, letters)), len(letters) + 1, 2)


def _lower(at: Occurrence, machine: Machine, text: str) -> str:
    return _counted(at, machine, text.lower())


def _upper(at: Occurrence, machine: Machine, text: str) -> str:
    return _counted(at, machine, text.upper())


def _unaccented(at: Occurrence, machine: Machine, text: str) -> str:
    apart = unicodedata.normalize("NFD", text)
    plain = "".join(c for c in apart if not unicodedata.combining(c))
    return _counted(at, machine, unicodedata.normalize("NFC", plain))


def _concat(at: Occurrence, machine: Machine, parts: tuple[str | float, ...]) -> str:
    texts = [written(part) if isinstance(part, float) else part for part in parts]
    machine.spend(sum(map(len, texts)), at.span)
    return unicodedata.normalize("NFC", "".join(texts))


def _counted(at: Occurrence, machine: Machine, text: str) -> str:
    """Count a step a character, so that all texts of an utterance together stay bounded."""
    machine.spend(len(text), at.span)
    return text


_TEXT = Operand("text", "a text", (Kind.TEXT,))


def _native(
    name: str,
    meaning: str,
    result: Kind,
    function: Callable[..., Any],
    example: str,
    operand: Operand = _TEXT,
    *,
    whole: bool = False,
) -> Native:
    return Native(
        name,
        Group.TEXTS,
        meaning,
        (operand,),
        result=result,
        function=function,
        example=example,
        uses_machine=True,
        whole=whole,
    )


OPERATORS = (
    _native(
        "letters",
        "The letters of a text in order, each a text: a letter with its accents is one. Spaces "
        "and signs count too.",
        Kind.LIST,
        _letters,
        'letters "BAGDAD"',
        whole=True,
    ),
    _native("lower", "The text in small letters.", Kind.TEXT, _lower, 'lower "Bagdad"'),
    _native("upper", "The text in capital letters.", Kind.TEXT, _upper, 'upper "Bagdad"'),
    _native(
        "unaccented",
        "The text without accents and other marks on its letters.",
        Kind.TEXT,
        _unaccented,
        'unaccented "Orléans"',
    ),
    _native(
        "concat",
        "One text made of texts, symbols and numbers.",
        Kind.TEXT,
        _concat,
        'concat "nb-" 5',
        Operand(
            "part",
            "what the text is made of",
            (Kind.TEXT, Kind.NUMBER, Kind.SYMBOL),
            rest=True,
            least=1,
        ),
    ),
)
