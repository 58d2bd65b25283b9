"""The pages of docs/language about evaluation: their blocks evaluate, their lists are complete."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import pytest
from evaluations import found

from azee.lang.machine import DEFAULT_LIMITS
from azee.lang.manual import operators
from azee.lang.registry import NATIVES
from azee.lang.sync_shape import RULES
from azee.lang.values import Kind
from azee.score.score import CHANNELS

FOLDER = Path(__file__).parents[2] / "docs" / "language"
BLOCK = re.compile(
    r"^```azee(?: error=(?P<error>[a-z-]+ \d+:\d+))?\n(?P<text>.*?)^```$", re.M | re.S
)


@dataclass(frozen=True)
class Example:
    page: str
    line: int
    text: str
    error: str | None


def _examples(page: str) -> list[Example]:
    text = (FOLDER / page).read_text(encoding="utf-8")
    return [
        Example(page, text.count("\n", 0, m.start()) + 1, m["text"], m["error"])
        for m in BLOCK.finditer(text)
    ]


PAGES = ("sync.md", "evaluation.md", "movement.md")
EXAMPLES = [example for page in PAGES for example in _examples(page)]


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda e: f"{e.page}:{e.line}")
def test_a_block_evaluates_or_has_the_mistake_it_names(example: Example) -> None:
    assert found(example.text) == ([] if example.error is None else [example.error])


def test_every_block_of_the_pages_is_read() -> None:
    for page in PAGES:
        fences = (FOLDER / page).read_text(encoding="utf-8").count("```azee")
        assert len([e for e in EXAMPLES if e.page == page]) == fences > 1


def test_the_page_of_operators_is_written_from_their_declarations() -> None:
    written = (FOLDER / "operators.md").read_text(encoding="utf-8")
    assert written == operators(), "run: python -m azee.lang.manual > docs/language/operators.md"
    for name in NATIVES:
        assert f"### `{name}" in written


def test_the_page_of_sync_lists_its_rules_and_channels() -> None:
    page = (FOLDER / "sync.md").read_text(encoding="utf-8")
    for rule in RULES.values():
        row = rf"^\| `'{rule.word}` \((\w)\) \| .* \| {rule.meaning} \|$"
        found_row = re.search(row, page, re.MULTILINE)
        assert found_row is not None, rule.word
        assert found_row[1] == ("P" if rule.published else "O")
    assert "`" + " ".join(f"'{channel}" for channel in CHANNELS) + "`" in page


def test_the_page_of_values_lists_kinds_and_limits() -> None:
    page = (FOLDER / "evaluation.md").read_text(encoding="utf-8")
    for kind in Kind:
        assert re.search(rf"^\| .*\b{kind.value.split()[-1]}\b.* \|", page, re.M), kind
    for limit in (DEFAULT_LIMITS.depth, DEFAULT_LIMITS.steps, DEFAULT_LIMITS.size):
        assert f"{limit:,}" in page
