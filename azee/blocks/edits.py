"""Edits of blocks, as data that can be sent as JSON.

Paths and rows are those of the text before the edit, as `tree` explains them. `text` is AZee as an
author writes it; it may have comments.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, TypeAlias, get_args

from azee.blocks.tree import Path


@dataclass(frozen=True, slots=True)
class Replace:
    """Put another expression in the place of one; at the margin, one item in that of another."""

    path: Path
    text: str


@dataclass(frozen=True, slots=True)
class Insert:
    """Insert rows of operands, such as an element of a list or a block of a `sync`, before a row.

    row: how many rows stay before it. With the path `()` the text has items, such as a definition.
    """

    path: Path
    row: int
    text: str


@dataclass(frozen=True, slots=True)
class Delete:
    """Take a row of operands away; with the path `()`, an item."""

    path: Path
    row: int


@dataclass(frozen=True, slots=True)
class Move:
    """Take a row away and insert it elsewhere.

    to_path, to_row: where it is inserted, counted before it is taken away.
    """

    path: Path
    row: int
    to_path: Path
    to_row: int


@dataclass(frozen=True, slots=True)
class Rename:
    """Give a rule, an operator, a bone, a site, a symbol or a definition another name here.

    name: without its sigil. slot: rename the symbol that names the operand, not the operand.
    """

    path: Path
    name: str
    slot: bool = False


@dataclass(frozen=True, slots=True)
class SetNumber:
    """Change a number, such as a duration."""

    path: Path
    number: str


@dataclass(frozen=True, slots=True)
class Wrap:
    """Put an expression around one: `text` has one hole, `?it`, for it."""

    path: Path
    text: str


@dataclass(frozen=True, slots=True)
class Unwrap:
    """Put an operand in the place of the application that it stands in."""

    path: Path


Edit: TypeAlias = Replace | Insert | Delete | Move | Rename | SetNumber | Wrap | Unwrap

_KINDS: Mapping[str, type] = {
    "replace": Replace,
    "insert": Insert,
    "delete": Delete,
    "move": Move,
    "rename": Rename,
    "set-number": SetNumber,
    "wrap": Wrap,
    "unwrap": Unwrap,
}
assert set(_KINDS.values()) == set(get_args(Edit))


def edit_as_json(edit: Edit) -> dict[str, object]:
    """Return an edit as plain data: its `edit`, and its fields by name."""
    name = next(name for name, kind in _KINDS.items() if kind is type(edit))
    values = {f.name: getattr(edit, f.name) for f in fields(edit)}
    return {"edit": name} | {k: [*v] if isinstance(v, tuple) else v for k, v in values.items()}


def edit_from_json(data: object) -> Edit:
    """Return the edit that plain data stand for. Raises: ValueError: they stand for none."""
    if not isinstance(data, Mapping):
        raise ValueError("an edit is an object")
    kind = _KINDS.get(str(data.get("edit")))
    if kind is None:
        raise ValueError(f"there is no edit `{data.get('edit')}`; known are {', '.join(_KINDS)}")
    known = {f.name: str(f.type) for f in fields(kind)}
    if strange := data.keys() - known.keys() - {"edit"}:
        raise ValueError(f"the edit `{data['edit']}` has no `{min(map(str, strange))}`")
    values: dict[str, Any] = {}
    for name, type_ in known.items():
        if name in data:
            values[name] = _field(name, type_, data[name])
        elif name != "slot":
            raise ValueError(f"the edit `{data['edit']}` lacks its `{name}`")
    edit: Edit = kind(**values)
    return edit


def _field(name: str, type_: str, data: object) -> object:
    match type_, data:
        case "Path", [*numbers] if all(type(n) is int and n >= 0 for n in numbers):
            return tuple(numbers)
        case "int", int() if type(data) is int and data >= 0:
            return data
        case "str", str():
            return data
        case "bool", bool():
            return data
        case _:
            kinds = {"Path": "a list of numbers", "int": "a number from 0", "str": "a text"}
            raise ValueError(f"`{name}` is {kinds.get(type_, 'true or false')}")
