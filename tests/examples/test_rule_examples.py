"""The example that `azee rules NAME` shows of a rule: the body that ships can play it."""

from __future__ import annotations

import pytest

from azee.compilation import lacks, perform, score_of
from azee.lang.library import shipped_library
from azee.lang.program import load
from azee.lang.rule import Rule
from azee.lang.rule_example import example_text
from azee.score.score import Score
from azee_grammar.library import shipped_names
from azee_grammar.source import Source
from azee_rig.rig import Rig

RULES = [
    rule for name in shipped_names() for rule in shipped_library(name).namespace.rules.values()
]

each = pytest.mark.parametrize("rule", RULES, ids=lambda rule: f"{rule.library}-{rule.name}")


def _score(rule: Rule) -> Score:
    return score_of(load(Source(rule.name, example_text(rule))), None, None)


@each
def test_an_example_applies_its_rule_and_needs_nothing_that_the_body_lacks(
    rule: Rule, signer: Rig
) -> None:
    assert rule.name in example_text(rule)
    assert lacks(_score(rule), signer) == ()


@pytest.mark.slow
@each
def test_an_example_compiles(rule: Rule, signer: Rig) -> None:
    score = _score(rule)
    report = perform(score, signer, fps=10, life=False).report
    assert report.duration_s >= float(score.duration)
    assert report.max_excess_rad == 0
    assert [c.subject for c in report.constraints if not c.met and not (c.reason or c.price)] == []
