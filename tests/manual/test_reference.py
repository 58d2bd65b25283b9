"""The reference tells of every token, operator, constant, sync rule, kind, name and page."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from pages import LANGUAGE, Block, blocks, page

import azee_grammar
from azee.lang.constants import CONSTANTS
from azee.lang.kinds_manual import ENTRIES, values
from azee.lang.program import load
from azee.lang.registry import NATIVES
from azee.lang.sync_shape import RULES
from azee.lang.values import Kind
from azee_grammar.names_manual import names
from azee_grammar.source import Source
from azee_grammar.vocabulary import BONES, MORPHS, SITES, WITHOUT_MORPH

TOKENS = {
    "RULE": "| `:name` |",
    "REFERENCE": "| `.name` |",
    "POSTURE": "| `:#name` |",
    "OPERATOR": "| a bare word |",
    "BONE": "| `!bone` |",
    "SITE": "| `@SITE` |",
    "NUMBER": "| `1` `.5` `-.4` |",
    "TEXT": '| `"text"` |',
    "SYMBOL": "| `'word` |",
    "PARAMETER": "| `^name` |",
    "HOLE": "| `?name` |",
    "SIDE": "| `s` `w` `L` `R` |",
    "_OPEN": "A parenthesis after a space begins an **operand**",
    "_CALL": "A parenthesis *directly behind* a name",
    "CLOSE": "A parenthesis that is never closed",
    "_COMMA": "Commas separate the operands",
    "_EQUALS": "`'name = value`",
    "_NEWLINE": "lines end\nwith LF, CRLF or CR",
    "_INDENT": "or extend the innermost",
    "_DEDENT": "It must repeat the indentation of an enclosing line",
    "USE": "`use 'name`",
    "DEF": "`def name`",
    "NAME": "the name is the rest of the line",
    "BROKEN": "After a mistake, the parser skips the line",
}
"""The words with which syntax.md describes each token of the grammar."""

EXAMPLES = list(blocks(page("values.md")))


def _flat(text: str) -> str:
    return " ".join(text.split())


def test_every_token_of_the_grammar_is_told_of() -> None:
    grammar = (Path(azee_grammar.__file__).parent / "azee.lark").read_text(encoding="utf-8")
    declared = re.findall(r"^%declare ([^/\n]+)", grammar, re.M)
    assert {name for line in declared for name in line.split()} == set(TOKENS)
    syntax = _flat(page("syntax.md"))
    assert [name for name, words in TOKENS.items() if _flat(words) not in syntax] == []


def test_every_operator_constant_and_sync_rule_is_told_of_and_marked() -> None:
    operators = page("operators.md")
    headings = re.findall(r"^### `([^` ]+)[^`]*` \((?:P|P, name|O)\)$", operators, re.M)
    assert sorted(headings) == sorted(NATIVES)
    rows = re.findall(r"^\| `([\^'])([^` ]+)[^`]*` \| .+ \| \([PO]\) \|$", operators, re.M)
    assert [name for sigil, name in rows if sigil == "^"] == list(CONSTANTS)
    assert [name for sigil, name in rows if sigil == "'"] == list(RULES)


def test_the_page_of_kinds_is_written_from_the_declarations() -> None:
    assert set(ENTRIES) == set(Kind)
    hint = "run: python -m azee.lang.kinds_manual > docs/language/values.md"
    assert page("values.md") == values(), hint


@pytest.mark.parametrize("block", EXAMPLES, ids=lambda block: block.options["kind"])
def test_the_example_of_a_kind_is_of_that_kind(block: Block) -> None:
    found = load(Source("values.md", "")).value(block.text)
    assert found.kind is Kind[block.options["kind"].upper()]


def test_the_page_of_names_is_written_from_the_tables() -> None:
    written = page("names.md")
    hint = "run: python -m azee_grammar.names_manual > docs/language/names.md"
    assert written == names(), hint
    heads = written.count("\n| --- |")
    rows = sum(line.startswith("| ") for line in written.splitlines()) - 2 * heads
    assert rows == len(BONES) + len(SITES) + len(MORPHS) + len(WITHOUT_MORPH)


def test_the_index_names_every_page() -> None:
    index = page("README.md")
    linked = set(re.findall(r"\]\(([\w-]+\.md)\)", index))
    assert linked == {path.name for path in LANGUAGE.glob("*.md")} - {"README.md"}
