"""A text with its items, and edits of it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from azee.blocks.change import TextChange
from azee.blocks.comments import (
    LAYOUT,
    Key,
    Note,
    Notes,
    hand_over,
    is_word,
    notes_of_fragment,
)
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
from azee.blocks.tree import Items, content, node_at
from azee.blocks.tree_edit import EditedTree, edited
from azee.blocks.writing import first_word, words_of, written
from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.format import format_file
from azee_grammar.layout import LayoutReader
from azee_grammar.parser import parse_layouts
from azee_grammar.source import Source, Span
from azee_grammar.syntax import Application, Definition, Item, Use
from azee_grammar.token import Token

_LINE_END = re.compile(r"\r\n|\r|\n")


@dataclass(frozen=True, slots=True, eq=False)
class ItemText:
    """An item and its lines. node: None where it has a mistake. notes: of its words."""

    node: Item | None
    span: Span
    notes: Notes


@dataclass(frozen=True, slots=True, eq=False)
class Edited:
    """A text after an edit.

    change: what became of the text before. gone: comments that stood inside what was taken away.
    """

    document: Document
    change: TextChange
    gone: tuple[str, ...]

    @property
    def text(self) -> str:
        """The text after the edit."""
        return self.document.text


@dataclass(frozen=True, eq=False)
class Document:
    """A text as a sequence of items, each by itself: a mistake in one does not hide the others."""

    source: Source

    @classmethod
    def of(cls, text: str, name: str = "<text>") -> Document:
        """Return the document of a text."""
        return cls(Source(name, text))

    @property
    def text(self) -> str:
        """The text, as it was written."""
        return self.source.text

    @cached_property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The mistakes of its form; the items that have them are no blocks."""
        return self._read[0]

    @property
    def items(self) -> tuple[ItemText, ...]:
        """Its items, in order."""
        return self._read[1]

    @property
    def nodes(self) -> Items:
        """The syntax trees of its items."""
        return tuple(item.node for item in self.items)

    @cached_property
    def _read(self) -> tuple[tuple[Diagnostic, ...], tuple[ItemText, ...]]:
        reader = LayoutReader(self.source)
        layouts = [*reader.items()]
        parsed = parse_layouts(self.source, layouts, reader, template=True)
        nodes = {content(item).span.start: item for item in parsed.file.items}
        out = []
        for layout in layouts:
            problems = layout.diagnostics
            words = [t for t in layout.tokens if t.kind not in LAYOUT]
            if words:
                span = self._lines(words[0].start, words[-1].end)
                out.append(self._item(span, words, nodes, parsed.comments))
            elif problems and problems[0].span:
                span = self._lines(problems[0].span.start, problems[0].span.end)
                out.append(ItemText(None, span, Notes()))
        return parsed.diagnostics, tuple(out)

    def _item(
        self, span: Span, tokens: Sequence[Token], nodes: dict[int, Item], comments: Sequence[Span]
    ) -> ItemText:
        words = [t for t in tokens if is_word(t)]
        node = nodes.get(words[0].start) if words else None
        if isinstance(node, Definition) and node.body is None:
            node = None
        inside = [c for c in comments if span.start <= c.start < span.end]
        return ItemText(node, span, Notes.of(self.source, words, inside))

    def _lines(self, start: int, end: int) -> Span:
        """Return the whole lines around a range, without the last line's end."""
        _, column = self.source.position(start)
        line_end = _LINE_END.search(self.text, end)
        return Span(
            self.source, start - column + 1, line_end.start() if line_end else len(self.text)
        )

    @property
    def line_end(self) -> str:
        """How its lines end."""
        found = _LINE_END.search(self.text)
        return found[0] if found else "\n"

    # Edits ----------------------------------------------------------------------------------

    def apply(self, edit: Edit) -> Edited:
        """Return the text after an edit.

        The items that it concerns get the canonical layout; every other character stays. Where an
        item is laid out otherwise, changing one word leaves its layout as it is.

        Raises: AZeeError: the edit is impossible, or what it would make cannot be read.
        """
        tree = edited(self.nodes, edit)
        gone: tuple[str, ...] = ()
        match edit:
            case Insert((), row, _):
                text = self._with_items(row, tree)
            case Delete((), row):
                text, gone = self._without_item(row)
            case Move((), row, (), to_row):
                text = self._with_moved_item(row, to_row)
            case (
                Replace()
                | Insert()
                | Delete()
                | Move()
                | Rename()
                | SetNumber()
                | Wrap()
                | Unwrap()
            ):
                text, gone = self._with_changed_items(edit, tree)
        document = Document.of(text, self.source.name)
        if document.nodes != tree.items:
            raise AZeeError(*(document.diagnostics or [_UNREADABLE]))
        return Edited(document, TextChange.between(self.text, text), gone)

    def _with_changed_items(self, edit: Edit, tree: EditedTree) -> tuple[str, tuple[str, ...]]:
        left = {word for item in tree.items if item for word in words_of(content(item))}
        brought: dict[Key, Note] = {}
        for source in tree.sources:
            brought |= notes_of_fragment(source, left)
        if isinstance(edit, Replace):
            old_words, new_words = (
                words_of(node_at(items, edit.path)) for items in (self.nodes, tree.items)
            )
            hand_over(self.items[edit.path[0]].notes, old_words, brought, new_words)
        known = {k: note for item in self.items for k, note in item.notes.words.items()} | brought
        text, gone = self.text, list[str]()
        for old, new in reversed([*zip(self.items, tree.items, strict=True)]):
            if new is None or new is old.node:
                continue
            notes, removed = old.notes.without_words(left, tree.removed)
            gone += (comment.text for comment in removed)
            changed = self._spliced(edit, tree) if self._has_own_layout(old) else None
            if changed is None:
                changed = written(new, known | notes.words, notes.after, self.source.name)
                changed = changed.replace("\n", self.line_end)
            text = text[: old.span.start] + changed + text[old.span.end :]
        return text, tuple(gone)

    def _has_own_layout(self, item: ItemText) -> bool:
        """Whether an item is laid out otherwise than the formatter would."""
        text = _LINE_END.sub("\n", item.span.text)
        return format_file(Source(self.source.name, text)) != f"{text}\n"

    def _spliced(self, edit: Edit, tree: EditedTree) -> str | None:
        """Return the text of an item with one word changed; None for other edits."""
        if not isinstance(edit, Rename | SetNumber | Replace):
            return None
        if isinstance(edit, Rename) and edit.slot:
            return None
        old, new = (node_at(items, edit.path) for items in (self.nodes, tree.items))
        if isinstance(old, Use | Definition) or isinstance(new, Use | Definition):
            return None
        if isinstance(edit, Replace) and (
            Application in (type(old), type(new)) or edit.text.strip() != first_word(new)
        ):
            return None
        span = old.head.span if isinstance(old, Application) else old.span
        item = self.items[edit.path[0]].span
        return self.text[item.start : span.start] + first_word(new) + self.text[span.end : item.end]

    # Items ----------------------------------------------------------------------------------

    def _with_items(self, row: int, tree: EditedTree) -> str:
        """Insert items before an item and the comments above it, a blank line around rules."""
        (source,) = tree.sources
        new = format_file(source).rstrip("\n").replace("\n", self.line_end)
        is_rule = any(isinstance(item, Definition) for item in tree.items[row : row + 1])
        return self._with_lines(row, new, spaced=is_rule)

    def _with_lines(self, row: int, lines: str, *, spaced: bool) -> str:
        text, end = self.text, self.line_end
        gap = end * 2 if spaced else end
        if row < len(self.items):
            at = self._begin(row)
            return text[:at] + lines + gap + text[at:]
        body = text.rstrip()
        tail = text[len(body) :] if body else ""
        return f"{body}{gap if body else ''}{lines}{tail or end}"

    def _without_item(self, row: int) -> tuple[str, tuple[str, ...]]:
        item = self.items[row]
        assert item.node is not None
        kept, gone = item.notes.without_words(set(), (item.node.span,))
        stays = self.line_end.join(comment.text for comment in kept.after)
        end = item.span.end
        if not stays and (found := _LINE_END.match(self.text, end)):
            end = found.end()
        text = self.text[: item.span.start] + stays + self.text[end:]
        return text, tuple(comment.text for comment in gone)

    def _with_moved_item(self, row: int, to_row: int) -> str:
        start, end = self._begin(row), self.items[row].span.end
        lines = self.text[start:end]
        if found := _LINE_END.match(self.text, end):
            end = found.end()
        without = Document.of(self.text[:start] + self.text[end:], self.source.name)
        return without._with_lines(to_row - (to_row > row), lines, spaced=False)

    def _begin(self, row: int) -> int:
        """Return where an item begins with the comments right above it."""
        start = self.items[row].span.start
        while start:
            _, column = self.source.position(start - 1)
            if not self.text.startswith("#", start - column):
                break
            start -= column
        return start


_UNREADABLE = cannot_edit("the text would read otherwise after this edit")
