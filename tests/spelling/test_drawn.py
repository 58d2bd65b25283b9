"""What is drawn agrees with what is published, and the models that ship are fitted to it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from azee.spelling.timing import published
from azee.spelling.timing.drawn import drawn_repetitions, drawn_words
from azee.spelling.timing.fitting import fit_model
from azee.spelling.timing.letter_poses import asl_poses, rmsd
from azee.spelling.timing.model import DRAWN, model_text, shipped_model
from azee.spelling.timing.published import Style, length_class

STYLES: tuple[Style, ...] = ("normal", "careful")


def test_304_letters_hold_every_letter_and_the_words_that_people_watched() -> None:
    assert sum(map(len, published.WORDS)) == published.ENTRIES
    assert set("".join(published.WORDS)) == set("ABCDEFGHIJKLMNOPQRSTUVWXYZ")
    assert set(published.STUDIED) <= set(published.WORDS)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("style", STYLES)
def test_table_4_1(style: Style, seed: int) -> None:
    words = drawn_words(seed, style)
    for size, (mean_s, deviation_s) in published.HOLD_S[style].items():
        means = [np.mean(w.holds_s) for w in words if length_class(w.word) == size]
        assert np.mean(means) == pytest.approx(mean_s, abs=0.002)
        assert np.std(means) == pytest.approx(deviation_s, abs=0.002)


@pytest.mark.parametrize("seed", range(4))
def test_transitions(seed: int) -> None:
    words = drawn_words(seed)
    pairs = [pair for w in words for pair in pairwise(w.word)]
    times = np.array([t for w in words for t in w.transitions_s])
    apart = asl_poses().distances(rmsd)
    distances = np.array([apart[pair] for pair in pairs])
    assert (times.min(), times.max()) == pytest.approx(published.TRANSITION_RANGE_S, abs=1e-4)
    assert times.mean() == pytest.approx(published.TRANSITION_MEAN_S, abs=0.001)
    assert np.corrcoef(distances, times)[0, 1] == pytest.approx(0.44, abs=0.01)
    rest = np.polyval(np.polyfit(distances, times, 1), distances) - times
    assert np.abs(rest).mean() == pytest.approx(published.TRANSITION_ERROR_S, abs=0.001)
    assert all(
        t == times.min() for pair, t in zip(pairs, times, strict=True) if len(set(pair)) == 1
    )


def test_repeated_words_are_faster_at_their_last_spelling() -> None:
    words = drawn_repetitions()
    for name, count in published.REPEATED.items():
        lengths = [w.duration_s for w in words if w.word == name]
        assert len(lengths) == count
        assert lengths[-1] / lengths[0] == pytest.approx(0.8, abs=0.03)


@pytest.mark.parametrize("style", STYLES)
def test_the_model_that_ships_is_that_of_the_draw(style: Style) -> None:
    again = fit_model(drawn_words(style=style), DRAWN)
    assert shipped_model(style).words == tuple(
        type(w)(w.word, _rounded(w.holds_s), _rounded(w.transitions_s)) for w in again.words
    )
    for word in ("ELEPHANT", "QUOKKA"):
        for i in range(len(word)):
            for name, model in again.holds.items():
                shipped = shipped_model(style).holds[name].hold_s(word, i)
                assert shipped == pytest.approx(model.hold_s(word, i), abs=2e-6)
    assert shipped_model(style).transitions["regression"].slope_s == pytest.approx(
        again.transitions["regression"].slope_s, abs=1e-6
    )


def _rounded(times_s: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(round(1000 * t, 3) / 1000 for t in times_s)


def test_a_model_comes_back_from_its_text() -> None:
    import json

    model = shipped_model()
    again = type(model).from_json(json.loads(model_text(model)))
    assert model_text(again) == model_text(model)
