"""The cases of tests/grammar/cases: what a text means, or what is wrong with it and where."""

from __future__ import annotations

from pathlib import Path

import case_notation as notation
import pytest
from case_files import Case, read_cases

from azee_grammar.parser import parse
from azee_grammar.source import Source

CASES = sorted((Path(__file__).parent / "cases").glob("*.txt"))


@pytest.mark.parametrize("case", read_cases(*CASES))
def test_case(case: Case) -> None:
    parsed = parse(Source("case", case.text))
    found = [notation.item(item) for item in parsed.file.items]
    found += [notation.diagnostic(problem) for problem in parsed.diagnostics]
    if case.escaped:
        found = [line.encode("unicode_escape").decode() for line in found]
    assert found == case.expected.splitlines()
