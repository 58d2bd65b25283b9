"""docs/lexicon.md: its rule is sound, and every kind of loss is explained."""

from __future__ import annotations

import ast
import re
from pathlib import Path

from pages import ROOT, blocks

import azee.lexicon
from azee.lang.program import load
from azee_grammar.format import format_file
from azee_grammar.source import Source

PAGE = (ROOT / "docs" / "lexicon.md").read_text(encoding="utf-8")


def _told() -> set[str]:
    """Every kind of approximation that the writer tells, from its source."""
    found = set()
    for path in sorted(Path(azee.lexicon.__path__[0]).glob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.Call) or not node.args:
                continue
            name = getattr(node.func, "attr", getattr(node.func, "id", ""))
            first = node.args[0]
            if name in ("told", "notes") and isinstance(first, ast.Constant):
                found.add(str(first.value))
    return found


def test_the_rule_of_the_page_is_sound_and_canonical() -> None:
    (example,) = [block for block in blocks(PAGE) if block.kind == "azee"]
    assert load(Source("page", example.text + ":ngt-goed\n")).check() == ()
    assert format_file(Source("page", example.text)) == example.text


def test_every_kind_of_loss_is_on_the_page() -> None:
    assert azee.lexicon.__doc__
    told = _told()
    assert len(told) > 10
    table = PAGE[PAGE.index("## What is lost") : PAGE.index("Faults of notations")]
    listed = set(re.findall(r"`([a-z-]+)`", table))
    assert told - listed == {"behind"} - listed
