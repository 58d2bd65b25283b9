"""Trills of the rules that ship are seen: most finger tips go to and fro by 30 mm or more."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from azee.animation import animate
from azee.compilation import score_of
from azee.lang.program import load
from azee.lang.reflection import MIRROR
from azee.motion.overlay.trill import FADE_S, Oscillation, add_trills
from azee.motion.overlay.trill import oscillation as oscillation_on_body
from azee.motion.overlay.turning import angular_velocity
from azee.motion.tasks.requirement import Requirement
from azee.motion.tasks.timed_task import TimedTask
from azee.score.interval import Interval
from azee.score.score import Key, Score, leaves
from azee_grammar.source import Source
from azee_rig.rig import Rig
from azee_solver.constraint import Trill
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Bone, Side, Vec

SEEN_M = 0.03
FPS = 120.0
TIPS = tuple(f"{digit}_TIP" for digit in "TIMRL")


def trills(score: Score) -> Iterator[tuple[Trill, float, float]]:
    """Yield each trill, with its start and its end in seconds."""
    for leaf in leaves(score):
        for constraint in leaf.score.constraints if isinstance(leaf.score, Key) else ():
            if isinstance(constraint, Trill):
                yield constraint, float(leaf.interval.start), float(leaf.interval.end)


def test_trills_of_rules_are_seen_at_the_finger_tips(signer: Rig) -> None:
    """The hand stays at its place meanwhile, so that all movement of the tips is the trill's."""
    for name in ("cinéma", "mignon"):
        score = score_of(load(Source(name, f":{name}\n")), None, None)
        made = animate(score, signer, fps=FPS, life=False)
        assert any(trills(score))
        for trill, start_s, end_s in trills(score):
            assert trill.bone.side is Side.STRONG
            a, b = (
                np.searchsorted(made.clip.times, made.lead_s + t)
                for t in (start_s + FADE_S, end_s - FADE_S)
            )
            frames = signer.chain.frames(made.clip.coordinates[a:b])
            ways = []
            for tip in TIPS:
                at = signer.sites[f"{tip}_R"].point(frames)
                ways.append(np.linalg.norm(at[:, None] - at[None], axis=-1).max())
            assert np.median(ways) > SEEN_M, (name, ways)


def oscillation(trill: Trill, whole: Interval) -> Oscillation:
    """A trill of a block, on one coordinate."""
    task = TimedTask(
        Requirement(trill, ("A",), None, whole, whole, 0),
        "arm_R", frozenset(), frozenset(), frozenset(), frozenset(), False,
    )  # fmt: skip
    return Oscillation(task, np.zeros(1), 1.0)


def angles(trill: Trill, duration_s: int = 1) -> NDArray[np.float64]:
    """Return the angles of a trill of a block, degrees, at a thousand instants a second."""
    times = np.arange(0, 1000 * duration_s + 1) / 1000
    found = oscillation(trill, Interval(Fraction(0), Fraction(duration_s))).angles(times)
    return np.degrees(found)


PALM, UP = Bone("palm", Side.STRONG), Vec(0.0, 1.0, 0.0)


@given(st.integers(1, 8), st.integers(0, 60), st.integers(0, 60), st.integers(1, 3))
def test_a_trill_goes_so_often_between_its_two_ends(
    cycles: int, amp: int, back: int, duration_s: int
) -> None:
    trill = Trill(PALM, UP, 5.0, math.radians(amp), math.radians(back), 0.0, cycles * duration_s)
    found = angles(trill, duration_s)
    assert found.max() <= amp + 1e-9
    assert found.min() >= -back - 1e-9
    inner = found[200:-200] - 0.5 * (amp - back)
    if amp + back > 0:
        crossings = int(np.count_nonzero(np.diff(np.sign(inner[np.abs(inner) > 1e-9])) != 0))
        assert abs(crossings - 2 * cycles * (duration_s - 0.4)) <= 1


def test_a_trill_starts_at_its_phase() -> None:
    early, late = (
        angles(replace(Trill(PALM, UP, 2.0, math.radians(20)), phase_rad=phase))
        for phase in (0.0, math.pi / 2)
    )
    np.testing.assert_allclose(late[200:600], early[325:725], atol=1e-9)
    np.testing.assert_allclose([early[125], early[375], late[250]], [20, -20, -20], atol=1e-9)


def test_a_trill_shorter_than_two_fades_is_whole_in_its_middle() -> None:
    short = oscillation(Trill(PALM, UP, 2.0, 0.3), Interval(Fraction(1), Fraction("1.1")))
    faded = short.envelope(np.array([1.0, 1.025, 1.05, 1.075, 1.1]))
    np.testing.assert_allclose(faded, [0, 0.5, 1, 0.5, 0], atol=1e-9)
    assert 2 * FADE_S > 0.1


def test_two_trills_half_a_cycle_apart_are_opposite() -> None:
    one = Trill(PALM, UP, 3.0, math.radians(20))
    np.testing.assert_allclose(angles(one), -angles(replace(one, phase_rad=math.pi)), atol=1e-9)


@given(st.integers(0, 60), st.integers(0, 60), st.integers(1, 359))
def test_a_mirrored_trill_turns_to_the_other_side(amp: int, back: int, phase_deg: int) -> None:
    trill = Trill(
        PALM, UP, 3.0, math.radians(amp), math.radians(back), math.radians(phase_deg)
    )  # fmt: skip
    other = MIRROR.constraint(trill)
    assert isinstance(other, Trill)
    assert other.bone.side is Side.WEAK
    np.testing.assert_allclose(angles(other), -angles(trill), atol=1e-9)


@pytest.mark.parametrize(("off_deg", "helped"), [(0, False), (20, False), (40, True)])
def test_the_joint_before_helps_where_a_bones_own_cannot_turn(
    off_deg: int, helped: bool, signer: Rig
) -> None:
    """The wrist bends about two axes; what an axis lacks of their plane is the forearm's."""
    evaluator, q = Evaluator(signer, Side.RIGHT), signer.coordinates.idle
    index, palm = signer.coordinates.index, signer.bones["palm_R"]
    bend, aside = (
        angular_velocity(signer, q, index[f"palm_R.{name}"], palm.node)
        for name in ("flexion", "deviation")
    )
    across = np.cross(bend, aside)
    off = math.radians(off_deg)
    wanted = math.cos(off) * bend + math.sin(off) * across / np.linalg.norm(across)
    parent = int(signer.chain.parents[palm.origin_node])
    axis = signer.chain.frames(q).rotations[parent].T @ wanted
    trill = Trill(PALM, Vec(*axis.tolist()), 4.0, math.radians(10.0))
    whole = Interval(Fraction(0), Fraction(1))
    found = oscillation_on_body(oscillation(trill, whole).task, q, evaluator)
    moved = {signer.coordinates.names[v] for v in np.flatnonzero(np.abs(found.direction) > 1e-6)}
    assert moved <= {"palm_R.flexion", "palm_R.deviation"} or helped
    assert ("f_arm_R.pronation" in moved) == helped
    assert found.turnable == pytest.approx(1.0 if helped else math.cos(off), abs=0.02)


def test_a_trill_fades_in_and_out_in_a_tenth_of_a_second() -> None:
    whole = oscillation(Trill(PALM, UP, 2.0, 0.3), Interval(Fraction(1), Fraction(2)))
    faded = whole.envelope(np.array([1.0, 1.05, 1.1, 1.5, 1.9, 1.95, 2.0]))
    np.testing.assert_allclose(faded, [0, 0.5, 1, 1, 1, 0.5, 0], atol=1e-9)


def test_a_trill_without_length_moves_nothing() -> None:
    instant = oscillation(Trill(PALM, UP, 2.0, 0.3), Interval(Fraction(1), Fraction(1)))
    assert not instant.envelope(np.array([0.9, 1.0, 1.1])).any()


@pytest.mark.parametrize("cycles", [None, 5.0])
def test_a_trill_is_the_same_whenever_its_block_begins(cycles: float | None) -> None:
    trill = Trill(PALM, UP, 4.0, math.radians(20), cycles=cycles)
    times = np.arange(0, 1001) / 1000
    late = oscillation(trill, Interval(Fraction("3.07"), Fraction("4.07"))).angles(3.07 + times)
    np.testing.assert_allclose(np.degrees(late), angles(trill), atol=1e-9)


WRIST, FOREARM = "palm_R.flexion", "f_arm_R.pronation"


def trilled(
    signer: Rig,
    starts_deg: dict[str, float],
    shares: dict[str, float],
    amp_deg: float,
    back_deg: float,
    turnable: float = 1.0,
) -> tuple[dict[str, NDArray[np.float64]], float]:
    """Trill, from 1 s to 3 s, coordinates that are still; tell them, and what it falls short by.

    starts_deg: where coordinates are. shares: how much of the angle each of them turns.
    """
    coordinates = signer.coordinates
    direction = np.zeros(len(coordinates))
    for name, share in shares.items():
        direction[coordinates.index[name]] = share
    trill = Trill(PALM, UP, 5.0, math.radians(amp_deg), math.radians(back_deg))
    task = oscillation(trill, Interval(Fraction(1), Fraction(3))).task
    times = np.arange(0, 4001) / 1000
    q = np.tile(coordinates.idle, (len(times), 1))
    for name, start_deg in starts_deg.items():
        q[:, coordinates.index[name]] = math.radians(start_deg)
    found, short = add_trills(q, times, [Oscillation(task, direction, turnable)], coordinates)
    np.testing.assert_array_equal(found[:, direction == 0], q[:, direction == 0])
    outside = (times < 1.0) | (times > 3.0)
    np.testing.assert_array_equal(found[outside], q[outside])
    return (
        {name: np.degrees(found[:, coordinates.index[name]]) for name in shares},
        math.degrees(short[task.rank]),
    )


def test_a_trill_turns_each_coordinate_by_its_share_while_it_lasts(signer: Rig) -> None:
    shares = {WRIST: 1.0, FOREARM: -0.5}
    found, short_deg = trilled(signer, {WRIST: 10.0, FOREARM: 20.0}, shares, 20.0, 12.0)
    wrist, forearm = found[WRIST] - 10.0, found[FOREARM] - 20.0
    np.testing.assert_allclose([wrist.max(), wrist.min()], [20.0, -12.0], atol=1e-6)
    np.testing.assert_allclose(forearm, -0.5 * wrist, atol=1e-9)
    assert short_deg == 0.0


@pytest.mark.parametrize("upper", [True, False])
@pytest.mark.parametrize(
    ("room_deg", "half_deg", "moved_deg", "short_deg"),
    [(16.0, 20.0, 4.0, 0.0), (14.0, 20.0, 5.0, 1.0), (0.0, 4.0, 2.0, 2.0)],
)
def test_the_middle_of_a_trill_moves_from_a_limit_by_5_degrees_or_a_quarter_of_the_swing(
    signer: Rig, upper: bool, room_deg: float, half_deg: float, moved_deg: float, short_deg: float
) -> None:
    """What would still pass the limit is clamped: the trill falls short by it."""
    v = signer.coordinates.index[WRIST]
    limits = signer.coordinates.upper if upper else signer.coordinates.lower
    limit_deg, sign = math.degrees(limits[v]), 1.0 if upper else -1.0
    starts = {WRIST: limit_deg - sign * room_deg}
    found, off_deg = trilled(signer, starts, {WRIST: 1.0}, half_deg, half_deg)
    wrist = sign * (found[WRIST] - limit_deg)
    assert wrist.max() == pytest.approx(0.0, abs=1e-6)
    assert wrist.min() == pytest.approx(-room_deg - moved_deg - half_deg, abs=1e-6)
    assert off_deg == pytest.approx(short_deg, abs=1e-6)


@pytest.mark.parametrize(
    ("amp_deg", "back_deg"), [(30.0, 10.0), (10.0, 30.0), (-30.0, 10.0), (10.0, -30.0)]
)
def test_a_trill_falls_short_by_what_no_joint_can_turn(
    signer: Rig, amp_deg: float, back_deg: float
) -> None:
    """Of its wider end, to whichever side that is."""
    _, short_deg = trilled(signer, {}, {WRIST: 1.0}, amp_deg, back_deg, turnable=0.8)
    assert short_deg == pytest.approx(0.2 * 30.0)


def on_body(signer: Rig, bone: Bone, axis: Vec) -> tuple[set[str], float]:
    """Coordinates that a trill of the idle body turns, and the share of its axis that they can."""
    trill = Trill(bone, axis, 4.0, math.radians(10.0))
    task = oscillation(trill, Interval(Fraction(0), Fraction(1))).task
    q = signer.coordinates.idle
    found = oscillation_on_body(task, q, Evaluator(signer, Side.RIGHT))
    turned = {signer.coordinates.names[v] for v in np.flatnonzero(np.abs(found.direction) > 1e-6)}
    return turned, found.turnable


def test_about_an_axis_without_direction_nothing_turns(signer: Rig) -> None:
    assert on_body(signer, PALM, Vec(0.0, 0.0, 0.0)) == (set(), 0.0)


@pytest.mark.parametrize(
    ("axis", "turned", "share"),
    [
        (Vec(1.0, 0.0, 0.0), {"thumb_R_3.flexion"}, 1.0),
        (Vec(1.0, 0.0, 1.0), {"thumb_R_3.flexion"}, math.sqrt(0.5)),
        (Vec(0.0, 0.0, 1.0), set(), 0.0),
    ],
)
def test_a_joint_helps_only_where_it_turns_what_the_bones_own_cannot(
    signer: Rig, axis: Vec, turned: set[str], share: float
) -> None:
    """Both last joints of the thumb bend about one axis; the first one is too far away to help."""
    found, turnable = on_body(signer, Bone("thumb", Side.STRONG, 3), axis)
    assert found == turned
    assert turnable == pytest.approx(share, abs=1e-6)


def test_the_joint_before_helps_about_all_its_axes(signer: Rig) -> None:
    """A palm about its own length: the idle forearm is not quite in line with it."""
    turned, turnable = on_body(signer, PALM, UP)
    assert turned == {
        "palm_R.flexion", "palm_R.deviation", "f_arm_R.flexion", "f_arm_R.pronation",
    }  # fmt: skip
    assert turnable == pytest.approx(1.0)
