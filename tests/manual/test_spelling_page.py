"""The examples of docs/spelling.md are evaluated, and last as long as the page says."""

from __future__ import annotations

import pytest
from pages import ROOT, Block, blocks

from azee.compilation import score_of
from azee.lang.program import load
from azee_grammar.source import Source

PAGE = ROOT / "docs" / "spelling.md"
EXAMPLES = [b for b in blocks(PAGE.read_text(encoding="utf-8")) if b.kind == "azee"]


@pytest.mark.parametrize("example", EXAMPLES, ids=str)
def test_an_example_of_spelling_lasts_as_long_as_it_says(example: Block) -> None:
    lasts_s = float(score_of(load(Source("spelling.md", example.text)), None, None).duration)
    assert lasts_s == pytest.approx(float(example.options.get("duration", lasts_s)), abs=0.005)


def test_the_page_has_examples_with_a_duration() -> None:
    assert [b for b in EXAMPLES if "duration" in b.options]
