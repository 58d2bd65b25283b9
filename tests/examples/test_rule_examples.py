"""The example that `azee rules NAME` shows of a rule: the body that ships can play it."""

from __future__ import annotations

import pytest

from azee.cli.main import run
from azee.compilation import lacks, perform
from azee.lang.library import shipped_library
from azee.lang.program import evaluate_expression
from azee_grammar.library import shipped_names
from azee_rig.rig import Rig

NAMES = [
    rule.name for name in shipped_names() for rule in shipped_library(name).namespace.rules.values()
]

each = pytest.mark.parametrize("name", NAMES)


def _example(name: str, capsys: pytest.CaptureFixture[str]) -> str:
    """The example as it is printed."""
    assert run(["rules", name]) == 0
    shown = capsys.readouterr().out
    return " ".join(shown[shown.index("\n  example   ") :].split()[1:])


@each
def test_an_example_applies_its_rule_and_needs_nothing_that_the_body_lacks(
    name: str, signer: Rig, capsys: pytest.CaptureFixture[str]
) -> None:
    example = _example(name, capsys)
    assert name in example
    assert lacks(evaluate_expression(example).score, signer) == ()


@pytest.mark.slow
@each
def test_an_example_compiles(name: str, signer: Rig, capsys: pytest.CaptureFixture[str]) -> None:
    score = evaluate_expression(_example(name, capsys)).score
    report = perform(score, signer, fps=10, life=False).report
    assert report.duration_s >= float(score.duration)
    assert report.max_excess_rad == 0
    assert [c.subject for c in report.constraints if not c.met and not (c.reason or c.price)] == []
