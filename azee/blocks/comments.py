"""Which word of a text each comment belongs to, so that comments go with their words.

A comment behind a word, on its line, is *beside* it; any other comment is *above* the next word. A
word is known by its source and its offset there, which syntax nodes keep when they move.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias

from azee_grammar.layout import LayoutReader
from azee_grammar.source import Source, Span
from azee_grammar.token import Token

Key: TypeAlias = tuple[int, int]
"""A word: the identity of its source, and its offset."""


LAYOUT = frozenset({"_NEWLINE", "_INDENT", "_DEDENT"})
"""Tokens without a place in the text."""
_PUNCTUATION = frozenset({"_OPEN", "_CALL", "CLOSE", "_COMMA", "_EQUALS"})


def is_word(token: Token) -> bool:
    """Whether a token is a word: it stands in the syntax tree."""
    return token.kind not in LAYOUT and token.kind not in _PUNCTUATION


def key(span: Span) -> Key:
    """Return the key of the word that begins a range."""
    return id(span.source), span.start


@dataclass(frozen=True, slots=True)
class Comment:
    """A comment as written; spaced: whether there is a blank line above it."""

    span: Span
    spaced: bool

    @property
    def text(self) -> str:
        """What is written, from the `#` on."""
        return self.span.text.rstrip()


@dataclass(frozen=True, slots=True)
class Note:
    """What stands around a word besides the layout. spaced: there is a blank line above it."""

    above: tuple[Comment, ...] = ()
    beside: Comment | None = None
    spaced: bool = False


@dataclass(slots=True)
class Notes:
    """The notes of the words of one item, in order.

    after: comments behind its last word, on lines of their own.
    """

    words: dict[Key, Note] = field(default_factory=dict)
    after: tuple[Comment, ...] = ()

    @classmethod
    def of(cls, source: Source, words: Sequence[Token], comments: Sequence[Span]) -> Notes:
        """Read the notes of an item from its words and the comments among and beside them."""
        out = cls()
        starts = [word.start for word in words]
        above: dict[int, list[Comment]] = {}
        beside: dict[int, Comment] = {}
        after = []
        for span in comments:
            comment = Comment(span, _spaced(source, span.start))
            n = bisect_left(starts, span.start)
            if n and source.position(words[n - 1].end)[0] == span.line:
                beside[n - 1] = comment
            elif n < len(words):
                above.setdefault(n, []).append(comment)
            else:
                after.append(comment)
        for n, word in enumerate(words):
            found = Note(tuple(above.get(n, ())), beside.get(n), _spaced(source, word.start))
            out.words[id(source), word.start] = found
        out.after = tuple(after)
        return out

    def comments(self) -> Iterator[Comment]:
        """Yield all comments, in order."""
        for note in self.words.values():
            yield from note.above
            if note.beside:
                yield note.beside
        yield from self.after

    def without_words(self, left: set[Key], removed: Sequence[Span]) -> tuple[Notes, list[Comment]]:
        """Return the notes of those words that are left, and the comments that are gone.

        A comment inside a removed range is gone. Any other comment of a word that is gone stays,
        above the next word that is left.
        """
        out, gone = Notes(), list[Comment]()
        waiting: list[Comment] = []

        def keep(comments: Sequence[Comment]) -> None:
            for comment in comments:
                inside = any(_inside(comment.span, span) for span in removed)
                (gone if inside else waiting).append(comment)

        for word, note in self.words.items():
            if word in left:
                out.words[word] = replace(note, above=(*waiting, *note.above))
                waiting = []
            else:
                keep([*note.above, *filter(None, [note.beside])])
        out.after = (*waiting, *self.after)
        return out, gone


def hand_over(notes: Notes, old: Sequence[Key], new: dict[Key, Note], words: Sequence[Key]) -> None:
    """Hand what stands around replaced words to those in their place.

    Comments above the first go above the first, a comment beside the last beside the last.

    Args: notes: of the item; changed. old: the words that are replaced. new: notes of what is
        brought in; changed. words: the words in their place.
    """
    first = notes.words[old[0]]
    there = new.get(words[0], Note())
    new[words[0]] = replace(there, above=(*first.above, *there.above), spaced=first.spaced)
    notes.words[old[0]] = replace(first, above=())
    last, there = notes.words[old[-1]], new.get(words[-1], Note())
    if last.beside and not there.beside:
        new[words[-1]] = replace(there, beside=last.beside)
        notes.words[old[-1]] = replace(last, beside=None)


def _inside(inner: Span, outer: Span) -> bool:
    return inner.source is outer.source and outer.start <= inner.start and inner.end <= outer.end


def _spaced(source: Source, offset: int) -> bool:
    """Whether an offset is the first of its line, parentheses aside, below a blank line."""
    line, column = source.position(offset)
    if line == 1 or source.line(line)[: column - 1].strip("\ufeff \t("):
        return False
    return not source.line(line - 1).strip()


def notes_of_fragment(source: Source, left: set[Key]) -> dict[Key, Note]:
    """Return the notes of those words of a text that is brought in that are left in a tree.

    They have all its comments.
    """
    reader = LayoutReader(source)
    words = [t for item in reader.items() for t in item.tokens if is_word(t)]
    found = Notes.of(source, words, [Span(source, *at) for at in reader.comments])
    kept, _ = found.without_words(left, ())
    notes = kept.words
    if kept.after and notes:
        last = next(reversed(notes))
        notes[last] = replace(notes[last], above=(*notes[last].above, *kept.after))
    return notes
