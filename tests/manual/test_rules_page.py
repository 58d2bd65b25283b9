"""docs/rules.md: what it says can be written, and it names every facial and production rule."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from pages import Block, blocks

from azee.lang.library import shipped_library
from azee.lang.program import load
from azee_grammar.source import Source

PAGE = (Path(__file__).parents[2] / "docs" / "rules.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("block", [b for b in blocks(PAGE) if b.kind == "azee"], ids=str)
def test_a_block_is_right(block: Block) -> None:
    assert load(Source("page.azee", block.text)).check() == ()


def test_every_rule_that_the_page_names_ships() -> None:
    named = set(re.findall(r"`:([a-z-]+)[`(]", PAGE))
    assert len(named) > 40
    shipped = [shipped_library(name).namespace.rules for name in ("core", "lsf")]
    assert [name for name in named if not any(name in rules for rules in shipped)] == []
