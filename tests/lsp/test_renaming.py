"""A rename, applied: the text after it is the one that a careful person would have written."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from lsprotocol import types

from azee.lsp.document import Document
from azee.lsp.renaming import renamed
from azee.lsp.texts import Texts

RULE = """\
def été
    'meaning "été"
    azop
        'où
        ^Rssp
        'quand (let 'où 2 ^où)
        key ^quand (place @CH ^où)
# 😀 :été is a comment
def 😀
    seq (list :été :été('où = ^Lssp) été() .été)
:été
    'où ^Mssp
    'quand 1
"""
SYNC = """\
def s
    azop
        'ref 'BASE:start
        sync
            'BASE :chat
            'SIG :chat
            'start 'BASE:start
            'GAZE seq(list(:chat, :chat))
            'start/dur 'SIG:start .5
            'LATE :chat
            'start ^ref
            'LAST (sync 'SIG :chat 'IN :chat 'start 'SIG:end)
            'end/dur 'GAZE/1:end .3
            'WITH (blank 1)
            'with 'SIG
            'BOTH (blank 1)
            'start/end 'SIG:start 'SIG:end
            'MIX (blank 1)
            'start/end ^ref 'SIG:end
:s
"""
PLACES = """\
places 'ici ^Rssp 'là vtranslate(^ici, ^up)
def f
    azop
        'ici
        ^ici
        key 1 (lookat ^ici)
key 1 (lookat ^ici)
"""
NAMED = [
    (
        PLACES,
        "places 'ici",
        8,
        "here",
        {
            "places 'ici": "places 'here",
            "vtranslate(^ici": "vtranslate(^here",
            "'ici\n        ^ici": "'ici\n        ^here",
            "\nkey 1 (lookat ^ici)": "\nkey 1 (lookat ^here)",
        },
    ),
    (
        RULE,
        "def été",
        4,
        "à l'eau",
        {
            "def été": "def à l'eau",
            "list :été :été('où = ^Lssp) été() .été": (
                "list :à l'eau :à l'eau('où = ^Lssp) :à l'eau() .à l'eau"
            ),
            "\n:été\n": "\n:à l'eau\n",
        },
    ),
    (
        RULE,
        "        'où\n",
        9,
        "x",
        {
            "        'où\n        ^Rssp": "        'x\n        ^Rssp",
            "@CH ^où": "@CH ^x",
            ":été('où =": ":été('x =",
            "    'où ^Mssp": "    'x ^Mssp",
        },
    ),
    (RULE, "let 'où", 5, "inner", {"let 'où 2 ^où": "let 'inner 2 ^inner"}),
    (
        SYNC,
        "            'SIG :chat",
        13,
        "A",
        {
            "'SIG :chat\n            'start 'BASE": "'A :chat\n            'start 'BASE",
            "'start/dur 'SIG:start .5": "'start/dur 'A:start .5",
            "'with 'SIG": "'with 'A",
            "'start/end 'SIG:start 'SIG:end": "'start/end 'A:start 'A:end",
            "'start/end ^ref 'SIG:end": "'start/end ^ref 'A:end",
        },
    ),
    (
        SYNC,
        "'GAZE seq",
        1,
        "G",
        {"'GAZE seq": "'G seq", "'end/dur 'GAZE/1:end .3": "'end/dur 'G/1:end .3"},
    ),
    (SYNC, "(sync 'SIG", 7, "S", {"(sync 'SIG": "(sync 'S", "'start 'SIG:end)": "'start 'S:end)"}),
]


def applied(text: str, edits: Sequence[types.TextEdit]) -> str:
    """Apply edits, whose columns count UTF-16 code units, independently of the server."""
    lines = [line.encode("utf-16-le") for line in text.split("\n")]
    for edit in sorted(edits, key=lambda e: (-e.range.start.line, -e.range.start.character)):
        start, end = edit.range.start, edit.range.end
        assert start.line == end.line
        line = lines[start.line]
        new = edit.new_text.encode("utf-16-le")
        lines[start.line] = line[: 2 * start.character] + new + line[2 * end.character :]
    return "\n".join(line.decode("utf-16-le") for line in lines)


@pytest.mark.parametrize(("text", "word", "skip", "name", "changes"), NAMED)
def test_a_rename_changes_every_use_and_nothing_else(
    text: str, word: str, skip: int, name: str, changes: dict[str, str]
) -> None:
    texts, document = Texts(), Document("untitled:a", text, 1)
    texts.put(document)
    found = texts.analysis(document).at(text.index(word) + skip)
    assert found is not None
    wanted = text
    for old, new in changes.items():
        assert wanted.count(old) == 1, old
        wanted = wanted.replace(old, new)
    edits = renamed(texts, found.target, name)
    assert applied(text, edits[document.uri]) == wanted
    for version in (document, Document("untitled:a", wanted, 2)):
        texts.put(version)
        assert texts.check(version) == ()


def test_a_rename_from_any_use_is_the_same() -> None:
    texts, document = Texts(), Document("untitled:a", RULE, 1)
    texts.put(document)
    uses = [o for o in texts.analysis(document).occurrences if o.target.name == "été"]
    assert len(uses) == 6
    for use in uses:
        assert document.text[use.span.start : use.span.end] == "été"
        at = texts.analysis(document).at(use.span.start)
        assert at is not None
        edits = renamed(texts, at.target, "mer")[document.uri]
        assert applied(RULE, edits).count("mer") == 6


def test_an_argument_that_its_rule_lacks_is_no_use_of_anything() -> None:
    rule = "def r\n    azop\n        'a\n        ^Mssp\n        key 1 (place @CH ^a)\n"
    text = f"{rule}:r('b = ^Lssp)\n:r('a = ^Lssp)\n"
    texts, document = Texts(), Document("untitled:a", text, 1)
    texts.put(document)
    analysis = texts.analysis(document)
    assert analysis.at(text.index("'b") + 1) is None
    given = analysis.at(text.index("'a = ") + 1)
    assert given is not None
    assert given.target.name == "a"
