"""Edits of a text for Hypothesis and for random journeys: any that its blocks allow."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Protocol, TypeVar

from azee.blocks.document import Document
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
from azee.blocks.view import Block, blocks_of
from azee_grammar.layout import LayoutReader
from azee_grammar.source import Source
from azee_grammar.token import Token

T = TypeVar("T")

EXPRESSIONS = (":chat", "key .2 (look ^fwd)", "'new", ".5", "f(1, 'a = g(2))", ":mois sgn1 # why\n")
ROWS = (
    ":chat",
    "'info :bien",
    "'B key(1, ^x)  # beside\n'start 'A:end",
    "^p",
    "# above\n'dist .02",
)
ITEMS = ("use 'lsf", ":bien", 'def b\n    # inside\n    \'meaning "m"\n    :chat', "key 1 :#fist")
AROUND = (
    ":negation 'sig ?it",
    "repeat ?it 2",
    "f('x = ?it)",
    "cstr\n    ?it  # held\n    look ^fwd",
)
NAMES = ("bien", "other-name", "x1", "été")


class Choosing(Protocol):
    """Something that chooses, as `random.Random` does."""

    def choice(self, options: Sequence[T], /) -> T: ...


@lru_cache(maxsize=16)
def layout(text: str) -> tuple[Sequence[Token], Sequence[tuple[int, int]]]:
    """The words of a text and the ranges of its comments, read once for all that asks."""
    reader = LayoutReader(Source("a", text))
    tokens = [t for item in reader.items() for t in item.tokens if is_word(t)]
    return tokens, reader.comments


def words(text: str) -> Counter[tuple[str, str]]:
    """The words of a text, without layout and punctuation, each with its kind."""
    return Counter(word(t, text) for t in layout(text)[0])


def word(token: Token, text: str) -> tuple[str, str]:
    """A word with its kind; `use` and `def` have no text of their own."""
    return token.kind, token.text if token.kind == "TEXT" else token.text or _written(token, text)


def _written(token: Token, text: str) -> str:
    return text[token.start : token.end]


def is_word(token: Token) -> bool:
    return token.kind.isalpha() and token.kind != "CLOSE"


def comments(text: str) -> Counter[str]:
    """The comments of a text."""
    return Counter(text[start:end].rstrip() for start, end in layout(text)[1])


def any_edit(document: Document, choosing: Choosing) -> Edit | None:
    """Choose an edit of a text; None for a text without blocks."""
    blocks = [block for item in blocks_of(document) for block in item.all()]
    sound = [block for block in blocks if block.kind != "mistake"]
    heads = [block for block in sound if block.rows and block.kind != "definition"]
    inner = [b for b in sound if b.kind not in ("definition", "use", "entry") and _editable(b)]
    makers: list[Callable[[], Edit]] = [
        lambda: Insert((), choosing.choice(range(len(document.items) + 1)), choosing.choice(ITEMS))
    ]
    if sound:
        makers += [lambda: _item_edit(document, choosing), lambda: _rename(sound, choosing)]
    if inner:
        makers += [
            lambda: Replace(choosing.choice(inner).path, choosing.choice(EXPRESSIONS)),
            lambda: Wrap(choosing.choice(inner).path, choosing.choice(AROUND)),
        ]
    if heads:
        makers += [lambda: _row_edit(heads, choosing), lambda: _move(heads, choosing)] * 2
    if numbers := [block for block in sound if block.kind == "number"]:
        number = choosing.choice(("2", "-.5", "12."))
        makers.append(lambda: SetNumber(choosing.choice(numbers).path, number))
    if parts := [b for b in inner if len(b.path) > 1 and _parent(b, sound).kind != "definition"]:
        makers.append(lambda: Unwrap(choosing.choice(parts).path))
    return choosing.choice(makers)()


def _editable(block: Block) -> bool:
    return block.kind != "entry"


def _parent(block: Block, blocks: Sequence[Block]) -> Block:
    return next(b for b in blocks if b.path == block.path[:-1])


def _item_edit(document: Document, choosing: Choosing) -> Edit:
    sound = [i for i, item in enumerate(document.items) if item.node is not None]
    row = choosing.choice(sound)
    if choosing.choice((True, False)):
        return Delete((), row)
    return Move((), row, (), choosing.choice(range(len(document.items) + 1)))


def _rename(blocks: Sequence[Block], choosing: Choosing) -> Edit:
    named = [b for b in blocks if b.kind not in ("number", "text", "entry", "side", "hole")]
    block = choosing.choice(named or blocks)
    return Rename(block.path, choosing.choice(NAMES))


def _row_edit(heads: Sequence[Block], choosing: Choosing) -> Edit:
    head = choosing.choice(heads)
    if choosing.choice((True, False)):
        return Insert(head.path, choosing.choice(range(head.rows + 1)), choosing.choice(ROWS))
    return Delete(head.path, choosing.choice(range(head.rows)))


def _move(heads: Sequence[Block], choosing: Choosing) -> Edit:
    taken, to = choosing.choice(heads), choosing.choice(heads)
    to_row = choosing.choice(range(to.rows + 1))
    return Move(taken.path, choosing.choice(range(taken.rows)), to.path, to_row)
