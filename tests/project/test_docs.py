"""Links and the map lead somewhere, and README shows its moving picture."""

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


def test_the_map_of_contributing_names_all_folders_and_modules() -> None:
    page = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    rows = "\n".join(line for line in page.splitlines() if line.startswith("| `"))
    named = re.findall(r"`((?:[\w.-]+/)+|azee/\w+\.py)`", rows)
    assert [name for name in named if not (ROOT / name).exists()] == []
    parts = (*ROOT.glob("azee/*/__init__.py"), *ROOT.glob("azee/motion/*/__init__.py"))
    there = {f"{p.parent.relative_to(ROOT).as_posix()}/" for p in parts}
    there |= {p.relative_to(ROOT).as_posix() for p in ROOT.glob("azee/[a-z]*.py")}
    there |= {f"{folder}/" for folder in ("grammar", "rig", "solver", "tests", "docs", "editors")}
    assert {p for p in there if not any(name.startswith(p) for name in named)} == set()


@pytest.mark.long
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
