"""The text of an item whose tree was edited, with the comments of its words.

The item is first spelled out in parentheses, in which line ends mean nothing, so that a comment can
stand behind any word. The formatter then lays it out in the canonical form.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from azee.blocks.comments import Comment, Key, Note, key
from azee.blocks.tree import Node, Operand, as_item
from azee_grammar.format import format_file
from azee_grammar.leaves import head_text, leaf_text
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
    Utterance,
)

INDENT = "    "
_NONE = Note()
_BEFORE_A_COMMENT = (")", ",", "")


def written(item: Item, notes: Mapping[Key, Note], after: Sequence[Comment], name: str) -> str:
    """Return an item in canonical layout, without a line end behind its last line.

    Args: notes: of its words. after: comments behind it. name: of the text, for messages.
    Raises: AZeeError: its words, as renamed, can no longer be read.
    """
    writer = _Writer(notes)
    writer.item(item)
    for comment in after:
        writer.comment(comment)
    return format_file(Source(name, f"{writer.text}\n")).rstrip("\n")


def words_of(node: Node) -> list[Key]:
    """Return the words of a node, in order."""
    writer = _Writer({})
    writer.item(as_item(node))
    return [*writer.written]


def first_word(node: Expr) -> str:
    """Return the first word of an expression, with its sigil."""
    return head_text(node.head) if isinstance(node, Application) else leaf_text(node)


class _Writer:
    """Writes words in the order of the tree.

    The first word stands at the margin, lines below it are indented.
    """

    def __init__(self, notes: Mapping[Key, Note]) -> None:
        self.written: dict[Key, None] = {}
        self._parts: list[str] = []
        self._notes = notes
        self._indent = INDENT
        self._line_ends = 0  # to be written before the next part
        self._waiting: Comment | None = None  # to be written behind the last part

    @property
    def text(self) -> str:
        """What was written."""
        waiting = f"  {self._waiting.text}" if self._waiting else ""
        return "".join(self._parts) + waiting

    def item(self, item: Item) -> None:
        match item:
            case Use(span=span, library=library):
                self._word("use", span)
                self._put(" ", f"'{library.name}")
                self.written.setdefault(key(library.span))
                self._beside(library.span)
            case Definition():
                self._definition(item)
            case Utterance(expr=expr):
                self._lines(expr, INDENT)

    def _definition(self, item: Definition) -> None:
        self._word("def", item.span)
        self._put(" ", item.name)
        self.written.setdefault(key(item.name_span))
        self._beside(item.name_span)
        self._indent = INDENT
        for name, text in item.entries:
            self._line()
            self._word(f"'{name.name}", name.span)
            self._put("  ")
            self._word(f'"{text.text}"', text.span)
        assert item.body is not None, "an item with a mistake is not edited"
        self._line()
        if isinstance(item.body, Symbol):
            self._put("(")
            self._expression(item.body)
            self._put(")")
        else:
            self._lines(item.body, INDENT * 2)

    def _lines(self, expr: Expr, indent: str) -> None:
        """Write an expression that begins a line, its operands on deeper lines."""
        if not isinstance(expr, Application) or expr.called:
            self._expression(expr)
            return
        self._word(head_text(expr.head), expr.head.span)
        self._indent = indent
        for operand in expr.operands:
            self._line()
            self._operand(operand)

    def _expression(self, expr: Expr) -> None:
        match expr:
            case Application(called=True):
                self._call(expr)
            case Application(head=head, operands=operands):
                self._put("(" if operands else "")
                self._word(head_text(head), head.span)
                for operand in operands:
                    self._put("  ")
                    self._operand(operand)
                self._put(")" if operands else "")
            case Number() | Text() | Symbol() | Parameter() | Hole() | SideWord():
                self._word(leaf_text(expr), expr.span)

    def _call(self, expr: Application) -> None:
        """Write a call; a comment beside its head goes behind the parenthesis."""
        head = expr.head.span
        self._above(head)
        self._put(head_text(expr.head), "(")
        self.written.setdefault(key(head))
        self._beside(head)
        for i, operand in enumerate(expr.operands):
            self._put(", " if i else "")
            self._operand(operand)
        self._put(")")

    def _operand(self, operand: Operand) -> None:
        if isinstance(operand, Named):
            self._word(f"'{operand.name.name}", operand.name.span)
            self._put(" = ")
            self._expression(operand.value)
        else:
            self._expression(operand)

    def _word(self, text: str, span: Span) -> None:
        self._above(span)
        self._put(text)
        self.written.setdefault(key(span))
        self._beside(span)

    def _above(self, span: Span) -> None:
        note = self._notes.get(key(span), _NONE)
        for comment in note.above:
            self.comment(comment)
        if note.spaced or note.above:
            self._line(spaced=note.spaced)

    def _beside(self, span: Span) -> None:
        """Write a comment behind a word, and behind the parentheses that close there."""
        self._waiting = self._notes.get(key(span), _NONE).beside

    def comment(self, comment: Comment) -> None:
        """Write a comment on a line of its own."""
        self._line(spaced=comment.spaced)
        self._put(comment.text)
        self._line()

    def _line(self, *, spaced: bool = False) -> None:
        """Begin a new line, unless one has begun already; spaced: below a blank line."""
        if self._parts:
            self._line_ends = max(self._line_ends, 2 if spaced else 1)

    def _put(self, *parts: str) -> None:
        for part in parts:
            if self._waiting and part.strip() not in _BEFORE_A_COMMENT:
                self._parts.append(f"  {self._waiting.text}")
                self._waiting = None
                self._line()
            if self._line_ends:
                if not part or part.isspace():
                    continue
                margin = self._indent if self.written else ""
                self._parts.append("\n" * self._line_ends + margin)
                self._line_ends = 0
            self._parts.append(part)
