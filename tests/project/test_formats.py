"""Pages and help texts name the formats there are: all of a table in azee.formats, in order."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from click.testing import CliRunner

from azee.cli.main import azee
from azee.formats import CLIP_WRITERS, RENDER_SUFFIXES, SCORE_WRITERS, WRITERS

ROOT = Path(__file__).parents[2]
TABLES = {
    "of a compilation": [*WRITERS],
    "of a clip": [*CLIP_WRITERS],
    "of a score": [*SCORE_WRITERS],
    "of pictures and films": [*RENDER_SUFFIXES],
}
PAGES = sorted(
    page
    for pattern in ("*.md", "docs/**/*.md", "examples/**/*.md", "examples/*/*.ipynb", "Makefile")
    for page in ROOT.glob(pattern)
    if page.name != "CHANGELOG.md" and "adr" not in page.parts
)
SUFFIX = rf"`?(?:{'|'.join(map(re.escape, WRITERS))})\b`?"
NAME = rf"(?:{'|'.join(suffix[1:].upper() for suffix in WRITERS)}|ELAN|WebM)\b"
BETWEEN = r"(?:, | and | or | · |\\?\||/| )"


def lists(text: str, item: str) -> Iterator[str]:
    """Yield where a text lists three items or more."""
    for found in re.finditer(rf"{item}(?:{BETWEEN}{item}){{2,}}", text):
        yield found[0]


def test_lists_are_found() -> None:
    text = "It writes `.glb`, `.bvh` or `.json`; /score [FILE.svg\\|.png\\|.eaf]; GLB, BVH and PNG."
    assert [*lists(text, SUFFIX)] == ["`.glb`, `.bvh` or `.json`", ".svg\\|.png\\|.eaf"]
    assert [*lists(text, NAME)] == ["GLB, BVH and PNG"]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_page_that_lists_formats_lists_all_of_a_table(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    for found in lists(text, SUFFIX):
        hint = f"{found} is no table of azee.formats, or not in its order: list all of one"
        assert re.findall(r"\.\w+", found) in TABLES.values(), hint
    assert [*lists(text, NAME)] == []  # names are not tested: list suffixes


def test_the_page_of_formats_has_a_row_and_a_section_for_each() -> None:
    page = (ROOT / "docs" / "formats.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| \[((?:`\.\w+` ?)+)\]\(#([\w-]+)\)", page, re.M)
    suffixes = [suffix for row, _ in rows for suffix in re.findall(r"\.\w+", row)]
    hint = "docs/formats.md has a row for each of azee.formats.WRITERS, in order"
    assert suffixes == TABLES["of a compilation"], hint
    headings = {
        heading.lower().replace(" ", "-") for heading in re.findall(r"^## (.+)$", page, re.M)
    }
    assert {anchor for _, anchor in rows} <= headings


def test_a_test_names_a_file_of_every_format() -> None:
    """Tests that go over a table see that files are written, not what is in them."""
    texts = (p.read_text(encoding="utf-8") for p in (ROOT / "tests").glob("*/test_*.py"))
    found = {suffix for text in texts for suffix in re.findall(r"(?<=\w)\.\w+(?=\")", text)}
    assert {*WRITERS} - found == set(), "no test reads these: write one in tests/export"


@pytest.mark.parametrize(
    ("command", "table"),
    [
        ("compile", "of a compilation"),
        ("batch", "of a compilation"),
        ("score", "of a score"),
        ("render", "of pictures and films"),
        ("retarget", "of a clip"),
        ("clip cut", "of a clip"),
        ("clip join", "of a clip"),
    ],
)
def test_help_names_all_that_a_command_writes(command: str, table: str) -> None:
    told = CliRunner().invoke(azee, [*command.split(), "--help"]).output
    found = [re.findall(r"\.\w+", words) for words in lists(" ".join(told.split()), SUFFIX)]
    assert TABLES[table] in found
