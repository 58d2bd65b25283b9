"""What the answers to a study say: the tests of Wheatland (2016, section 5.4), and better ones."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import binomtest, f, ttest_rel

from azee.spelling.study.answers import Answers, Participant
from azee.spelling.study.bradley_terry import Strengths, strengths
from azee.spelling.study.design import Design, comparisons
from azee.spelling.study.sample_size import choices_needed, participants_needed

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Pair:
    """A row of table 5.2.

    p: of the exact two-sided binomial test against one half; half choices are rounded so that it
    does not become more certain.
    """

    first: str
    second: str
    for_first: float
    for_second: float
    p: float


@dataclass(frozen=True, slots=True)
class Difference:
    """A paired t test between the choices of two types. p_holm: corrected for all of them."""

    first: str
    second: str
    t: float
    p: float
    p_holm: float


@dataclass(frozen=True, eq=False)
class Analysis:
    """What was found.

    counts: (participants, types), how often each chose each type. shown: how often each type was
    shown to each, (participants, types). wins: (types, types), how often the row's type was
    preferred to the column's. anova: F, its two degrees of freedom and p. first_share: of choices
    that fell on the first clip, and p.
    """

    design: Design
    participants: Sequence[Participant]
    counts: Array
    shown: Array
    wins: Array
    pairs: Sequence[Pair]
    differences: Sequence[Difference]
    anova: tuple[float, int, int, float] | None
    model: Strengths
    first_share: tuple[float, float]
    remarks: Sequence[tuple[int, int, str]]

    @property
    def choice_count(self) -> float:
        """Number of choices."""
        return float(self.wins.sum())

    def shares(self) -> Mapping[str, tuple[float, float]]:
        """Return of each type the share of all choices, and of the times that it was shown."""
        chosen, shown = self.counts.sum(axis=0), self.shown.sum(axis=0)
        return {
            kind: (float(chosen[i] / max(chosen.sum(), 1)), float(chosen[i] / max(shown[i], 1)))
            for i, kind in enumerate(self.design.types)
        }

    def to_json(self) -> dict[str, Any]:
        """Return all figures."""
        types = self.design.types
        errors = self.model.standard_errors
        return {
            "participants": len(self.participants),
            "finished": sum(p.finished for p in self.participants),
            "choices": self.choice_count,
            "choices_needed_a_pair": choices_needed(),
            "participants_needed": participants_needed(len(self.design.words)),
            "shares": {
                kind: {"of_choices": round(a, 4), "of_times_shown": round(b, 4)}
                for kind, (a, b) in self.shares().items()
            },
            "pairs": [
                {
                    "types": [pair.first, pair.second],
                    "choices": [pair.for_first, pair.for_second],
                    "p": _rounded(pair.p),
                }
                for pair in self.pairs
            ],
            "anova": dict(
                zip(("f", "df", "df_error", "p"), map(_rounded, self.anova), strict=True)
            )
            if self.anova
            else None,
            "t_tests": [
                {
                    "types": [d.first, d.second],
                    "t": _rounded(d.t),
                    "p": _rounded(d.p),
                    "p_holm": _rounded(d.p_holm),
                }
                for d in self.differences
            ],
            "bradley_terry": {
                "logits": dict(zip(types, map(_rounded, self.model.strengths), strict=True)),
                "standard_errors": dict(zip(types, map(_rounded, errors), strict=True)),
                "p_all_equal": _rounded(self.model.p),
                "half_choices_added": self.model.bounded,
            },
            "first_clip": {
                "share": _rounded(self.first_share[0]), "p": _rounded(self.first_share[1])
            },
        }  # fmt: skip


def analysed(answers: Answers) -> Analysis:
    """Analyse all choices, those of participants who have not finished too."""
    design = answers.design
    types = design.types
    people = answers.participants()
    counts, shown = np.zeros((len(people), len(types))), np.zeros((len(people), len(types)))
    wins = np.zeros((len(types), len(types)))
    places: Counter[str] = Counter()
    for row, person in enumerate(people):
        pages = comparisons(design, person.number)
        for page, choice in answers.choices(person).items():
            i, j = types.index(pages[page - 1].first), types.index(pages[page - 1].second)
            for_first = {"first": 1.0, "second": 0.0, "none": 0.5}[choice]
            wins[i, j] += for_first
            wins[j, i] += 1 - for_first
            counts[row, i] += for_first
            counts[row, j] += 1 - for_first
            shown[row, [i, j]] += 1
            places[choice] += 1
    told = places["first"] + places["second"]
    first = (
        (places["first"] / told, float(binomtest(places["first"], told).pvalue))
        if told
        else (float("nan"), float("nan"))
    )
    return Analysis(
        design, people, counts, shown, wins, pair_table(types, wins),
        t_tests(types, counts), repeated_anova(counts), strengths(wins), first, answers.remarks(),
    )  # fmt: skip


def pair_table(types: Sequence[str], wins: Array) -> Sequence[Pair]:
    """Return table 5.2, with an exact test for each pair."""
    rows = []
    for i, j in combinations(range(len(types)), 2):
        a, b = float(wins[i, j]), float(wins[j, i])
        total = round(a + b)
        least = min(total // 2, int(np.ceil(min(a, b))))
        p = float(binomtest(least, total).pvalue) if total else float("nan")
        rows.append(Pair(types[i], types[j], a, b, p))
    return rows


def repeated_anova(counts: Array) -> tuple[float, int, int, float] | None:
    """Return F, degrees of freedom and p of a one-way analysis of variance, repeated measures.

    F = (SS_types / (k − 1)) / (SS_rest / ((k − 1)(n − 1))), the sums of squares of the means of
    types, and of what neither type nor participant explains. Choices exclude each other, so that
    counts of a participant are not independent, as the test wants: Bradley–Terry is better.

    Args: counts: (participants, types). None of fewer than two participants, or without a rest.
    """
    n, k = counts.shape
    if n < 2:
        return None
    whole = counts.mean()
    by_type, by_person = counts.mean(axis=0), counts.mean(axis=1)
    between = n * ((by_type - whole) ** 2).sum()
    rest = ((counts - by_type - by_person[:, None] + whole) ** 2).sum()
    if rest <= 1e-12:
        return None
    df, df_rest = k - 1, (k - 1) * (n - 1)
    ratio = float((between / df) / (rest / df_rest))
    return ratio, df, df_rest, float(f.sf(ratio, df, df_rest))


def t_tests(types: Sequence[str], counts: Array) -> Sequence[Difference]:
    """Return paired t tests of all pairs, as printed and corrected after Holm (1979)."""
    if len(counts) < 2:
        return []
    found = []
    for i, j in combinations(range(len(types)), 2):
        apart = counts[:, i] - counts[:, j]
        if np.ptp(apart) == 0:
            continue
        test = ttest_rel(counts[:, i], counts[:, j])
        found.append((types[i], types[j], float(test.statistic), float(test.pvalue)))
    order = np.argsort([p for *_, p in found])
    corrected, largest = {}, 0.0
    for rank, index in enumerate(order):
        largest = max(largest, min(1.0, found[index][3] * (len(found) - rank)))
        corrected[int(index)] = largest
    return [Difference(*row, corrected[i]) for i, row in enumerate(found)]


def _rounded(value: float) -> float | None:
    return float(f"{value:.4g}") if np.isfinite(value) else None
