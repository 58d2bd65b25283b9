"""Imported signs on the body that ships, beside their notation as `benchmarks/` reads it."""

from __future__ import annotations

import math
from itertools import product
from pathlib import Path

import pytest

from azee.lexicon.codes import direction, palm_normal
from azee.lexicon.model import Heading
from azee_rig.rig import Rig
from benchmarks.lexicon import BOUNDS, Figures, measure
from benchmarks.lexicon_notation import direction as read_direction
from benchmarks.lexicon_notation import palm as read_palm

SIGNS = Path(__file__).parent / "signs"
FINGERS = [
    a + b + c for a, b, c in product(("u", "d", ""), ("o", "i", ""), ("l", "r", "")) if a + b + c
]
PALMS = ("u", "ul", "l", "dl", "d", "dr", "r", "ur")


@pytest.mark.parametrize("fingers", FINGERS)
def test_palms_are_turned_as_another_formula_has_it(fingers: str) -> None:
    ours = direction(Heading(fingers))
    assert ours == pytest.approx(tuple(read_direction(fingers)))
    for palm in PALMS:
        normal = palm_normal(ours, Heading(palm))
        assert normal == pytest.approx(tuple(read_palm(read_direction(fingers), palm)), abs=1e-9)
        assert math.hypot(*normal) == pytest.approx(1)


def test_palms_are_as_the_engine_shows_them() -> None:
    for fingers, palm, meant in (
        ("o", "l", (1, 0, 0)),
        ("l", "l", (0, 0, -1)),
        ("r", "l", (0, 0, 1)),
        ("i", "l", (1, 0, 0)),
        ("u", "u", (0, 0, -1)),
        ("u", "d", (0, 0, 1)),
        ("d", "u", (0, 0, 1)),
        ("o", "u", (0, 1, 0)),
    ):
        assert palm_normal(direction(Heading(fingers)), Heading(palm)) == pytest.approx(meant)


@pytest.mark.slow
def test_hands_are_turned_and_placed_as_notated(signer: Rig) -> None:
    figures = Figures()
    for path in sorted(SIGNS.glob("*.sigml")):
        measure(path.stem, path.read_bytes(), signer, figures, overlap=False)
    assert figures.failed == []
    shares = {
        what: sum(value <= BOUNDS[what] for value, _ in found) / len(found)
        for what, found in figures.values.items()
        if what in BOUNDS
    }
    assert shares["place at the start, m"] == 1
    for what in ("fingers at the start, degrees", "palm at the start, degrees"):
        assert len(figures.values[what]) >= 20
        assert shares[what] >= 0.85
