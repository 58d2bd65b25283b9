"""docs/handshapes.md: what it says can be written, and it names every shape that ships."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from pages import Block, blocks

from azee.lang.library import shipped_library
from azee.lang.program import load
from azee_grammar.source import Source

PAGE = (Path(__file__).parents[2] / "docs" / "handshapes.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("block", [b for b in blocks(PAGE) if b.kind == "azee"], ids=str)
def test_a_block_is_right(block: Block) -> None:
    assert load(Source("page.azee", block.text)).check() == ()


def test_every_rule_of_the_file_is_on_the_page() -> None:
    named = set(re.findall(r"`(?::#|[:.])([a-z0-9-]+)(?:\([^`]*)?`", PAGE))
    rules = shipped_library("core").namespace.rules.values()
    ours = {r.name for r in rules if r.definition.span.source.name == "core/hamnosys.azee"}
    assert ours == named
