"""Links in the project's pages lead somewhere, and README shows its moving picture."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageSequence

ROOT = Path(__file__).parents[2]
PAGES = sorted(
    page
    for folder in (ROOT, ROOT / "docs", ROOT / "examples")
    for page in (folder.glob("*.md") if folder == ROOT else folder.rglob("*.md"))
)
LINK = re.compile(r"\]\((?!\w+:)([^)#\s]+)(?:#[^)]*)?\)")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_to_files_that_exist(page: Path) -> None:
    links = LINK.findall(page.read_text(encoding="utf-8"))
    assert [link for link in links if not (page.parent / link).exists()] == []


def test_the_index_of_the_documents_names_every_page() -> None:
    index = (ROOT / "docs" / "README.md").read_text(encoding="utf-8")
    pages = {page.name for page in (ROOT / "docs").glob("*.md")} - {"README.md"}
    assert pages - set(LINK.findall(index)) == set()


def test_readme_opens_with_a_small_picture_that_moves_and_repeats_without_a_jump() -> None:
    (_, opening, *_) = (ROOT / "README.md").read_text(encoding="utf-8").split("\n\n")
    (shown,) = LINK.findall(opening)
    assert (ROOT / shown).stat().st_size < 2_000_000
    with Image.open(ROOT / shown) as picture:
        assert 400 <= picture.width <= 500
        assert picture.info["loop"] == 0
        frames, durations_ms = [], []
        for frame in ImageSequence.Iterator(picture):
            frames.append(np.asarray(frame.convert("RGB"), dtype=float))
            durations_ms.append(frame.info["duration"])
    assert all(1000 / 15 - 1 <= ms <= 1000 / 12 + 1 for ms in durations_ms)
    steps = [np.abs(after - before).mean() for before, after in pairwise([*frames, frames[0]])]
    assert max(steps) > 5
    assert steps[-1] < 1
