"""Units of recordings: what a frame time and a length are meant in."""

from __future__ import annotations

import numpy as np
import pytest
from bvh_figure import FIGURE, scaled

from azee.clip.bvh import UNITS_M, parse_bvh


@pytest.mark.parametrize(
    ("written", "rate", "said"),
    [
        ("0.0083333", 120.0, None),
        (".04167", 24.0, None),
        ("2", 0.5, None),
        ("5", 0.2, None),
        ("1e-4", 1e4, None),
        ("60", 60.0, "the frame time 60 is no seconds: 60 frames a second are taken"),
        ("29.97", 29.97, "29.97 frames a second"),
        ("55", 55.0, "55 frames a second"),
        ("33.3333", 30.0, "30 frames a second"),
        ("33", 30.3, "30.3 frames a second"),
        ("8.3333", 120.0, "120 frames a second"),
        ("16667", 60.0, "60 frames a second"),
        ("3.33333e-5", 30.0, "30 frames a second"),
        ("1e-8", 100.0, "100 frames a second"),
        ("1e-6", 1000.0, "1000 frames a second"),
        ("1.0015e-6", 998.5, "998.5 frames a second"),
        ("8.3333e-12", 120.0, "120 frames a second"),
        ("7e-12", 30.0, "30 frames a second"),
        ("900", 900.0, "900 frames a second"),
        ("1099", 30.0, "30 frames a second"),
        ("1e7", 30.0, "30 frames a second"),
        ("-1", 30.0, "says no frame time"),
        ("nan", 30.0, "says no frame time"),
    ],
)
def test_a_frame_time_that_is_no_seconds(written: str, rate: float, said: str | None) -> None:
    read = parse_bvh(FIGURE.replace("0.04", written))
    assert 1 / (read.times[1] - read.times[0]) == pytest.approx(rate, rel=2e-3)
    notes = [note for note in read.notes if "frame" in note]
    if said is None:
        assert notes == []
    else:
        assert [said in note for note in notes] == [True]


def test_units_of_length() -> None:
    """Each is the likeliest for some figure; each can be said."""
    for unit, metre in UNITS_M.items():
        scale = 0.01 / metre
        places = parse_bvh(scaled(FIGURE, scale)).frames()[0]
        assert np.ptp(places[0, :, 1]) == pytest.approx(1.5, abs=1e-3), unit
    for unit, metre in UNITS_M.items():
        read = parse_bvh(FIGURE, unit)
        assert read.skeleton.offsets[2, 1] == pytest.approx(20 * metre)
        assert read.tips[2][1] == pytest.approx(10 * metre)
        assert read.notes == ()
    assert UNITS_M == {"m": 1, "cm": 0.01, "inch": 0.0254, "mm": 0.001, "dm": 0.1, "foot": 0.3048}


@pytest.mark.parametrize(
    ("height_m", "unit"),
    [(0.99, "foot"), (1.01, "cm"), (2.29, "cm"), (2.31, "mm")],
)
def test_children_and_giants_are_people_up_to_a_point(height_m: float, unit: str) -> None:
    """In centimetres: what is shorter than a child, or taller than anybody, has another unit."""
    (said,) = (note for note in parse_bvh(scaled(FIGURE, 1.0)).notes if "the figure is" in note)
    own_m = float(said.split()[-2])
    read = parse_bvh(scaled(FIGURE, height_m / own_m))
    (told,) = read.notes
    if unit == "cm":
        assert told == f"lengths are taken for cm: the figure is {height_m:.2f} m"
    else:
        assert "taken for cm" not in told


@pytest.mark.parametrize(
    "rate",
    [10, 12, 15, 20, 24, 25, 30, 48, 50, 60, 72, 75, 80, 90, 100, 120, 144, 150, 160, 180, 200, 240,
     250, 300, 360, 400, 480, 500, 600, 720, 960],
)  # fmt: skip
def test_every_usual_rate_is_known_in_times_that_lost_their_unit(rate: int) -> None:
    """Up to two thousandths slower or faster; what is no such rate is thirty frames a second."""
    for share in (0.9983, 1.0017):
        read = parse_bvh(FIGURE.replace("0.04", f"{1e-6 / (rate * share):.9e}"))
        assert 1 / (read.times[1] - read.times[0]) == pytest.approx(rate * share, rel=1e-6)
    read = parse_bvh(FIGURE.replace("0.04", f"{1e-6 / (rate * 1.0021):.9e}"))
    assert 1 / (read.times[1] - read.times[0]) == pytest.approx(30.0)
