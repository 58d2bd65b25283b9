"""The counts of a news brief among the examples, by hand."""

from __future__ import annotations

from pathlib import Path

from azee.corpus.statistics import CorpusStatistics
from azee.lang.program import load
from azee_grammar.files import read_source

BRIEF = Path(__file__).parents[2] / "examples" / "brief-heat" / "brief-heat.azee"


def test_the_brief_of_the_heat() -> None:
    found = CorpusStatistics.of([load(read_source(BRIEF))])
    # 0 in-context · 1 instance-of in-context · 2 mois août about-ref new-content
    # 3 instance-of info-about · 4 pays France big-threatening sequence-result
    # 5 intensity takes-a-while all-of · 6 chaud info-about (three) turn-taking-free
    # 7 cuisine much… element-count uneasy… landmark… peacefully yes-no-question decidedly
    # 8 chaud mult-around number negation cinéma building-cl libre info-about (two)
    # 9 personne bien cinéma libre maintenant bien
    assert [d.applications for d in found.depths] == [1, 2, 4, 2, 4, 3, 5, 8, 9, 6]
    assert len(found.applications) == 44
    several = {rule.rule: rule.occurrences for rule in found.rules if rule.occurrences > 1}
    assert several == {
        "info-about": 6,
        "bien": 2,
        "chaud": 2,
        "cinéma": 2,
        "in-context": 2,
        "instance-of": 2,
        "libre": 2,
    }
    assert found.unknown == []
    held = {(a.holds, a.occurrences) for a in found.arguments if a.rule == "all-of"}
    assert held == {("info-about", 2), ("turn-taking-free", 1)}
