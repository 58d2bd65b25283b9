"""A study's pages, answers and analysis, without a browser."""

from __future__ import annotations

import json
import os
import random
import sqlite3
import subprocess
import sys
from collections import Counter
from contextlib import closing
from functools import partial
from itertools import combinations, permutations
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from programs import Python
from scipy.stats import ttest_rel

from azee.cli.main import run
from azee.spelling.study.analysis import analysed, pair_table, repeated_anova, t_tests
from azee.spelling.study.answers import Answers, AnswersError
from azee.spelling.study.bradley_terry import strengths
from azee.spelling.study.design import Design, DesignError, comparisons
from azee.spelling.study.manifest import ManifestError, read_manifest
from azee.spelling.study.questions import AGES, FLUENCIES
from azee.spelling.study.sample_size import choices_needed, participants_needed
from azee.spelling.timing.published import STUDIED

TYPES = ("variable", "motion", "normalised", "constant")
DESIGN = Design(TYPES, STUDIED)
TABLE_5_2 = np.array(
    [[0, 43, 48, 56], [37, 0, 47, 55], [32, 33, 0, 54], [24, 25, 26, 0]], dtype=float
)
"""Row preferred to column, in the order of `TYPES` (Wheatland 2016, table 5.2)."""


@given(st.integers(1, 500), st.integers(0, 99))
def test_48_pages_are_balanced(participant: int, seed: int) -> None:
    pages = comparisons(Design(TYPES, STUDIED, seed), participant)
    assert len(pages) == Design(TYPES, STUDIED).page_count == 48
    ordered = Counter((page.first, page.second) for page in pages)
    assert ordered == dict.fromkeys(permutations(TYPES, 2), 4)
    words = Counter((page.word, frozenset((page.first, page.second))) for page in pages)
    assert words == {(w, frozenset(p)): 1 for w in STUDIED for p in combinations(TYPES, 2)}
    assert pages == comparisons(Design(TYPES, STUDIED, seed), participant)


def test_participants_and_seeds_have_orders_of_their_own() -> None:
    orders = {comparisons(Design(TYPES, STUDIED, seed), n) for seed in (1, 2) for n in (1, 2, 3)}
    assert len(orders) == 6


@pytest.mark.parametrize(
    ("types", "words"), [(("a",), ("x", "y")), (("a", "b"), ("x",)), (("a", "a"), ("x", "y"))]
)
def test_a_design_that_cannot_be_balanced(types: tuple[str, ...], words: tuple[str, ...]) -> None:
    with pytest.raises(DesignError):
        Design(types, words)


def test_the_published_table_gives_the_logits_that_it_implies() -> None:
    model = strengths(TABLE_5_2)
    assert model.strengths == pytest.approx([0.95, 0.84, 0.58, 0], abs=0.006)
    assert not model.bounded
    assert model.p < 1e-4
    rows = {(row.first, row.second): row for row in pair_table(TYPES, TABLE_5_2)}
    assert rows["variable", "normalised"].p == pytest.approx(0.093, abs=0.001)
    assert max(rows[kind, "constant"].p for kind in TYPES[:3]) == pytest.approx(0.0023, abs=5e-5)


@settings(max_examples=40)
@given(st.lists(st.integers(1, 60), min_size=12, max_size=12))
def test_strengths_explain_how_often_each_was_chosen(wins: list[int]) -> None:
    """At the maximum, expected and observed choices agree; errors are those of Fisher."""
    table = np.zeros((4, 4))
    table[~np.eye(4, dtype=bool)] = wins
    model = strengths(table)
    beta = model.strengths
    p = 1 / (1 + np.exp(beta[None, :] - beta[:, None]))
    shown = table + table.T
    np.testing.assert_allclose((shown * p).sum(axis=1), table.sum(axis=1), rtol=1e-6)
    difference, error = model.difference(0, 1)
    assert difference == pytest.approx(beta[0] - beta[1])
    w = shown * p * (1 - p)
    information = np.diag(w.sum(axis=1)) - w
    assert error**2 == pytest.approx(
        np.array([1, -1, 0, 0]) @ np.linalg.pinv(information) @ np.array([1, -1, 0, 0])
    )


def test_two_things_have_the_logit_of_their_share() -> None:
    model = strengths(np.array([[0.0, 30.0], [10.0, 0.0]]))
    assert model.strengths[0] == pytest.approx(np.log(3))
    assert model.standard_errors[0] == pytest.approx(np.sqrt(1 / 30 + 1 / 10))


def test_what_always_wins_gets_half_a_choice_against_it() -> None:
    model = strengths(np.array([[0.0, 20.0], [0.0, 0.0]]))
    assert model.bounded
    assert model.strengths[0] == pytest.approx(np.log(20.5 / 0.5))


COUNTS = st.lists(
    st.lists(st.integers(0, 24), min_size=2, max_size=2), min_size=3, max_size=12
).map(lambda rows: np.array(rows, dtype=float))


@given(COUNTS, st.lists(st.integers(-50, 50), min_size=12, max_size=12))
def test_analysis_of_variance_of_two_types_is_the_paired_t_test(
    counts: np.ndarray, own: list[int]
) -> None:
    found = repeated_anova(counts)
    if np.ptp(counts[:, 0] - counts[:, 1]) == 0:
        assert found is None
        return
    assert found is not None
    test = ttest_rel(counts[:, 0], counts[:, 1])
    assert found[0] == pytest.approx(test.statistic**2, abs=1e-9)
    assert found[3] == pytest.approx(test.pvalue)
    moved = repeated_anova(counts + np.array(own[: len(counts)])[:, None])
    assert moved is not None
    assert moved[0] == pytest.approx(found[0], abs=1e-6)


def test_holm_corrects_the_smallest_p_most() -> None:
    rng = np.random.default_rng(0)
    counts = rng.integers(0, 20, (10, 3)) + np.array([8, 2, 0])
    rows = sorted(t_tests(("a", "b", "c"), counts.astype(float)), key=lambda d: d.p)
    assert rows[0].p_holm == pytest.approx(min(1, 3 * rows[0].p))
    assert rows[1].p_holm == pytest.approx(min(1, max(2 * rows[1].p, rows[0].p_holm)))
    assert rows[0].p_holm <= rows[1].p_holm <= rows[2].p_holm


def test_types_that_always_differ_by_the_same_have_no_t_test() -> None:
    counts = np.array([[5, 3, 9], [6, 4, 7], [9, 7, 8], [2, 1, 1]], dtype=float)
    assert [(d.first, d.second) for d in t_tests(("a", "b", "c"), counts[:3])] == [
        ("a", "c"),
        ("b", "c"),
    ]
    assert len(t_tests(("a", "b", "c"), counts)) == 3  # a and b differ by 2, 2, 2 and 1
    assert t_tests(("a", "b", "c"), counts[:1]) == []


def test_the_sample_size_has_its_power() -> None:
    """Simulated: so many choices tell .6 from .5 in about four of five studies."""
    from scipy.stats import binom, norm

    n = choices_needed()
    assert n == 194
    assert participants_needed(8) == 25
    bound = norm.ppf(0.975) * np.sqrt(n) / 2
    told = binom.sf(n / 2 + bound, n, 0.6) + binom.cdf(n / 2 - bound, n, 0.6)
    assert told == pytest.approx(0.80, abs=0.025)


class _Hasty(sqlite3.Connection):
    """Does not wait for the disk: twelve hundred answers would wait for half a minute."""

    def execute(self, sql: str, *parameters: Any) -> sqlite3.Cursor:
        return super().execute(sql.replace("synchronous = FULL", "synchronous = OFF"), *parameters)


def _filled(path: Path, people: int, planted: dict[str, float], seed: int = 0) -> Answers:
    hasty = partial(sqlite3.connect, factory=_Hasty)
    with mock.patch("sqlite3.connect", hasty), closing(sqlite3.connect(path)):
        return _answered(path, people, planted, seed)


def _answered(path: Path, people: int, planted: dict[str, float], seed: int) -> Answers:
    rng = random.Random(seed)
    answers = Answers.create(path, DESIGN)
    for i in range(people):
        person = answers.begin(f"key-{i}", AGES[i % 6], FLUENCIES[i % 5], "", "")
        for number, page in enumerate(comparisons(DESIGN, person.number), 1):
            apart = planted[page.first] - planted[page.second]
            first = rng.random() < 1 / (1 + np.exp(-apart))
            answers.choose(person, number, "first" if first else "second")
        answers.finish(person, ["", "GUITAR"])
    return answers


@pytest.mark.long
def test_planted_preferences_come_out(tmp_path: Path) -> None:
    planted = {"variable": 0.9, "motion": 0.8, "normalised": 0.3, "constant": -1.0}
    found = analysed(_filled(tmp_path / "a.sqlite", 25, planted))
    for i, j in combinations(range(4), 2):
        wanted = planted[TYPES[i]] - planted[TYPES[j]]
        difference, error = found.model.difference(i, j)
        assert abs(difference - wanted) < 3 * error
        assert error < 0.2
    assert found.choice_count == 25 * 48
    assert found.counts.sum() == found.wins.sum()
    assert (found.shown == 24).all()
    assert found.anova is not None
    assert found.anova[3] < 1e-6
    of_choices, of_shown = found.shares()["constant"]
    assert of_shown == pytest.approx(2 * of_choices)
    assert {row[2] for row in found.remarks} == {"GUITAR"}


def test_choices_that_are_indifferent_show_no_preference(tmp_path: Path) -> None:
    found = analysed(_filled(tmp_path / "a.sqlite", 10, dict.fromkeys(TYPES, 0.0)))
    assert found.model.p > 0.05
    assert np.abs(found.model.strengths).max() < 0.6


def test_no_difference_is_half_a_choice_for_each(tmp_path: Path) -> None:
    answers = Answers.create(tmp_path / "a.sqlite", Design(TYPES, STUDIED, no_difference=True))
    person = answers.begin("key", AGES[0], FLUENCIES[0], "", "")
    for page in range(1, 49):
        answers.choose(person, page, "none")
    found = analysed(answers)
    np.testing.assert_allclose(found.wins, 4 * (1 - np.eye(4)))
    np.testing.assert_allclose(found.model.strengths, 0, atol=1e-9)


def test_answers_of_another_study_and_other_files_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.sqlite"
    _filled(path, 1, dict.fromkeys(TYPES, 0.0))
    assert Answers.open(path).design == DESIGN
    assert len(Answers.create(path, DESIGN).participants()) == 1
    with pytest.raises(AnswersError, match="another study"):
        Answers.create(path, Design(TYPES, STUDIED, seed=2))
    (tmp_path / "b.sqlite").write_text("no database at all, but long enough to be looked at")
    for opened in (Answers.open, lambda p: Answers.create(p, DESIGN)):
        with pytest.raises(AnswersError, match="holds no answers"):
            opened(tmp_path / "b.sqlite")
    sqlite3.connect(tmp_path / "c.sqlite").close()
    with pytest.raises(AnswersError, match="holds no answers"):
        Answers.open(tmp_path / "c.sqlite")
    with pytest.raises(FileNotFoundError):
        Answers.open(tmp_path / "d.sqlite")


def test_a_choice_that_was_acknowledged_survives_a_kill(tmp_path: Path) -> None:
    """A process that writes and says so is killed in the middle of its work."""
    script = """
import sys
from azee.spelling.study.answers import Answers
from azee.spelling.study.design import Design
answers = Answers.create(sys.argv[1], Design(("a", "b"), tuple(map(str, range(2000)))))
person = answers.begin("key", "", "", "", "")
for page in range(1, 2001):
    answers.choose(person, page, "second")
    print(page, flush=True)
"""
    path = tmp_path / "a.sqlite"
    with subprocess.Popen(
        [sys.executable, "-c", script, str(path)],
        stdout=subprocess.PIPE,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)},
        text=True,
    ) as process:
        assert process.stdout is not None
        seen = [int(next(process.stdout)) for _ in range(30)]
        process.kill()
        seen += [int(line) for line in process.stdout if line.endswith("\n")]
    assert len(seen) < 2000
    answers = Answers.open(path)
    kept = answers.choices(answers.participants()[0])
    assert set(seen) <= set(kept) <= {*seen, len(seen) + 1}


@pytest.fixture
def clips(tmp_path: Path) -> Path:
    folder = tmp_path / "clips"
    folder.mkdir()
    for word in ("GUITAR", "DAVID"):
        for kind in ("variable", "constant"):
            (folder / f"{word}-{kind}.mp4").write_bytes(b"film")
    return folder


def test_a_manifest_of_the_names_of_files(clips: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["study", "manifest", str(clips), "--seed", "4", "--no-difference"]) == 0
    assert "2 words as constant, variable: 2 pages a participant" in capsys.readouterr().err
    made = read_manifest(clips)
    assert made.design == Design(("constant", "variable"), ("DAVID", "GUITAR"), 4, True)
    assert made.clips["DAVID", "variable"] == clips / "DAVID-variable.mp4"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"format": "x"}, "is no manifest of a study"),
        ({"version": 2}, "is of version 2"),
        ({"words": ["GUITAR"]}, "even number of words"),
        ({"types": ["variable", "motion"]}, "no clip of `DAVID` as `motion`"),
        ({"sample": "../../etc/passwd.mp4"}, "outside of the study's folder"),
        ({"sample": "none.mp4"}, "there is no file"),
        ({"sample": "manifest.json"}, "is none of .mp4"),
        ({"seed": "x"}, "is damaged"),
        ({"clips": 3}, "is damaged"),
        ({"types": None}, "is damaged"),
    ],
)
def test_a_manifest_that_cannot_be_used(
    clips: Path, change: dict[str, object], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    run(["study", "manifest", str(clips)])
    path = clips / "manifest.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | change))
    with pytest.raises(ManifestError, match=message):
        read_manifest(clips)
    assert run(["study", "serve", str(clips)]) == 1
    assert "error[not-a-study]" in capsys.readouterr().err


def test_a_report_with_plots(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    planted = {"variable": 1.0, "motion": 0.5, "normalised": 0.0, "constant": -1.0}
    _filled(tmp_path / "a.sqlite", 4, planted)
    out = tmp_path / "out"
    assert run(["study", "analyse", str(tmp_path / "a.sqlite"), "-o", str(out)]) == 0
    names = {"report.html", "analysis.json", "choices.csv", "figure-5-4.png", "strengths.png"}
    assert {path.name for path in out.iterdir()} == names
    rows = (out / "choices.csv").read_text().splitlines()
    assert len(rows) == 1 + 4 * 48
    assert "4 participants, 192 choices" in capsys.readouterr().err
    page = (out / "report.html").read_text("utf-8")
    assert "needs 194 choices: 25 participants. The pair with the fewest has 32." in page


def test_nothing_to_analyse_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Answers.create(tmp_path / "a.sqlite", DESIGN)
    assert run(["study", "analyse", str(tmp_path / "a.sqlite"), "-o", str(tmp_path / "o")]) == 1
    assert "nobody has chosen anything yet" in capsys.readouterr().err


def test_without_the_extra_a_message_says_what_to_install(python: Python, clips: Path) -> None:
    run(["study", "manifest", str(clips)])
    script = (
        "import sys; sys.modules['starlette'] = None; sys.modules['uvicorn'] = None\n"
        "from azee.cli.main import run; sys.exit(run(sys.argv[1:]))"
    )
    done = python("-c", script, "study", "serve", str(clips), expect=1)
    assert "pip install 'azee[study]'" in done.stderr
