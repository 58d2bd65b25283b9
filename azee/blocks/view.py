"""The blocks of a text: what an editor of blocks draws, as plain data.

Every word of the text is in exactly one block, and so is every comment among the words of an item.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from azee.blocks.change import CodeUnits
from azee.blocks.comments import Comment, Key, Note, key
from azee.blocks.document import Document
from azee.blocks.marks import mark_of
from azee.blocks.tree import Node, Path, content, lead, sub_rows, value
from azee.blocks.writing import first_word
from azee_grammar.source import Span
from azee_grammar.syntax import (
    Application,
    BoneName,
    Definition,
    Expr,
    Hole,
    Named,
    Number,
    OperatorName,
    Parameter,
    RuleForm,
    RuleName,
    SideWord,
    SiteName,
    Symbol,
    Text,
    Use,
)

_FORMS = {RuleForm.APPLY: "rule", RuleForm.REFER: "reference", RuleForm.POSTURE: "posture"}


@dataclass(frozen=True, slots=True)
class Block:
    """A word with the blocks of its operands.

    path: of its node, for edits. row: of the operands of the block around it. slot: the symbol that
    names it there, without its apostrophe. kind: `rule`, `reference`, `posture`, `operator`,
    `bone`, `site`, `number`, `text`, `symbol`, `parameter`, `hole`, `side`, `definition`, `entry`,
    `use` or `mistake`. text: its word as the text has it; of a mistake, all its lines. mark: the
    sign of what it does, such as `=`. span: in the text, with its blocks. rows: how many there are.
    above, beside: comments.
    """

    path: Path
    row: int
    slot: str | None
    kind: str
    text: str
    mark: str | None
    span: Span
    rows: int = 0
    children: tuple[Block, ...] = ()
    above: tuple[str, ...] = ()
    beside: tuple[str, ...] = ()

    def all(self) -> Iterator[Block]:
        """Yield it and the blocks inside it, in the order of the text."""
        yield self
        for child in self.children:
            yield from child.all()

    def as_json(self, units: CodeUnits) -> dict[str, object]:
        """Return it as plain data, `from` and `to` in UTF-16 units of the text."""
        return {
            "path": [*self.path],
            "row": self.row,
            "slot": self.slot,
            "kind": self.kind,
            "text": self.text,
            "mark": self.mark,
            "from": units(self.span.start),
            "to": units(self.span.end),
            "line": self.span.line,
            "rows": self.rows,
            "above": [*self.above],
            "beside": [*self.beside],
            "children": [child.as_json(units) for child in self.children],
        }


def blocks_of(document: Document) -> tuple[Block, ...]:
    """Return the blocks of a text, one for each item."""
    return tuple(_Viewer(document).items())


def as_json(document: Document) -> dict[str, object]:
    """Return the blocks of a text, and how many mistakes hide others, as plain data."""
    units = CodeUnits(document.text)
    return {
        "blocks": [block.as_json(units) for block in blocks_of(document)],
        "mistakes": len(document.diagnostics),
    }


class _Viewer:
    def __init__(self, document: Document) -> None:
        self._document = document
        self._notes: dict[Key, Note] = {}
        for item in document.items:
            self._notes |= item.notes.words

    def items(self) -> Iterator[Block]:
        for i, item in enumerate(self._document.items):
            if item.node is None:
                yield Block((i,), i, None, "mistake", item.span.text, None, item.span)
                continue
            block = self._block(content(item.node), (i,), i, None)
            after = (comment.text for comment in item.notes.after)
            yield replace(block, beside=(*block.beside, *after))

    def _block(self, node: Node, path: Path, row: int, slot: Symbol | None) -> Block:
        words = [] if slot is None else [slot.span]
        children: tuple[Block, ...] = ()
        rows, mark = 0, None
        match node:
            case Use(library=library):
                kind, text = "use", f"use '{library.name}"
                words += [node.span, library.span]
            case Definition():
                kind, text = "definition", f"def {node.name}"
                words += [node.span, node.name_span]
                children = tuple(self._entries(node, path))
                rows = len(children)
            case Application():
                kind, text, mark = _kind(node), first_word(node), mark_of(node.head)
                words.append(node.head.span)
                children = tuple(self._operands(node, path))
                rows = len(sub_rows(node))
            case Number() | Text() | Symbol() | Parameter() | Hole() | SideWord():
                kind, text = _kind(node), first_word(node)
                words.append(node.span)
        above, beside = self._comments(words)
        name = None if slot is None else slot.name
        return Block(path, row, name, kind, text, mark, node.span, rows, children, above, beside)

    def _entries(self, node: Definition, path: Path) -> Iterator[Block]:
        for i, (name, text) in enumerate(node.entries):
            yield self._block(text, (*path, i), i, name)
        if node.body is not None:
            n = len(node.entries)
            yield self._block(node.body, (*path, n), n, None)

    def _operands(self, node: Application, path: Path) -> Iterator[Block]:
        for r, parts in enumerate(sub_rows(node)):
            for part in parts:
                slot = lead(node, part)
                for i in part[1:] if slot else part:
                    operand = node.operands[i]
                    name = operand.name if isinstance(operand, Named) else slot
                    yield self._block(value(operand), (*path, i), r, name)
                    slot = None

    def _comments(self, words: list[Span]) -> tuple[tuple[str, ...], tuple[str, ...]]:
        above: list[Comment] = []
        beside: list[Comment] = []
        for span in words:
            note = self._notes.get(key(span), Note())
            above += note.above
            beside += filter(None, [note.beside])
        return tuple(c.text for c in above), tuple(c.text for c in beside)


def _kind(node: Expr) -> str:
    match node:
        case Application(head=RuleName(form=form)):
            return _FORMS[form]
        case Application(head=OperatorName()):
            return "operator"
        case Application(head=BoneName()):
            return "bone"
        case Application(head=SiteName()):
            return "site"
        case Number():
            return "number"
        case Text():
            return "text"
        case Symbol():
            return "symbol"
        case Parameter():
            return "parameter"
        case Hole():
            return "hole"
        case SideWord():
            return "side"
        case Application():
            raise AssertionError("heads are rules, operators, bones and sites")
