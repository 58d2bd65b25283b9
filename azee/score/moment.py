"""Refs: points in time named after the bounds of a block, such as `'SIG:start:-.25`."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction


class Bound(Enum):
    """One end of a block."""

    START = "start"
    END = "end"


@dataclass(frozen=True, slots=True)
class Moment:
    """A bound of a block, or a fraction of its length, and an offset in seconds.

    `path` leads to the block: its name, then names inside it (`'INFO/SIG:start`). A fraction of 0
    is the block's start and 1 its end, whatever its length.
    """

    path: tuple[str, ...]
    anchor: Bound | Fraction
    offset_s: Fraction = Fraction(0)

    def __str__(self) -> str:
        anchor = self.anchor.value if isinstance(self.anchor, Bound) else decimal(self.anchor)
        offset = f":{decimal(self.offset_s)}" if self.offset_s else ""
        return f"{'/'.join(self.path)}:{anchor}{offset}"


class MomentError(ValueError):
    """A ref with a wrong form; `str()` says why in the user's terms."""


_NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)")
_LONGEST = 17


def parse_moment(text: str) -> Moment:
    """Read `BLOCK:start`, `BLOCK:end:-.25`, `BLOCK:.5` or `INFO/SIG:start`.

    Raises: MomentError: the text has another form.
    """
    block, *parts = text.split(":")
    path = tuple(block.split("/"))
    if not all(path):
        raise MomentError(f"`'{text}` names no block")
    if not parts:
        raise MomentError(f"`'{text}` names a block but not when: add `:start` or `:end`")
    if len(parts) > 2:
        raise MomentError(f"`'{text}` has too many parts: a ref is `'BLOCK:start:offset`")
    return Moment(path, _anchor(parts[0], text), _number(parts[1]) if len(parts) == 2 else _ZERO)


_ZERO = Fraction(0)


def _anchor(word: str, text: str) -> Bound | Fraction:
    if word in ("start", "end"):
        return Bound(word)
    if _NUMBER.fullmatch(word):
        return _number(word)
    raise MomentError(
        f"`{word}` in `'{text}` is none of `start`, `end` and a fraction such as `.5`"
    )


def _number(word: str) -> Fraction:
    if not _NUMBER.fullmatch(word):
        raise MomentError(f"`{word}` is not a number")
    if sum(c.isdigit() for c in word) > _LONGEST:
        raise MomentError(f"`{word}` has more than {_LONGEST} digits")
    return Fraction(word.removesuffix("."))


def decimal(time: Fraction) -> str:
    """Write a number as AZee reads it, to the nanosecond."""
    text = f"{round(time * 10**9):+d}"
    sign, digits = text[0].replace("+", ""), text[1:].rjust(10, "0")
    return f"{sign}{digits[:-9]}.{digits[-9:]}".rstrip("0").rstrip(".")
