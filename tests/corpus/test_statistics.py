"""Counts of corpora: those of the examples by hand, laws for any."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Sequence
from pathlib import Path

import pytest

from azee.cli.corpus import TABLES as OFFERED
from azee.corpus.statistics import NO_RULE, CorpusStatistics
from azee.corpus.tables import TABLES, as_csv, as_json, as_text, columns_of, rows_of, summary
from azee.lang.program import load
from azee_grammar.files import read_source
from azee_grammar.source import Source

EXAMPLES = Path(__file__).parents[2] / "examples"
COUNTED = ("cinema-good", "iraq-there", "not-but", "person-aged-52", "tree")
"""The folders of examples that were counted by hand; not-but has two texts."""


def corpus(*texts: str) -> CorpusStatistics:
    return CorpusStatistics.of(load(Source(f"{i}.azee", text)) for i, text in enumerate(texts))


@pytest.fixture(scope="module")
def examples() -> CorpusStatistics:
    paths = [path for name in COUNTED for path in sorted((EXAMPLES / name).glob("*.azee"))]
    assert len(paths) == 6
    return CorpusStatistics.of(load(read_source(path)) for path in paths)


# The examples, counted by hand ------------------------------------------------------------------


def test_rules_of_the_examples(examples: CorpusStatistics) -> None:
    """cinema 3, iraq 4, not-but twice 3, person 7, tree none."""
    assert [len(utterance) for utterance in examples.utterances] == [3, 4, 3, 3, 7, 0]
    assert [(r.rank, r.rule, r.occurrences, r.texts) for r in examples.rules] == [
        (1, "info-about", 3, 2),
        (2, "arbre", 2, 2),
        (3, "armoire", 2, 2),
        (4, "nicht-sondern", 2, 2),
        *(
            (rank, name, 1, 1)
            for rank, name in enumerate(
                (
                    *("Irak", "about-ref", "bien", "cinéma", "instance-of", "nb-2", "nb-5"),
                    *("pays", "personne", "tens-units", "âge"),
                ),
                5,
            )
        ),
    ]
    first, second = examples.rules[:2]
    assert (first.share, first.covered, second.covered) == (3 / 20, 3 / 20, 5 / 20)
    assert (first.depth_least, first.depth_mean, first.depth_most) == (0, 1 / 3, 1)
    assert (first.library, second.library) == ("core", "lsf")


def test_arguments_of_the_examples(examples: CorpusStatistics) -> None:
    found = [(a.rule, a.argument, a.holds, a.occurrences) for a in examples.arguments]
    assert found == [
        ("about-ref", "pt", NO_RULE, 1),
        ("about-ref", "sig", "instance-of", 1),
        ("info-about", "info", "bien", 1),
        ("info-about", "info", "info-about", 1),
        ("info-about", "info", "tens-units", 1),
        ("info-about", "topic", "cinéma", 1),
        ("info-about", "topic", "personne", 1),
        ("info-about", "topic", "âge", 1),
        ("instance-of", "elt", "Irak", 1),
        ("instance-of", "type", "pays", 1),
        ("nicht-sondern", "nicht", "arbre", 2),
        ("nicht-sondern", "sondern", "armoire", 2),
        ("tens-units", "tens", "nb-5", 1),
        ("tens-units", "units", "nb-2", 1),
    ]


def test_depths_and_pairs_of_the_examples(examples: CorpusStatistics) -> None:
    # outermost: info-about, about-ref, nicht-sondern twice, info-about
    # 1: cinéma bien, instance-of, arbre armoire twice, personne info-about
    # 2: pays Irak, âge tens-units; 3: nb-5 nb-2
    assert [(d.depth, d.applications) for d in examples.depths] == [(0, 5), (1, 9), (2, 4), (3, 2)]
    twice = {(p.first, p.second) for p in examples.pairs if p.utterances == 2}
    assert twice == {
        ("arbre", "armoire"),
        ("arbre", "nicht-sondern"),
        ("armoire", "nicht-sondern"),
    }
    # 3 pairs of the cinema, 6 of Iraq, 15 of the six different rules of the person
    assert sum(p.utterances == 1 for p in examples.pairs) == 24


def test_the_examples_are_known_as_a_whole(examples: CorpusStatistics) -> None:
    assert examples.unknown == []
    assert summary(examples) == (
        "6 texts, 6 utterances, 20 applications of 15 rules\n"
        "of known rules: 20 of 20 applications (100%), all in 6 of 6 texts"
    )


# Any corpus -------------------------------------------------------------------------------------


def test_unknown_rules_come_by_rank_and_lower_the_coverage() -> None:
    found = corpus(":fall\n    'on :lake\n:fall\n", ":bien\n", "def tea\n    :lake\n")
    assert [(u.rank, u.rule, u.occurrences) for u in found.unknown] == [
        (1, "fall", 2),
        (3, "lake", 1),
    ]
    assert (found.known, len(found.applications), found.whole_texts) == (1, 4, 1)
    assert summary(found) == (
        "3 texts, 3 utterances, 4 applications of 3 rules\n"
        "of known rules: 1 of 4 applications (25%), all in 1 of 2 texts"
    )


def test_an_argument_without_a_rule_is_told_apart_from_one_that_is_not_given() -> None:
    found = corpus("tens-units(.nb-5, .nb-2)\ntens-units(.nb-5, .nb-2, 'loc = ^Rssp)\n")
    assert [(a.argument, a.holds, a.occurrences) for a in found.arguments] == [
        ("loc", NO_RULE, 1),
        ("tens", "nb-5", 2),
        ("units", "nb-2", 2),
    ]


def test_a_list_holds_each_of_its_rules() -> None:
    found = corpus(":all\n    'items list(:bien, :chat, :bien)\n")
    assert [(a.holds, a.occurrences) for a in found.arguments] == [("bien", 2), ("chat", 1)]


def test_a_pair_counts_once_in_an_utterance() -> None:
    found = corpus("seq(list(:bien, :chat, :bien, :chat))\n:bien\n:chat\nseq(list(:chat, :bien))\n")
    assert [(p.first, p.second, p.utterances) for p in found.pairs] == [("bien", "chat", 2)]


@pytest.mark.parametrize(
    "texts", [(), ("",), ("key 1 (look ^fwd)\n",), (":bien\n", ":a\n    'x :b\n    'y 3\n")]
)
def test_totals_agree(texts: Sequence[str]) -> None:
    found = corpus(*texts)
    total = len(found.applications)
    assert sum(rule.occurrences for rule in found.rules) == total
    assert sum(depth.applications for depth in found.depths) == total
    assert [rule.rank for rule in found.rules] == list(range(1, len(found.rules) + 1))
    assert sum(rule.share for rule in found.rules) == pytest.approx(1 if total else 0)
    assert not found.rules or found.rules[-1].covered == 1
    assert summary(found).startswith(f"{len(texts)} text")


# Tables -----------------------------------------------------------------------------------------


def test_the_command_offers_every_table() -> None:
    assert tuple(TABLES) == OFFERED


@pytest.mark.parametrize("table", TABLES)
def test_csv_and_json_have_the_same_rows(table: str, examples: CorpusStatistics) -> None:
    rows = list(csv.DictReader(io.StringIO(as_csv(examples, table))))
    known = json.loads(as_json(examples))[table]
    assert len(rows) == len(known) == len(rows_of(examples, table))
    for row, other in zip(rows, known, strict=True):
        assert list(row) == list(other) == columns_of(table)
        assert list(row.values()) == ["" if v is None else str(v) for v in other.values()]


def test_a_table_for_people_has_columns_and_tells_what_it_leaves_out() -> None:
    tea = 'def tea\n    \'status "published"\n    blank 1\n\n'
    found = corpus(f"{tea}:fall\n    'on :lake\n:tea\n:tea\n")
    lines = as_text(found, "rules", 2).split("\n")
    assert lines[0].startswith("rank  rule  library  status     known  occurrences")
    assert lines[1].startswith("   1  tea   –        published  yes              2")
    assert lines[2].startswith("   2  fall  –        –          no               1")
    assert lines[3] == "… and 1 more"
    assert as_text(corpus(":bien\n"), "depths") == "depth  applications\n    0             1"
