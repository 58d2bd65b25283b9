"""A mouthing shows in the face, sound by sound, and moves nothing else."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import azee
from azee.score.score import Group

TEXT = 'with-mouth(:bonjour, mouthing("bonjour"))'


@pytest.fixture(scope="module")
def made() -> azee.Compilation:
    return azee.compile(expression=TEXT, life=False, timing="exact", fps=60)


def weights(made: azee.Compilation, unit: str, sound: str) -> NDArray[np.float64]:
    """The weights of a face unit while a sound is made."""
    assert isinstance(made.score, Group)
    mouth = made.score.block("MOUTH").score
    assert isinstance(mouth, Group)
    interval = mouth.block(sound).interval_in_parent
    start, end = (made.animation.lead_s + float(t) for t in (interval.start, interval.end))
    times = made.clip.times
    rows = (times >= start) & (times <= end)
    assert rows.sum() > 4
    return np.asarray(made.clip.unit_weights[rows, made.clip.units.index(unit)])


def test_every_shape_is_reached(made: azee.Compilation) -> None:
    assert made.report.met
    jaw = {sound: weights(made, "jawOpen", sound).max() for sound in ("b", "o~", "Z", "u")}
    pucker = {sound: weights(made, "mouthPucker", sound).max() for sound in ("b", "o~", "u")}
    assert jaw["o~"] > 0.1
    assert jaw["b"] == jaw["Z"] == jaw["u"] == 0
    assert pucker["u"] > pucker["o~"] > pucker["b"] == 0


def test_the_hands_move_as_without_it(made: azee.Compilation) -> None:
    plain = azee.compile(expression=":bonjour", life=False, timing="exact", fps=60)
    assert np.allclose(plain.clip.coordinates, made.clip.coordinates)
    assert plain.clip.units == ()


def test_captions_have_its_text_and_no_sounds(made: azee.Compilation) -> None:
    found = [label.text for label in made.clip.labels]
    assert "“bonjour”" in found
    assert "o~" not in found
