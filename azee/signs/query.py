"""Questions to a database of signs, and the signs that answer them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from sqlalchemy import ColumnElement, Connection, Row, select

from azee.signs.sign import Identity, Sign, SignFacts, Timing, optional, written
from azee.signs.tables import SIGN, SKELETON, TAG

_LAST = "\U0010ffff"
_AT_ONCE = 500
"""Signs whose tags are asked for in one query."""


@dataclass(frozen=True, slots=True)
class Query:
    """Which signs are meant; what is None does not matter.

    prefix: how the name begins, letter by letter as it is stored. word: a prefix or a tag.
    skeleton: the digest of one.
    """

    name: str | None = None
    prefix: str | None = None
    tag: str | None = None
    word: str | None = None
    language: str | None = None
    variant: str | None = None
    kind: str | None = None
    skeleton: str | None = None

    def conditions(self) -> Iterable[ColumnElement[bool]]:
        """Yield what rows of the table of signs must fulfil; each uses an index."""
        if self.name is not None:
            yield SIGN.c.name == written(self.name, "the name of a sign")
        if self.prefix:
            yield _begins(self.prefix)
        if self.tag is not None:
            yield _tagged(self.tag)
        if self.word:
            # Two look-ups by index, united: with OR, SQLite would read all signs.
            begun = select(SIGN.c.id).where(_begins(self.word))
            tagged = select(TAG.c.sign).where(TAG.c.text == written(self.word, "a tag"))
            yield SIGN.c.id.in_(begun.union(tagged))
        for column in ("language", "variant"):
            value = getattr(self, column)
            if value is not None:
                yield SIGN.c[column] == optional(value, f"the {column} of a sign")
        if self.kind is not None:
            yield SIGN.c.kind == self.kind
        if self.skeleton is not None:
            yield SKELETON.c.digest == self.skeleton


ALL_SIGNS = Query()


def _begins(prefix: str) -> ColumnElement[bool]:
    """Whether a name begins with a text: a range of code points, which an index finds."""
    first = written(prefix, "the beginning of a name")
    return (SIGN.c.name >= first) & (SIGN.c.name <= first + _LAST)


def _tagged(tag: str) -> ColumnElement[bool]:
    return SIGN.c.id.in_(select(TAG.c.sign).where(TAG.c.text == written(tag, "a tag")))


def found_in(connection: Connection, conditions: Iterable[ColumnElement[bool]]) -> list[Sign]:
    """Return the signs that fulfil conditions, in the order of their names."""
    rows = connection.execute(
        select(SIGN, SKELETON.c.name.label("body"), SKELETON.c.digest.label("body_digest"))
        .join(SKELETON, SIGN.c.skeleton == SKELETON.c.id)
        .where(*conditions)
        .order_by(SIGN.c.name, SIGN.c.language, SIGN.c.variant, SIGN.c.id)
    ).all()
    tags: dict[int, list[str]] = {row.id: [] for row in rows}
    numbers = list(tags)
    for start in range(0, len(numbers), _AT_ONCE):
        part = numbers[start : start + _AT_ONCE]
        for number, text in connection.execute(select(TAG).where(TAG.c.sign.in_(part))):
            tags[number].append(text)
    return [_sign(row, tags[row.id]) for row in rows]


def _sign(row: Row[Any], tags: Iterable[str]) -> Sign:
    facts = SignFacts(
        Identity(row.name, row.language, row.variant),
        Timing(row.duration_s, row.frames, row.rate, row.attack_s, row.decay_s),
        row.kind,
        tuple(tags),
        row.licence,
        row.provenance,
        row.repositioned,
    )
    return Sign(row.id, facts, row.body, row.body_digest, row.digest)
