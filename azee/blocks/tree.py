"""Paths into the syntax tree, and trees with one node changed.

A path is a tuple of numbers. The first counts the items of the file, each further one the children
of a node: the operands of an application (a named operand stands for its value), the entries of a
definition and then its body, the library of a `use`. The path of an utterance is that of its
expression. Operands make *rows*, which belong together: a symbol with its value, a block of a
`sync` with its rule.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TypeAlias

from azee_grammar.rows import rows
from azee_grammar.syntax import (
    Application,
    Definition,
    Expr,
    Hole,
    Item,
    Named,
    Number,
    OperatorName,
    Parameter,
    RuleName,
    SideWord,
    Symbol,
    Text,
    Use,
    Utterance,
)

Path: TypeAlias = tuple[int, ...]
Items: TypeAlias = tuple[Item | None, ...]
"""The items of a text; None for one with a mistake."""
Node: TypeAlias = Use | Definition | Expr
"""What a path leads to."""
Operand: TypeAlias = Expr | Named


def content(item: Item) -> Node:
    """Return what the path of an item leads to."""
    return item.expr if isinstance(item, Utterance) else item


def as_item(node: Node) -> Item:
    """Return a node as an item: an expression as an utterance."""
    return node if isinstance(node, Use | Definition) else Utterance(node.span, node)


def value(operand: Operand) -> Expr:
    """Return an operand without its name."""
    return operand.value if isinstance(operand, Named) else operand


def children(node: Node) -> tuple[Expr, ...]:
    """Return the nodes that a path may go on to."""
    match node:
        case Use(library=library):
            return (library,)
        case Definition(entries=entries, body=body):
            texts: tuple[Expr, ...] = tuple(text for _, text in entries)
            return texts if body is None else (*texts, body)
        case Application(operands=operands):
            return tuple(map(value, operands))
        case Number() | Text() | Symbol() | Parameter() | Hole() | SideWord():
            return ()


def node_at(items: Items, path: Path) -> Node:
    """Return the node of a path. Raises: LookupError: there is none, or a mistake."""
    item = items[_counted(path[0])]
    if item is None:
        raise LookupError("that item has a mistake")
    node = content(item)
    for i in path[1:]:
        node = children(node)[_counted(i)]
    return node


def _counted(i: int) -> int:
    if i < 0:
        raise LookupError("numbers of a path count from 0")
    return i


def with_node(items: Items, path: Path, new: Node) -> Items:
    """Return the items with the node of a path replaced.

    Raises: LookupError: there is no such node. TypeError: a definition or a `use` in the place of
    an expression, or another word than a text in that of an entry.
    """
    old = items[_counted(path[0])]
    if len(path) == 1:
        return (*items[: path[0]], as_item(new), *items[path[0] + 1 :])
    if old is None:
        raise LookupError("that item has a mistake")
    if isinstance(new, Use | Definition):
        raise TypeError("a definition or a `use` stands at the margin only")
    changed = as_item(_with_child(content(old), path[1:], new))
    return (*items[: path[0]], changed, *items[path[0] + 1 :])


def _with_child(node: Node, path: Path, new: Expr) -> Node:
    if not path:
        return new
    i = _counted(path[0])
    changed = _with_child(children(node)[i], path[1:], new)
    match node:
        case Use():
            if not isinstance(changed, Symbol):
                raise TypeError("a library is named by a symbol")
            return replace(node, library=changed)
        case Definition(entries=entries):
            assert not isinstance(changed, Use | Definition)
            if i == len(entries):
                return replace(node, body=changed)
            if not isinstance(changed, Text):
                raise TypeError("an entry of a definition is a text in quotation marks")
            name = entries[i][0]
            return replace(node, entries=(*entries[:i], (name, changed), *entries[i + 1 :]))
        case Application(operands=operands):
            assert not isinstance(changed, Use | Definition)
            old = operands[i]
            operand = replace(old, value=changed) if isinstance(old, Named) else changed
            return replace(node, operands=(*operands[:i], operand, *operands[i + 1 :]))
        case Number() | Text() | Symbol() | Parameter() | Hole() | SideWord():
            raise LookupError("a word has no parts")


def operand_rows(node: Application) -> tuple[range, ...]:
    """Return the rows of the operands of an application, as ranges of their numbers."""
    return tuple(range(row[0].start, row[-1].stop) for row in sub_rows(node))


def sub_rows(node: Application) -> tuple[tuple[range, ...], ...]:
    """Return the rows, each with its parts: in a `sync`, a block and its rule."""
    out: list[tuple[range, ...]] = []
    for part in _parts(node):
        if out and _is_rule_of_block(node, part):
            out[-1] = (*out[-1], part)
        else:
            out.append((part,))
    return tuple(out)


def _parts(node: Application) -> Iterator[range]:
    operands = node.operands
    flat = [operand for operand in operands if not isinstance(operand, Named)]
    if len(flat) < len(operands) or (node.called and isinstance(node.head, RuleName)):
        yield from (range(i, i + 1) for i in range(len(operands)))
        return
    at = 0
    for row in rows(node, flat):
        yield range(at, at + len(row))
        at += len(row)


def _is_rule_of_block(node: Application, part: range) -> bool:
    """Whether a part says when the block before it is, such as `'start 'SIG:end`."""
    if not (isinstance(node.head, OperatorName) and node.head.name == "sync"):
        return False
    return len(part) > 1 and isinstance(node.operands[part.start + 1], Symbol)


def lead(node: Application, part: range) -> Symbol | None:
    """Return the symbol that names what follows it in a part of a row."""
    first = node.operands[part.start]
    return first if len(part) > 1 and isinstance(first, Symbol) else None


def with_operands(node: Application, operands: Sequence[Operand]) -> Application:
    """Return an application of the same head to other operands."""
    return replace(node, operands=tuple(operands))
