"""Signs and blinks: made-up scores and lids."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from movements import drawn, span

from azee.motion.tasks.signs import Sign
from azee.quality.kinematics import Kinematics
from azee.quality.rhythm import CLOSED, blinks, signs_of, signs_per_s
from azee.score.interval import Interval
from azee.score.score import Block, Call, Group, Key, Score
from azee_rig.rig import Rig


def key(seconds: str, *rules: str) -> Key:
    return Key(Fraction(seconds), calls=tuple(Call(rule) for rule in rules))


def group(*blocks: tuple[str, str, Score], rules: tuple[str, ...] = ()) -> Group:
    """Blocks by name and start."""
    made = tuple(
        Block(name, Interval(Fraction(start), Fraction(start) + score.duration), score)
        for name, start, score in blocks
    )
    length = max(block.interval_in_parent.end for block in made)
    return Group(length, calls=tuple(Call(rule) for rule in rules), blocks=made)


def test_signs_are_the_innermost_rules_that_ask_something_of_the_hands() -> None:
    score = group(
        ("1", "0", key("1", "tree", "arbre")),
        ("2", "1.5", key("2", "good")),
        ("SHAKE", "3.5", key("1", "headshake")),
        rules=("not-but",),
    )
    asked = [
        span(0.0, 1.0, path=("1",)),
        span(1.5, 3.5, limb="index_L", path=("2",)),
        span(3.5, 4.5, limb="head", path=("SHAKE",)),
    ]
    found = signs_of(score, asked)
    assert found == (Sign("arbre", 0.0, 1.0), Sign("good", 1.5, 3.5))
    assert signs_per_s(found) == pytest.approx(2 / 3.5)


def test_a_movement_that_is_made_again_is_the_same_sign() -> None:
    once = ("âge-once",)
    age = group(("1", "0", key("1", *once)), ("2", "1", key("1", *once)), rules=("âge",))
    score = group(("1", "0", age), ("2", "2", age))
    asked = [span(0, 1, path=(a, b)) for a in "12" for b in "12"]
    assert signs_of(score, asked) == (Sign("âge-once", 0.0, 2.0), Sign("âge-once", 2.0, 4.0))


def test_without_rules_the_whole_is_a_sign_and_without_hands_there_is_none() -> None:
    score = group(("A", "0", key("1")), ("B", "1", key("1")))
    asked = [span(0.0, 1.0, path=("A",)), span(1.0, 2.0, path=("B",))]
    assert signs_of(score, asked) == (Sign("", 0.0, 2.0),)
    assert signs_of(score, [span(0.0, 1.0, limb="head", path=("A",))]) == ()
    assert signs_per_s(()) is None


@pytest.mark.parametrize(
    ("times_s", "rate"),
    [(((1.0, 2.0), (2.5, 4.5)), 2 / 3.5), (((1.0, 1.05),), 20.0), (((1.0, 1.0),), None)],
)
def test_signs_are_counted_from_the_start_of_the_first_to_the_end_of_the_last(
    times_s: tuple[tuple[float, float], ...], rate: float | None
) -> None:
    found = signs_per_s([Sign("a", start, end) for start, end in times_s])
    assert found == (None if rate is None else pytest.approx(rate))


def lids(signer: Rig, *closures: tuple[float, float], seconds: float = 6.0) -> Kinematics:
    """Lids that are down from one time to another."""
    k = drawn(signer, seconds)
    units = tuple(signer.face_morphs["AU43"])
    weights = np.zeros((len(k.times_s), len(units)))
    for start, end in closures:
        weights[(k.times_s >= start - 1e-9) & (k.times_s < end - 1e-9)] = 1.0
    return replace(k, units=units, unit_weights=weights)


TWO = (Sign("a", 1.0, 2.0), Sign("b", 2.5, 4.5))


def test_blinks_are_counted_and_those_at_boundaries_told(signer: Rig) -> None:
    """One at a start, one between the signs, one within a sign; one before them all."""
    k = lids(signer, (0.2, 0.4), (1.0, 1.2), (2.2, 2.3), (3.4, 3.6))
    found = blinks(k, TWO)
    assert found.times_s == pytest.approx((0.2, 1.0, 2.2, 3.4), abs=0.01)
    assert found.per_minute == pytest.approx(40.0, rel=0.01)
    assert found.at_boundaries_share == pytest.approx(2 / 3)
    # .3 s at the first start, .15 to 2.65 with the gap, .3 s at the last end, of 3.8 s.
    assert found.boundaries_share == pytest.approx((0.3 + 0.8 + 0.3) / 3.8, abs=0.02)


@pytest.mark.parametrize(("late_s", "near"), [(0.14, 1.0), (0.155, 0.0)])
def test_a_blink_is_at_a_boundary_within_150_milliseconds(
    signer: Rig, late_s: float, near: float
) -> None:
    begin = TWO[0].start_s + late_s
    found = blinks(lids(signer, (begin, begin + 0.1)), TWO)
    assert found.at_boundaries_share == near


@pytest.mark.parametrize(("frames", "found"), [(48, 1), (49, 0)])
def test_a_blink_takes_at_most_four_tenths_of_a_second(
    signer: Rig, frames: int, found: int
) -> None:
    """That is 48 of 120 frames a second."""
    assert len(blinks(lids(signer, (1.0, 1.0 + frames / 120)), TWO).times_s) == found


@pytest.mark.parametrize(("share", "found"), [(0.5, 0), (0.51, 1)])
@pytest.mark.parametrize("whole", [1.0, 0.8])
def test_lids_that_are_down_by_more_than_half_of_a_blink_are_closed(
    signer: Rig, share: float, whole: float, found: int
) -> None:
    """Whatever weight of its units a blink is."""
    k = lids(signer, (1.0, 1.2))
    blink = {"AU43": dict.fromkeys(k.units, whole)}
    rig = replace(signer, face_morphs={**signer.face_morphs, **blink}, lids={})
    down = replace(k, rig=rig, unit_weights=share * whole * k.unit_weights)
    assert len(blinks(down, TWO).times_s) == found


def test_a_blink_is_when_the_lids_are_lowest(signer: Rig) -> None:
    k = lids(signer)
    down = np.clip(1.0 - np.abs(k.times_s - 1.1) / 0.15, 0.0, 1.0)
    found = blinks(replace(k, unit_weights=k.unit_weights + down[:, None]), TWO)
    assert found.times_s == pytest.approx((1.1,))


def test_closed_eyes_and_lids_that_follow_the_eyes_do_not_blink(signer: Rig) -> None:
    assert blinks(lids(signer, (1.0, 1.5)), TWO).times_s == ()
    k = lids(signer, (1.0, 1.2))
    for share, found in ((1.05 * CLOSED, 1), (0.95 * CLOSED, 0)):
        nearly = replace(k, unit_weights=share * k.unit_weights)
        assert len(blinks(nearly, TWO).times_s) == found
    one_eye = k.unit_weights.copy()
    one_eye[:, 0] = 0.0
    assert blinks(replace(k, unit_weights=one_eye), TWO).times_s == ()
    follows = replace(signer, lids=dict.fromkeys(k.units, ("eye_L.pitch", -3.0)))
    down = k.q.copy()
    down[(k.times_s > 0.9) & (k.times_s < 1.3), signer.coordinates.index["eye_L.pitch"]] = -0.3
    assert blinks(replace(k, rig=follows, q=down), TWO).times_s == ()


def test_without_signs_blinks_have_no_boundaries(signer: Rig) -> None:
    found = blinks(lids(signer, (1.0, 1.2)), ())
    assert len(found.times_s) == 1
    assert (found.at_boundaries_share, found.boundaries_share) == (None, None)
    none = blinks(drawn(signer, 1.0), TWO)
    assert (none.times_s, none.at_boundaries_share) == ((), None)
