"""Hashes that are computed once an object: constraints are looked up again and again."""

from __future__ import annotations

from typing import TypeVar


class RemembersHash:
    """Has room for its hash, which is no field: copies and pickles do not take it along.

    Hashes of texts differ from process to process.
    """

    __slots__ = ("_hash",)


_Hashed = TypeVar("_Hashed", bound=RemembersHash)


def hash_once(kind: type[_Hashed]) -> type[_Hashed]:
    """Let the objects of a frozen dataclass remember their hash."""
    compute = kind.__hash__

    def remembered(self: _Hashed) -> int:
        try:
            found: int = self._hash  # type: ignore[attr-defined]
        except AttributeError:
            found = compute(self)
            object.__setattr__(self, "_hash", found)
        return found

    kind.__hash__ = remembered  # type: ignore[method-assign, assignment]
    return kind
