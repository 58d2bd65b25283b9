"""Whatever is evaluated gives a score or diagnostics with places, and nothing else."""

from __future__ import annotations

import pytest
from any_programs import programs
from evaluations import NAME, program
from hypothesis import given

from azee.lang.machine import Limits
from azee_grammar.diagnostic import AZeeError

LIMITS = Limits(depth=100, steps=5000, size=2000)


@pytest.mark.long
@given(programs)
def test_any_program_evaluates_or_says_what_is_wrong(text: str) -> None:
    loaded = program(text, limits=LIMITS)
    problems = loaded.check()
    for problem in problems:
        assert problem.message
        assert problem.span is not None
        stack = [related.span.source.name for related in problem.related]
        assert NAME in (problem.span.source.name, *stack)
    assert problems == program(text, limits=LIMITS).check()
    if problems:
        with pytest.raises(AZeeError):
            loaded.score()
    else:
        assert loaded.score().duration >= 0
