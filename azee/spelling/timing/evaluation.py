"""All that the thesis measures of its timing model, measured of ours. Needs scikit-learn."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import Any

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from azee.spelling.timing import published as theirs
from azee.spelling.timing.distances import Regression, regressions
from azee.spelling.timing.facts import (
    Fact,
    close,
    hold_facts,
    place_facts,
    transition_facts,
    word_facts,
)
from azee.spelling.timing.features import CHOSEN, FEATURES
from azee.spelling.timing.fitting import fit_model
from azee.spelling.timing.holds import HOLD_NAMES, HoldName
from azee.spelling.timing.letter_poses import LetterPoses, rmsd
from azee.spelling.timing.model import DRAWN, TimingModel
from azee.spelling.timing.published import Style
from azee.spelling.timing.schedule import Timing, duration_s, schedule
from azee.spelling.timing.timed_word import TimedWord, TimesError
from azee.spelling.timing.validation import (
    SCHEMES,
    Errors,
    Scheme,
    constant_errors,
    validated,
    with_training_share,
)

Array = NDArray[np.float64]
Told = Callable[[str], None]

LEAST_WORDS = 5
"""Fewer say nothing about words that are held out."""
SIZES = (1.0, 0.8, 0.5, 0.3)
"""Shares of the data that figure 4.6 learns from."""


@dataclass(frozen=True, eq=False)
class Evaluation:
    """What was measured.

    origin: where the words come from. facts: published figures beside ours. holds: errors of each
    model by each scheme; constant: those of the constant model with 800 ms for the last letter,
    and without. by_feature: of the classifier, as features are added in the order of table 4.2,
    and of those without shape. by_size: mean errors by the letters learnt from. metrics:
    transition times against distances. words_s: mean error of whole words.
    """

    origin: str
    words: Sequence[TimedWord]
    facts: Sequence[Fact]
    holds: Mapping[HoldName, Mapping[Scheme, Errors]]
    constant: Mapping[str, Errors]
    by_feature: Mapping[tuple[str, ...], Mapping[Scheme, Sequence[Errors]]]
    by_size: Mapping[int, Mapping[HoldName, Errors]]
    metrics: Mapping[str, Regression]
    words_s: Mapping[str, float]

    @property
    def gain(self) -> float:
        """How many times less the default model misses held-out words by than the best constant."""
        least = min(errors.error_s for errors in self.constant.values())
        return least / self.holds["ridge"]["words held out"].error_s

    def to_json(self) -> dict[str, Any]:
        """Return all figures in milliseconds and per cent."""
        return {
            "origin": self.origin,
            "facts": [
                {
                    "fact": f.name, "theirs": f.theirs, "ours": f.ours, "verdict": f.verdict,
                    "reason": f.reason,
                }
                for f in self.facts
            ],
            "holds": {
                **{
                    name: {scheme: errors.to_json() for scheme, errors in by.items()}
                    for name, by in self.holds.items()
                },
                **{name: errors.to_json() for name, errors in self.constant.items()},
            },
            "features": {
                " ".join(names): {
                    scheme: [e.to_json() for e in found] for scheme, found in by.items()
                }
                for names, by in self.by_feature.items()
            },
            "training_sizes": {
                str(size): {name: e.to_json() for name, e in by.items()}
                for size, by in self.by_size.items()
            },
            "metrics": {
                name: {
                    "r": round(found.r, 3),
                    "error_ms": round(1000 * float(found.errors_s.mean()), 2),
                    "slope_ms": round(1000 * found.line[0], 2),
                    "offset_ms": round(1000 * found.line[1], 2),
                }
                for name, found in self.metrics.items()
            },
            "words_ms": {name: round(1000 * t, 1) for name, t in self.words_s.items()},
        }  # fmt: skip


def evaluate(
    model: TimingModel,
    poses: LetterPoses,
    *,
    style: Style = "normal",
    others: Mapping[Style, Sequence[TimedWord]] | None = None,
    repeated: Sequence[TimedWord] = (),
    told: Told = lambda _: None,
) -> Evaluation:
    """Measure a model on the words that it was fitted to, which it learns anew for every test.

    Args: style: of these words. others: words in the other style, for its facts. repeated: words
        that a text repeats. told: hears what is being measured.
    Raises: TimesError: there are too few words to learn from some of them.
    """
    words = model.words
    if len({word.word for word in words}) < LEAST_WORDS:
        raise TimesError(f"{LEAST_WORDS} different words are needed to measure a model")
    holds: dict[HoldName, dict[Scheme, Errors]] = {}
    for name in HOLD_NAMES:
        for scheme in SCHEMES:
            told(f"{name}, {scheme}")
            holds.setdefault(name, {})[scheme] = validated(words, name, scheme)
    constant = {
        "constant": constant_errors(words, last_longer=True),
        "constant, last letter like others": constant_errors(words, last_longer=False),
    }
    by_feature = {
        names: {
            scheme: [
                validated(words, "naive-bayes", scheme, names[: n + 1]) for n in range(len(names))
            ]
            for scheme in SCHEMES
        }
        for names in (FEATURES, CHOSEN)
    }
    told("training sizes")
    by_size = {size: _with_letters(words, size) for size in _sizes(words)}
    told("transitions and whole words")
    metrics = regressions(words, poses)
    words_s = word_errors(model, poses)
    facts = [
        *hold_facts(words, style),
        *(f for other, of in (others or {}).items() for f in hold_facts(of, other)),
        *place_facts(words),
        *word_facts(words, repeated, model.practice),
        *_classifier_facts(holds["naive-bayes"], by_feature, constant),
        *_metric_facts(metrics, poses),
        *transition_facts(words),
        *_word_error_facts(words_s),
    ]
    if model.origin != DRAWN:
        facts = [replace(fact, given=False, reason="") for fact in facts]  # of what was drawn
    return Evaluation(
        model.origin, words, facts, holds, constant, by_feature, by_size, metrics, words_s
    )


def word_errors(model: TimingModel, poses: LetterPoses) -> Mapping[str, float]:
    """Return mean |errors| of whole words, seconds, by timing; `held out`: learnt without them."""
    names = sorted({word.word for word in model.words})
    timings: tuple[Timing, ...] = ("variable", "constant")
    found: dict[str, list[float]] = {}
    with threadpool_limits(1):
        for name in names:
            same = [word for word in model.words if word.word == name]
            others = [word for word in model.words if word.word != name]
            without = fit_model(others, model.origin, poses)
            for label, timing, by in (
                *((timing, timing, model) for timing in timings),
                ("variable, word held out", "variable", without),
            ):
                told = duration_s(schedule(name, timing, model=by, poses=poses))
                found.setdefault(label, []).extend(abs(told - word.duration_s) for word in same)
    found["constant, last letter like others"] = [
        abs(len(w.word) * theirs.CONSTANT_HOLD_S
            + (len(w.word) - 1) * theirs.CONSTANT_TRANSITION_S - w.duration_s)
        for w in model.words
    ]  # fmt: skip
    return {label: float(np.mean(errors)) for label, errors in found.items()}


def _sizes(words: Sequence[TimedWord]) -> Sequence[int]:
    count = sum(len(word.word) for word in words)
    return [round(share * count) for share in SIZES]


def _with_letters(words: Sequence[TimedWord], size: int) -> dict[HoldName, Errors]:
    names: tuple[HoldName, ...] = ("naive-bayes", "ridge")
    with threadpool_limits(1):
        return {
            name: with_training_share(words, name, size, np.random.default_rng(0)) for name in names
        }


LEARNT = (
    "that of letters which were learnt: left out, it is {left:.0f} %; words held out, {held:.0f} %"
)


def _classifier_facts(
    classifier: Mapping[Scheme, Errors],
    by_feature: Mapping[tuple[str, ...], Mapping[Scheme, Sequence[Errors]]],
    constant: Mapping[str, Errors],
) -> Iterator[Fact]:
    """Sections 4.2.1 and 4.3: resubstitution is what compares with the published accuracy."""
    ten, nine = by_feature[FEATURES], by_feature[CHOSEN]
    for name, published, of, n in (
        ("9 features without the word", theirs.ACCURACY["9 features, no word"], ten, 9),
        ("10 features", theirs.ACCURACY["10 features"], ten, 10),
        ("9 features without shape", theirs.ACCURACY["9 features, no shape"], nine, 9),
    ):
        accuracy = {scheme: 100 * found[n - 1].accuracy for scheme, found in of.items()}
        reason = LEARNT.format(left=accuracy["one left out"], held=accuracy["words held out"])
        ours = accuracy["resubstitution"]
        yield replace(
            close(f"accuracy, {name}", 100 * published, ours, 5, " %", reason), agrees=False
        )
    left, learnt = classifier["one left out"], classifier["resubstitution"]
    held = classifier["words held out"]
    yield close(
        "mean error of a hold, one left out", 1000 * theirs.HOLD_ERROR_S, 1000 * left.error_s, 2,
        " ms",
        f"learnt it is {1000 * learnt.error_s:.1f}, words held out {1000 * held.error_s:.1f} ms: "
        "the published one lies between",
    )  # fmt: skip
    yield close(
        "mean difference of a hold, one left out", 1000 * theirs.HOLD_BIAS_S,
        1000 * left.bias_s, 3, " ms", "too fast in both",
    )  # fmt: skip
    without = constant["constant, last letter like others"]
    whole = constant["constant"]
    reason = (
        f"without the 800 ms of the last letter; with them, error {1000 * whole.error_s:.0f} and "
        f"difference {1000 * whole.bias_s:.0f} ms: the published one cannot hold them"
    )
    yield close(
        "mean error of a constant hold", 1000 * theirs.CONSTANT_ERROR_S, 1000 * without.error_s,
        10, " ms", reason,
    )  # fmt: skip
    yield close(
        "mean difference of a constant hold", 1000 * theirs.CONSTANT_BIAS_S,
        1000 * without.bias_s, 10, " ms", reason,
    )  # fmt: skip


def _metric_facts(metrics: Mapping[str, Regression], poses: LetterPoses) -> Iterator[Fact]:
    reasons = {
        "MD": "with our letter poses, times drawn by RMSD",
        "CD": "with our letter poses, times drawn by RMSD",
        "GPLVMD": "with our letter poses and our latent space; theirs is not described further",
    }
    for name, published in theirs.CORRELATION.items():
        yield close(
            f"r, {name}",
            published,
            metrics[name].r,
            0.05,
            "",
            reasons.get(name, ""),
            given=name == "RMSD",
        )
    error_ms = 1000 * float(metrics["RMSD"].errors_s.mean())
    yield close(
        "mean error by RMSD", 1000 * theirs.TRANSITION_ERROR_S, error_ms, 3, " ms", given=True
    )
    times = metrics["RMSD"].times_s
    always = 1000 * float(np.abs(times - times.mean()).mean())
    yield Fact(
        "mean error of always saying the mean", "not stated", f"{always:.1f} ms", False,
        f"the metric gains {100 * (1 - error_ms / always):.0f} %",
    )  # fmt: skip
    apart = poses.distances(rmsd)
    reason = "with our letter poses, which count how the palm turns"
    yield close("largest RMSD", theirs.LARGEST_RMSD, max(apart.values()), 0.1, " rad", reason)
    if ("E", "Z") in apart:
        yield close("RMSD of E and Z", theirs.RMSD_E_Z, apart["E", "Z"], 0.1, " rad", reason)
    asymmetry = max(abs(d - apart[b, a]) for (a, b), d in apart.items())
    yield Fact("distances either way", "the same", "the same", asymmetry < 1e-12)


def _word_error_facts(words_s: Mapping[str, float]) -> Iterator[Fact]:
    yield close(
        "whole words, variable", 1000 * theirs.WORD_ERROR_S["variable"],
        1000 * words_s["variable"], 30, " ms",
        f"held out, {1000 * words_s['variable, word held out']:.0f} ms; which words theirs were "
        "is not published",
    )  # fmt: skip
    yield close(
        "whole words, constant", 1000 * theirs.WORD_ERROR_S["constant"],
        1000 * words_s["constant"], 100, " ms",
        f"of all words; without the 800 ms, "
        f"{1000 * words_s['constant, last letter like others']:.0f} ms",
    )  # fmt: skip


def by_verdict(facts: Sequence[Fact]) -> Mapping[str, int]:
    """Count the facts of each verdict."""
    verdicts = sorted(fact.verdict for fact in facts)
    return {verdict: len(list(group)) for verdict, group in groupby(verdicts)}
