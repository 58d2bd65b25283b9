"""Tokens, which words.py and layout.py make for the parser."""

from __future__ import annotations

from typing import NamedTuple

FORMS = {"RULE": ":", "REFERENCE": ".", "POSTURE": ":#"}
"""Token kinds that name a rule, with their sigils."""

HEADS = frozenset({*FORMS, "OPERATOR", "BONE", "SITE"})
"""Token kinds that take operands."""

BAD = "BAD"
"""Kind of a token in the place of something that has been reported; no grammar accepts it."""


class Token(NamedTuple):
    """A terminal of azee.lark, its place in the text, and its content.

    `text` is the name in NFC without its sigil, the digits of a number or the inside of a text
    literal; it is empty for layout and punctuation.
    """

    kind: str
    start: int
    end: int
    text: str = ""
