"""Models of hold times: equation 4.3 against scikit-learn, what is left out is really left out."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from sklearn.naive_bayes import CategoricalNB
from sklearn.preprocessing import OrdinalEncoder

from azee.spelling.timing.drawn import drawn_words
from azee.spelling.timing.features import CHOSEN, FEATURES, GENERAL, features, table
from azee.spelling.timing.fitting import (
    fit_naive_bayes,
    fit_practice,
    fit_ridge,
    letters,
    published_practice,
)
from azee.spelling.timing.published import FRAME_S
from azee.spelling.timing.validation import SCHEMES, Scheme, constant_errors, validated

WORDS = drawn_words(5)[::3]


def test_the_ten_features() -> None:
    assert tuple(features("ALL", 1)) == FEATURES
    assert list(features("ALL", 1).values()) == [
        *("L", "3", "A", "L", "middle", "2", "consonant", "double", "open", "ALL"),
    ]
    assert [row["place"] for row in table(["TO", "I"])] == ["first", "last", "last"]
    assert set(CHOSEN) == set(FEATURES) - {"shape"}
    assert set(GENERAL) == set(CHOSEN) - {"word"}


@pytest.mark.parametrize("smoothing", [1.0, 0.05])
def test_probabilities_are_those_of_scikit_learn(smoothing: float) -> None:
    rows, holds_s = letters(WORDS)
    ours = fit_naive_bayes(rows, holds_s, smoothing=smoothing)
    values = OrdinalEncoder().fit_transform([[row[name] for name in CHOSEN] for row in rows])
    theirs = CategoricalNB(alpha=smoothing).fit(values, np.round(holds_s / FRAME_S).astype(int))
    for row, wanted in zip(rows, theirs.predict_proba(values), strict=True):
        np.testing.assert_allclose(ours.probabilities(row), wanted, atol=1e-12)


def test_an_unknown_word_and_an_unknown_letter_say_nothing() -> None:
    rows, holds_s = letters(WORDS)
    model = fit_naive_bayes(rows, holds_s, ("letter", "word"))
    by_letter = fit_naive_bayes(rows, holds_s, ("letter",))
    np.testing.assert_allclose(
        model.probabilities({"letter": "A", "word": "NEVER"}),
        by_letter.probabilities({"letter": "A"}),
    )
    nothing = model.probabilities({"letter": "Ş", "word": "NEVER"})
    np.testing.assert_allclose(nothing, model.class_counts / model.class_counts.sum())


def test_leaving_a_letter_out_is_fitting_without_it() -> None:
    rows, holds_s = letters(WORDS)
    whole = fit_naive_bayes(rows, holds_s, smoothing=0.5)
    for i in range(0, len(rows), 3):
        others = [row for j, row in enumerate(rows) if j != i]
        fitted = fit_naive_bayes(others, np.delete(holds_s, i), smoothing=0.5)
        left = whole.without(rows[i], holds_s[i])
        np.testing.assert_allclose(left.classes_s, fitted.classes_s)
        np.testing.assert_allclose(left.probabilities(rows[i]), fitted.probabilities(rows[i]))


def test_ridge_solves_the_normal_equations() -> None:
    rows, holds_s = letters(WORDS)
    model = fit_ridge(rows, holds_s, ("letter", "place"), penalty=2.0)
    columns = [(n, v) for n in ("letter", "place") for v in sorted({row[n] for row in rows})]
    ones = np.array([[float(row[n] == v) for n, v in columns] for row in rows])
    centred = ones - ones.mean(axis=0)
    parts = np.linalg.solve(
        centred.T @ centred + 2.0 * np.eye(len(columns)), centred.T @ (holds_s - holds_s.mean())
    )
    for row, of in zip(rows, centred, strict=True):
        assert model.hold_of(row) == pytest.approx(holds_s.mean() + of @ parts, abs=1e-9)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_word_that_is_held_out_cannot_be_learnt(scheme: Scheme) -> None:
    """One word has all times of its own; only who learnt it can tell them."""
    odd = type(WORDS[0])("ZZYZX", (0.3, 0.31, 0.3, 0.32, 0.33), (0.2,) * 4)
    found = validated([*WORDS, odd], "naive-bayes", scheme)
    error_s = np.abs(found.predicted_s - found.true_s)[-5:].mean()
    assert (error_s < 0.01) == (scheme == "resubstitution")


def test_words_that_are_held_out_are_foretold_without_the_word() -> None:
    with_word = validated(WORDS, "ridge", "words held out", CHOSEN)
    without = validated(WORDS, "ridge", "words held out", GENERAL)
    np.testing.assert_array_equal(with_word.predicted_s, without.predicted_s)


def test_later_spellings_give_the_exponent_of_practice() -> None:
    word = WORDS[0]
    spellings = [
        type(word)(
            word.word,
            tuple(n**-0.3 * t for t in word.holds_s),
            tuple(n**-0.3 * t for t in word.transitions_s),
            n,
        )
        for n in (1, 2, 7)
    ]
    assert fit_practice([*WORDS[1:], *spellings]) == pytest.approx(0.3)
    assert fit_practice(WORDS) == pytest.approx(published_practice())


@pytest.mark.long
def test_the_default_model_misses_by_five_times_less_than_constants() -> None:
    words = drawn_words()
    held_out = validated(words, "ridge", "words held out")
    published = validated(words, "naive-bayes", "words held out")
    for last_longer in (True, False):
        constant = constant_errors(words, last_longer=last_longer)
        assert constant.error_s > 5 * max(held_out.error_s, published.error_s)
        assert constant.bias_s < 0
    assert held_out.error_s < published.error_s < 0.03


def test_accuracy_counts_frames_and_bias_has_a_sign() -> None:
    from azee.spelling.timing.validation import Errors

    true: Sequence[float] = (10 * FRAME_S, 8 * FRAME_S)
    errors = Errors(np.array(true) - (0.4 * FRAME_S, 2 * FRAME_S), np.array(true))
    assert errors.accuracy == 0.5
    assert errors.bias_s == pytest.approx(1.2 * FRAME_S)
    assert errors.error_s == pytest.approx(1.2 * FRAME_S)
