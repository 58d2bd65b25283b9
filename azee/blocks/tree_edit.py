"""Edits of the syntax tree: what each edit does, without a text.

`edited` is the meaning of an edit; `document` writes the text that has the edited tree.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass, replace

from azee.blocks.edits import (
    Delete,
    Edit,
    Insert,
    Move,
    Rename,
    Replace,
    SetNumber,
    Unwrap,
    Wrap,
)
from azee.blocks.fault import cannot_edit
from azee.blocks.fragment import Fragment, read_fragment, read_operands
from azee.blocks.tree import (
    Items,
    Node,
    Operand,
    Path,
    as_item,
    children,
    content,
    node_at,
    operand_rows,
    with_node,
    with_operands,
)
from azee_grammar.diagnostic import AZeeError
from azee_grammar.source import Source, Span
from azee_grammar.syntax import (
    Application,
    Definition,
    Expr,
    Hole,
    Item,
    Named,
    Number,
    Parameter,
    SideWord,
    Symbol,
    Text,
    Use,
)


@dataclass(frozen=True, slots=True)
class EditedTree:
    """The items after an edit.

    removed: ranges of the text that are gone. sources: of what was brought in.
    """

    items: Items
    removed: tuple[Span, ...] = ()
    sources: tuple[Source, ...] = ()


def edited(items: Items, edit: Edit) -> EditedTree:
    """Return the items after an edit. Raises: AZeeError: it is impossible, with the reason."""
    try:
        return _edited(items, edit)
    except LookupError as error:
        raise AZeeError(cannot_edit("there is no such block in the text")) from error
    except TypeError as error:
        raise AZeeError(cannot_edit(str(error))) from error


def _edited(items: Items, edit: Edit) -> EditedTree:
    match edit:
        case Replace(path, text):
            return _replaced(items, path, read_fragment(text))
        case Insert((), row, text):
            new = read_fragment(text)
            _require(0 <= row <= len(items))
            return EditedTree((*items[:row], *new.items, *items[row:]), sources=(new.source,))
        case Insert(path, row, text):
            source, operands = read_operands(text)
            at = _offset(_application(items, path), row)
            return EditedTree(_inserted(items, path, at, operands), sources=(source,))
        case Delete((), row):
            return EditedTree((*items[:row], *items[row + 1 :]), (_item(items, row).span,))
        case Delete(path, row):
            node = _application(items, path)
            gone = _row(node, row)
            left = (*node.operands[: gone.start], *node.operands[gone.stop :])
            span = node.operands[gone.start].span.to(node.operands[gone.stop - 1].span)
            return EditedTree(with_node(items, path, with_operands(node, left)), (span,))
        case Move((), row, (), to_row):
            item = _item(items, row)
            _require(0 <= to_row <= len(items))
            others = (*items[:row], *items[row + 1 :])
            to_row -= to_row > row
            return EditedTree((*others[:to_row], item, *others[to_row:]))
        case Move(path, row, to_path, to_row):
            return EditedTree(_moved(items, path, row, to_path, to_row))
        case Rename(path, name, slot):
            return EditedTree(_renamed(items, path, name, slot=slot))
        case SetNumber(path, number):
            return EditedTree(_with_number(items, path, number))
        case Wrap(path, text):
            return _wrapped(items, path, read_fragment(text, template=True))
        case Unwrap(path):
            kept, around = _expression(items, path), _application(items, path[:-1])
            outside = (
                Span(around.span.source, around.span.start, kept.span.start),
                Span(around.span.source, kept.span.end, around.span.end),
            )
            return EditedTree(with_node(items, path[:-1], kept), outside)


def _require(there: bool) -> None:
    if not there:
        raise LookupError("no such row")


def _item(items: Items, row: int) -> Item:
    _require(0 <= row < len(items))
    item = items[row]
    if item is None:
        raise AZeeError(cannot_edit("that item has a mistake: mend it in the text first"))
    return item


def _expression(items: Items, path: Path) -> Expr:
    _require(len(path) > 0)
    node = node_at(items, path)
    if isinstance(node, Use | Definition):
        raise TypeError("a definition or a `use` is no expression")
    return node


def _application(items: Items, path: Path) -> Application:
    node = _expression(items, path)
    if not isinstance(node, Application):
        raise TypeError("a word takes no operands")
    return node


def _row(node: Application, row: int) -> range:
    rows = operand_rows(node)
    _require(0 <= row < len(rows))
    return rows[row]


def _offset(node: Application, row: int) -> int:
    """Return the number of operands before a row, or of all."""
    rows = operand_rows(node)
    _require(0 <= row <= len(rows))
    return rows[row].start if row < len(rows) else len(node.operands)


def _replaced(items: Items, path: Path, new: Fragment) -> EditedTree:
    old = node_at(items, path)
    if len(path) == 1:
        if len(new.items) != 1:
            raise AZeeError(cannot_edit("one item is expected here", new.source.text))
        changed: Items = (*items[: path[0]], new.items[0], *items[path[0] + 1 :])
    else:
        changed = with_node(items, path, new.expression)
    return EditedTree(changed, (old.span,), (new.source,))


def _inserted(items: Items, path: Path, at: int, new: Sequence[Operand]) -> Items:
    node = _application(items, path)
    fitted = _fitted(node, new)
    operands = (*node.operands[:at], *fitted, *node.operands[at:])
    return with_node(items, path, with_operands(node, operands))


def _fitted(node: Application, new: Sequence[Operand]) -> Sequence[Operand]:
    """Return operands in the notation of an application: `'name value`, or `'name = value`."""
    if not node.called:
        out: list[Operand] = []
        for operand in new:
            out += (operand.name, operand.value) if isinstance(operand, Named) else (operand,)
        return out
    if len(new) == 2:
        name, given = new
        if isinstance(name, Symbol) and not isinstance(given, Named):
            return (Named(name.span, name, given),)
    return new


def _moved(items: Items, path: Path, row: int, to_path: Path, to_row: int) -> Items:
    if not path or not to_path:
        raise TypeError("an item moves among items, and a part of an item among parts")
    node, target = _application(items, path), _application(items, to_path)
    taken, at = _row(node, row), _offset(target, to_row)
    depth = len(path)
    inside = to_path[:depth] == path and len(to_path) > depth and to_path[depth] in taken
    if inside:
        raise AZeeError(cannot_edit("a block cannot be moved into itself"))
    moved = node.operands[taken.start : taken.stop]
    left = (*node.operands[: taken.start], *node.operands[taken.stop :])
    if to_path == path and at >= taken.stop:
        at -= len(taken)
    elif to_path[:depth] == path and len(to_path) > depth and to_path[depth] >= taken.stop:
        to_path = (*path, to_path[depth] - len(taken), *to_path[depth + 1 :])
    without = with_node(items, path, with_operands(node, left))
    return _inserted(without, to_path, at, moved)


def _renamed(items: Items, path: Path, name: str, *, slot: bool) -> Items:
    name = unicodedata.normalize("NFC", name)
    if slot:
        return _with_slot(items, path, name)
    node = node_at(items, path)
    match node:
        case Definition():
            new: Node = replace(node, name=name)
        case Use(library=library):
            new = replace(node, library=replace(library, name=name))
        case Application(head=head):
            new = replace(node, head=replace(head, name=name))
        case Symbol() | Parameter() | Hole() | SideWord():
            new = replace(node, name=name)
        case Number() | Text():
            raise TypeError("a number or a text has no name")
    return with_node(items, path, new)


def _with_slot(items: Items, path: Path, name: str) -> Items:
    """Rename the symbol before an operand, or that of a named operand."""
    _require(len(path) > 1)
    around, i = _application(items, path[:-1]), path[-1]
    operand = around.operands[i]
    operands = list(around.operands)
    if isinstance(operand, Named):
        operands[i] = replace(operand, name=replace(operand.name, name=name))
    elif i and isinstance(before := operands[i - 1], Symbol):
        operands[i - 1] = replace(before, name=name)
    else:
        raise TypeError("no symbol names this block")
    return with_node(items, path[:-1], with_operands(around, operands))


def _with_number(items: Items, path: Path, number: str) -> Items:
    node = _expression(items, path)
    new = read_fragment(number).expression
    if not isinstance(node, Number) or not isinstance(new, Number):
        raise TypeError("a number is expected here")
    return with_node(items, path, replace(node, text=new.text))


def _wrapped(items: Items, path: Path, around: Fragment) -> EditedTree:
    kept, expr = _expression(items, path), around.expression
    holes = list(_holes(expr, ()))
    if len(holes) != 1:
        raise AZeeError(cannot_edit("one hole, `?it`, is expected here", around.source.text))
    (whole,) = with_node((as_item(expr),), (0, *holes[0]), kept)
    assert whole is not None
    return EditedTree(with_node(items, path, content(whole)), (), (around.source,))


def _holes(node: Expr, path: Path) -> list[Path]:
    if isinstance(node, Hole):
        return [path]
    return [hole for i, child in enumerate(children(node)) for hole in _holes(child, (*path, i))]
