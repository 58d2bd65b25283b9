"""Edits of blocks do to the text what they do to the tree, and lose nothing beside what they take.

`after` says by itself which words and comments a text has after an edit: from the offsets of what
the edit takes away and from what it brings in.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import pytest
from edits_of import any_edit, comments, layout, word, words
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from programs_azee import programs

from azee.blocks.change import TextChange
from azee.blocks.document import Document, Edited
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
    edit_as_json,
    edit_from_json,
)
from azee.blocks.tree import content, node_at, operand_rows
from azee.blocks.tree_edit import edited
from azee.blocks.view import blocks_of
from azee_grammar.diagnostic import AZeeError
from azee_grammar.format import format_file
from azee_grammar.library import shipped
from azee_grammar.parser import parse
from azee_grammar.source import Source
from azee_grammar.syntax import Application, File

TEXT_FILES = sorted((Path(__file__).parents[2] / "examples").glob("*/*.azee"))
TEXTS = [
    path.read_text(encoding="utf-8") for path in (*TEXT_FILES, *sorted(shipped().rglob("*.azee")))
]

SHORT = 2000
"""Characters of a text that takes little time to read."""
seeds = st.integers(0, 2**32)
PROFILE = settings.get_profile(settings.get_current_profile_name())
EXAMPLES = min(PROFILE.max_examples, 25) if PROFILE.derandomize else 1000
"""Few by default: programs take long to draw. The profiles that look further draw more."""


def read(text: str) -> File:
    parsed = parse(Source("a", text), template=True)
    assert not parsed.diagnostics
    return parsed.file


def taken(document: Document, edit: Edit) -> list[tuple[int, int]]:
    """The ranges of the text that an edit takes away."""
    match edit:
        case Delete((), row):
            item = document.nodes[row]
            assert item is not None
            return [_range(content(item))]
        case Delete(path, row):
            node = node_at(document.nodes, path)
            assert isinstance(node, Application)
            inside = operand_rows(node)[row]
            first, last = node.operands[inside.start], node.operands[inside.stop - 1]
            return [(first.span.start, last.span.end)]
        case Replace(path, _):
            return [_range(node_at(document.nodes, path))]
        case Unwrap(path):
            outer, inner = (_range(node_at(document.nodes, p)) for p in (path[:-1], path))
            return [(outer[0], inner[0]), (inner[1], outer[1])]
        case _:
            return []


def _range(node: object) -> tuple[int, int]:
    return node.span.start, node.span.end  # type: ignore[attr-defined]


def brought(edit: Edit) -> str:
    return edit.text if isinstance(edit, Replace | Insert | Wrap) else ""


def _within(
    text: str, ranges: Sequence[tuple[int, int]]
) -> tuple[Counter[str], Counter[tuple[str, str]]]:
    """The comments and words of a text that lie in ranges."""
    tokens, found = layout(text)
    inside_words = Counter(
        word(t, text) for t in tokens if any(a <= t.start and t.end <= b for a, b in ranges)
    )
    inside_comments = Counter(
        text[s:e].rstrip() for s, e in found if any(a <= s and e <= b for a, b in ranges)
    )
    return inside_comments, inside_words


def check(document: Document, edit: Edit) -> Edited | None:
    """Make an edit and check all laws of one edit; None if it is refused."""
    try:
        done = document.apply(edit)
    except AZeeError:
        return None
    text = document.text
    assert read(done.text).items == edited(document.nodes, edit).items
    assert done.change.applied(text) == done.text
    assert done.change.inverse(text).applied(done.text) == text
    gone_comments, gone_words = _within(text, taken(document, edit))
    assert comments(done.text) == comments(text) - Counter(done.gone) + comments(brought(edit))
    assert Counter(done.gone) <= gone_comments
    expected = words(text) - gone_words + words(brought(edit))
    if isinstance(edit, Wrap):
        expected -= Counter(w for w in expected if w[0] == "HOLE")
    if isinstance(edit, Rename | SetNumber):
        assert (words(done.text) - expected).total() <= 1
        assert words(done.text).total() == expected.total()
    else:
        assert words(done.text) == expected
    return done


@pytest.mark.long
@settings(max_examples=EXAMPLES)
@given(programs, seeds)
def test_an_edit_of_blocks_is_the_edit_of_the_tree_and_loses_nothing(text: str, seed: int) -> None:
    assume(not parse(Source("a", text), template=True).diagnostics)
    document = Document.of(text)
    edit = any_edit(document, random.Random(seed))
    assert edit is not None
    assert edit_from_json(edit_as_json(edit)) == edit
    check(document, edit)


@pytest.mark.long
@settings(max_examples=EXAMPLES)
@given(programs, seeds)
def test_editing_and_formatting_commute(text: str, seed: int) -> None:
    assume(not parse(Source("a", text), template=True).diagnostics)
    edit = any_edit(Document.of(text), random.Random(seed))
    assert edit is not None
    canonical = format_file(Source("a", text))
    try:
        first = format_file(Source("a", Document.of(text).apply(edit).text))
    except AZeeError:
        with pytest.raises(AZeeError):
            Document.of(canonical).apply(edit)
        return
    then = Document.of(canonical).apply(edit).text
    assert format_file(Source("a", then)) == then
    assert read(then) == read(first)
    assert comments(then) == comments(first)


@pytest.mark.long
@settings(max_examples=EXAMPLES)
@given(programs, programs, seeds)
def test_edits_of_different_items_commute(first: str, second: str, seed: int) -> None:
    text, chance = first + second, random.Random(seed)
    assume(not parse(Source("a", text), template=True).diagnostics)
    document = Document.of(text)
    one, other = (any_edit(document, chance) for _ in range(2))
    if one is None or other is None or _items_of(one) & _items_of(other):
        return
    try:
        there = document.apply(one).document.apply(other).text
        back = document.apply(other).document.apply(one).text
    except AZeeError:
        return
    assert there == back


def _items_of(edit: Edit) -> set[int]:
    match edit:
        case Insert((), _, _) | Delete((), _) | Move((), _, _, _):
            return set(range(100))  # these change how the others are counted
        case Move(path, _, to_path, _):
            return {path[0], *to_path[:1]}
        case _:
            return {edit.path[0]}


@pytest.mark.long
@settings(max_examples=EXAMPLES)
@given(programs)
def test_every_word_and_comment_of_a_text_is_in_one_block(text: str) -> None:
    assume(not parse(Source("a", text), template=True).diagnostics)
    document = Document.of(text)
    shown = [block for item in blocks_of(document) for block in item.all()]
    told = Counter[str]()
    for block in shown:
        told.update(
            block.text.split(" ", 1) if block.kind in ("use", "definition") else [block.text]
        )
        told.update([] if block.slot is None else [f"'{block.slot}"])
    sigils = {"RULE": ":", "REFERENCE": ".", "POSTURE": ":#", "BONE": "!", "SITE": "@",
              "SYMBOL": "'", "PARAMETER": "^", "HOLE": "?"}  # fmt: skip
    written = Counter[str]()
    for (kind, name), count in words(text).items():
        written[f'"{name}"' if kind == "TEXT" else sigils.get(kind, "") + name] += count
    assert told == written
    assert Counter(c for b in shown for c in (*b.above, *b.beside)) <= comments(text)


def test_what_is_undone_was_as_before() -> None:
    """Insert and delete, wrap and unwrap, move and back, rename and back."""
    text = ":a\n    'x :f\n        'q :b\n    'y :d  # beside\n"
    pairs: list[tuple[Edit, Edit]] = [
        (Insert((0,), 1, "'z :e"), Delete((0,), 1)),
        (Wrap((0, 1), ":g 'sig ?it"), Unwrap((0, 1, 1))),
        (Move((0,), 0, (0,), 2), Move((0,), 1, (0,), 0)),
        (Move((0,), 1, (0, 1), 1), Move((0, 1), 1, (0,), 1)),
        (Rename((0, 3), "e"), Rename((0, 3), "d")),
        (Rename((0, 3), "z", slot=True), Rename((0, 3), "y", slot=True)),
        (Insert((), 0, ":g"), Delete((), 0)),
    ]
    for there, back in pairs:
        done = Document.of(text).apply(there)
        assert done.text != text, there
        assert done.document.apply(back).text == text, there


# Journeys ------------------------------------------------------------------------------------


def edit_text(text: str, chance: random.Random, n: int) -> str:
    """Edit a text as a person at a keyboard may: comments, blank lines, layout."""
    lines = text.split("\n")
    at = chance.randrange(len(lines))
    kind = chance.choice(("above", "beside", "blank", "format", "tabs"))
    if kind == "above":
        lines.insert(at, f"{' ' * chance.choice((0, 4, 9))}# note {n}")
    elif kind == "beside" and lines[at].strip() and "#" not in lines[at]:
        lines[at] += f"  # note {n}"
    elif kind == "blank":
        lines.insert(at, "")
    elif kind == "format":
        return format_file(Source("a", text))
    elif kind == "tabs":
        return "\n".join(_with_tabs(line) for line in lines)
    return "\n".join(lines)


def _with_tabs(line: str) -> str:
    rest = line.lstrip(" ")
    deep, odd = divmod(len(line) - len(rest), 4)
    return line if odd or "\t" in line else "\t" * deep + rest


def journey(seed: int, texts: Sequence[str]) -> int:
    """Go to and fro between both views; return how many edits of blocks were made."""
    chance = random.Random(seed)
    text = chance.choice(texts)
    made = 0
    for n in range(8):
        before = text
        text = edit_text(text, chance, n)
        document = Document.of(text)
        if document.diagnostics:  # lines in parentheses may not hold tabs beside spaces
            text, document = before, Document.of(before)
        assert words(text) == words(before)
        assert comments(before) <= comments(text)
        edit = any_edit(document, chance)
        if edit is None or (done := check(document, edit)) is None:
            continue
        assert TextChange.between(text, done.text) == done.change
        text = done.text
        made += 1
    return made


@pytest.mark.long
def test_journeys_between_both_views_lose_no_comment_and_no_word() -> None:
    assert sum(journey(n, TEXTS) for n in range(3)) > 9


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, 1000, 50))
def test_a_thousand_journeys_lose_no_comment_and_no_word(first: int) -> None:
    """Texts of libraries are long; these are the short ones."""
    short = [text for text in TEXTS if len(text) < SHORT]
    assert len(short) >= 30
    assert sum(journey(first + n, short) for n in range(50)) > 150
