"""The cases of tests/grammar/cases: what a text means, or what is wrong with it and where."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import case_notation as notation
import pytest

from azee_grammar.parser import parse
from azee_grammar.source import Source

CASES = Path(__file__).parent / "cases"


def cases() -> Iterator[object]:
    for file in sorted(CASES.glob("*.txt")):
        for case in re.split(r"(?m)^### ", file.read_bytes().decode())[1:]:
            title, _, rest = case.partition("\n")
            text, _, expected = f"\n{rest}".rpartition("\n==>\n")
            yield pytest.param(title, text[1:], expected.split("\n"), id=f"{file.stem}: {title}")


@pytest.mark.parametrize(("title", "text", "expected"), list(cases()))
def test_case(title: str, text: str, expected: list[str]) -> None:
    escaped = title.endswith("[escaped]")
    if escaped:
        text = text.encode("ascii").decode("unicode_escape")
    parsed = parse(Source("case", text))
    found = [notation.item(item) for item in parsed.file.items]
    found += [notation.diagnostic(problem) for problem in parsed.diagnostics]
    if escaped:
        found = [line.encode("unicode_escape").decode() for line in found]
    assert found == [line for line in expected if line]
