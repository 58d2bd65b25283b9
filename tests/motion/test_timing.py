"""Times as performed: ways of arms get the time that they need, and the rest of a score moves."""

from __future__ import annotations

import math
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from timed_scores import (
    DOWN,
    FAR,
    LEFT,
    NEAR,
    PALM,
    RIGHT,
    SCALE,
    UP,
    F,
    S,
    block,
    inside,
    largest,
    played,
    sync,
    times,
)

import azee
from azee.quality.outcome import longer
from azee.score.score import Block, Group
from azee_solver.constraint import (
    BoneAxis,
    Orient,
    Place,
    Relation,
    Rotate,
    Transpath,
)
from azee_solver.geometry import Bone, Circle, Moving, Straight, Vec, WorldPoint


def test_a_way_too_short_for_its_length_gets_what_it_needs() -> None:
    animation = played(FAR)
    (stretch,) = animation.report.stretched
    assert (stretch.way.source, stretch.way.target, stretch.way.side) == (("A",), ("B",), "R")
    assert stretch.score_s == F("1/5")
    assert 0.4 < stretch.way.way_m < 0.6
    assert stretch.performed_s >= stretch.way.needed_s / F("1.02")
    assert stretch.performed_s <= F("1.1") * stretch.way.needed_s
    extra_s = float(stretch.performed_s - stretch.score_s)
    assert animation.report.extra_s == pytest.approx(extra_s)
    found = times(animation.score)
    assert found["A"] == (0.0, 0.4)
    assert found["B"] == pytest.approx((0.6 + extra_s, 1.0 + extra_s))
    speed, acceleration = largest(animation)
    assert speed < 2.1
    assert acceleration < 42
    assert largest(played(FAR, "exact"))[0] > 4


def test_a_way_with_time_enough_stays_as_it_is() -> None:
    score = sync(block("A", "0", ".4", RIGHT), block("B", ".6", ".4", NEAR))
    animation = played(score)
    assert animation.score == score
    assert animation.report.stretched == ()
    assert longer(animation.report) == []
    exact = played(score, "exact")
    np.testing.assert_array_equal(animation.clip.coordinates, exact.clip.coordinates)


def test_a_block_that_must_end_early_gives_time_but_keeps_its_core() -> None:
    score = sync(block("A", "0", ".8", LEFT), block("B", ".8", ".4", RIGHT))
    animation = played(score)
    assert animation.score == score
    (early,) = (b for b in animation.report.blocks if b["path"] == ["A"])
    assert 0.15 <= float(str(early["held_until_s"])) < 0.4
    assert largest(animation)[0] < 2.1
    tight = sync(block("A", "0", ".3", LEFT), block("B", ".3", ".4", RIGHT))
    (early,) = (b for b in played(tight).report.blocks if b["path"] == ["A"])
    assert float(str(early["held_until_s"])) >= 0.15
    assert played(tight).score.duration > tight.duration


def test_where_half_a_block_was_its_core_another_round_gives_the_rest() -> None:
    score = sync(block("A", "0", ".2", LEFT), block("B", ".2", ".4", RIGHT))
    animation = played(score)
    assert largest(animation)[0] < 2.2
    (stretch,) = animation.report.stretched
    assert stretch.performed_s >= stretch.way.needed_s
    assert float(stretch.performed_s - stretch.score_s) == pytest.approx(animation.report.extra_s)


def test_a_short_way_gets_time_to_gather_speed() -> None:
    score = sync(block("A", "0", ".3", RIGHT), block("B", ".35", ".3", NEAR))
    (stretch,) = played(score).report.stretched
    by_speed_s = 1.875 * SCALE * stretch.way.way_m / 1.9
    assert float(stretch.way.needed_s) > 1.3 * by_speed_s
    assert largest(played(score))[1] < 44
    assert largest(played(score, "exact"))[1] > 80


def test_a_hand_that_is_held_over_a_swaying_trunk_needs_no_time() -> None:
    def sway(n: int) -> Block:
        lean = Rotate(Bone("back_1"), UP, math.radians(15 * (-1) ** n))
        return block(str(n), f"{n * 0.08:.2f}", ".03", lean)

    held = block("P", "0", "2", Place(PALM, WorldPoint(-0.2, 1.2, 0.35)))
    accent = sync(*(sway(n) for n in range(4)))
    animation = played(sync(held, inside("SWAY", "1", accent)))
    assert isinstance(animation.score, Group)
    assert animation.score.block("SWAY").score == accent
    assert animation.report.stretched == ()


def test_a_palm_that_turns_in_its_place_gets_time_too() -> None:
    def palm(towards: Vec) -> Orient:
        return Orient(BoneAxis.NRM, Bone("palm", S), Relation.ALONG, towards)

    score = sync(
        block("P", "0", "1", Place(PALM, WorldPoint(-0.2, 1.25, 0.3))),
        block("A", "0", ".4", palm(DOWN)),
        block("B", ".45", ".55", palm(UP)),
    )
    (stretch,) = played(score).report.stretched
    assert (stretch.way.source[-1], stretch.way.target[-1]) == ("A", "B")
    assert stretch.way.turn_rad > 1.0
    assert stretch.performed_s > F("1/4")


def test_a_path_inside_a_sign_gets_time_too() -> None:
    score = sync(
        block("A", "0", ".3", LEFT),
        block("WAY", ".3", ".2", Transpath(PALM, Straight())),
        block("B", ".5", ".3", RIGHT),
    )
    start, end = times(played(score).score)["WAY"]
    assert end - start == pytest.approx(1.875 * SCALE * 0.5 / 1.9, rel=0.01)


def test_a_moving_target_gets_time_too() -> None:
    here = WorldPoint(-0.2, 1.2, 0.3)
    circle = Place(PALM, Moving(Circle(Vec(0, 0, 1), 0.08, 1.0), here, here))
    animation = played(
        sync(block("A", "0", ".3", Place(PALM, here)), block("B", ".3", ".2", circle))
    )
    (stretch,) = animation.report.stretched
    assert stretch.way.target == ("B",)
    assert stretch.way.way_m == pytest.approx(2 * math.pi * 0.08, rel=0.01)
    least_s = 1.875 * SCALE * stretch.way.way_m / 1.9
    assert float(stretch.performed_s) == pytest.approx(least_s, abs=0.01)


TEXT = (
    "sync\n    'A (key .4 (place @PA(s) point(.1, -.1, .28)))\n"
    "    'B (key .4 (place @PA(s) point(-.4, -.1, .28)))\n    'start 'A:end:.2\n"
)


def test_labels_report_and_elan_have_the_times_as_performed(tmp_path: Path) -> None:
    made = azee.compile(TEXT, life=False)
    (stretch,) = made.report.stretched
    start_s, lead_s = float(stretch.end_s), made.report.lead_s
    assert start_s > 0.8
    labels = {label.text: label.start_s - lead_s for label in made.clip.labels}
    assert labels["B"] == pytest.approx(start_s)
    assert {c.start_s for c in made.report.constraints} == {0.0, start_s}
    assert made.report.score_s == pytest.approx(start_s + 0.4)
    assert made.report_json()["stretched"] == [stretch.as_json()]
    made.save(tmp_path / "made.eaf")
    slots = {
        int(slot.attrib["TIME_VALUE"])
        for slot in ElementTree.parse(tmp_path / "made.eaf").iter("TIME_SLOT")
    }
    assert round((start_s + lead_s) * 1000) in slots
