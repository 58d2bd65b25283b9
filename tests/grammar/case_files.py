"""Files of cases: a title, a text, what becomes of it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import pytest


@dataclass(frozen=True)
class Case:
    """`escaped`: the title says that the text is written with escapes."""

    title: str
    text: str
    expected: str
    escaped: bool


def read_cases(*files: Path) -> list[object]:
    """Parameters for pytest, one a case."""
    return [
        pytest.param(case, id=f"{file.stem}: {case.title}")
        for file in files
        for part in re.split(r"(?m)^### ", file.read_bytes().decode())[1:]
        for case in [_case(part)]
    ]


def _case(part: str) -> Case:
    title, _, rest = part.partition("\n")
    before, arrow, after = f"\n{rest}".partition("\n==>\n")
    assert arrow, f"case without ==>: {title}"
    escaped = title.endswith(" [escaped]")
    text = before[1:]
    if escaped:
        text = text.encode("ascii").decode("unicode_escape")
    expected = after.rstrip("\n")
    return Case(
        title.removesuffix(" [escaped]"), text, f"{expected}\n" if expected else "", escaped
    )
