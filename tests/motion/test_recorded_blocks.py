"""Recorded signs bound to a body: the limbs that they own, and the ways into and out of them."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from any_recordings import AnyRecordings, RaisedArm
from numpy.typing import NDArray

from azee.lang.program import load
from azee.motion.curves.movement import Interpolation, Movement
from azee.motion.keys.plan import limbs_in_use
from azee.motion.overlay.recordings import LIFE_RAMP_S, life_share
from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.limbs import Limbs
from azee.motion.tasks.recordings import RecordedBlock, imposed
from azee.motion.tasks.schedule import TaskSchedule, bind
from azee.score.score import Score
from azee_grammar.source import Source
from azee_rig.rig import Rig
from azee_solver.evaluate import evaluator
from azee_solver.geometry import Side

Floats = NDArray[np.float64]


def score(expression: str) -> Score:
    return load(Source("<t>", ""), recordings=AnyRecordings()).evaluate(expression).score


def scheduled(expression: str, rig: Rig, dominant: Side = Side.RIGHT) -> TaskSchedule:
    limbs = Limbs.of(rig.coordinates)
    return bind(flatten(score(expression)), rig, evaluator(rig, dominant).binding, limbs)


def moved(schedule: TaskSchedule, rig: Rig) -> Movement:
    """The movement of recordings alone, from idle to idle."""
    limbs, idle = Limbs.of(rig.coordinates), rig.coordinates.idle
    in_use = limbs_in_use(schedule, ())
    return Interpolation(rig, limbs, in_use, idle, True, schedule.recorded).through(())


def only(schedule: TaskSchedule) -> RecordedBlock:
    (block,) = schedule.recorded
    return block


def test_a_recording_owns_the_arm_that_it_moves_with_its_fingers(signer: Rig) -> None:
    block = only(scheduled("recorded 'A", signer))
    fingers = {f"{name}_R" for name in ("thumb", "index", "middle", "ring", "little")}
    assert block.limbs == {"arm_R", *fingers}
    assert (block.body.start, block.body.end) == (Fraction(1), Fraction(5, 2))


def test_the_other_hand_signs_it_for_a_left_handed_signer(signer: Rig) -> None:
    assert "arm_L" in only(scheduled("recorded 'A", signer, Side.LEFT)).limbs
    assert "arm_L" in only(scheduled("mirror (recorded 'A)", signer)).limbs
    assert "arm_R" in only(scheduled("mirror (recorded 'A)", signer, Side.LEFT)).limbs


@pytest.mark.parametrize(
    ("asked", "lost", "kept"),
    [
        ("place @I_TIP(s) ^Mssp", {"arm_R", "index_R"}, set()),
        ("morph 'index_bend s 1", {"index_R"}, {"arm_R", "ring_R"}),
        ("place @I_TIP(w) @PA(s)", set(), {"arm_R", "index_R"}),
        ("look ^fwd", set(), {"arm_R", "index_R"}),
    ],
)
def test_what_another_block_asks_for_is_not_the_recordings(
    asked: str, lost: set[str], kept: set[str], signer: Rig
) -> None:
    text = f"sync 'A (recorded 'A) 'B (key 1 ({asked})) 'start/end 'A:start 'A:end"
    block = only(scheduled(text, signer))
    assert not lost & block.limbs
    assert kept <= block.limbs


def test_the_body_is_as_recorded_and_faster_if_it_is_shorter(signer: Rig) -> None:
    v = signer.coordinates.index["f_arm_R.flexion"]
    source = RaisedArm("A").clip(signer)
    schedule = scheduled("recorded 'A", signer)
    times = np.linspace(1.0, 2.5, 40)
    found = moved(schedule, signer).sample(times)[:, v]
    wanted = np.interp(times, source.times, source.coordinates[:, v])
    assert np.abs(found - wanted).max() < 2e-4
    shorter = "sync 'X (blank 2.25) 'A (recorded 'A) 'start/end 'X:start 'X:end"
    block = only(scheduled(shorter, signer))
    assert block.end_s - block.start_s == pytest.approx(0.75)
    last = block.sample(np.array([block.end_s]))[0, v]
    assert last == pytest.approx(np.interp(2.5, source.times, source.coordinates[:, v]), abs=1e-6)


TWO = "seq(list(recorded 'A, recorded 'B), 'gap = .2)"


def test_velocity_is_continuous_and_nothing_falls_to_idle_between_two(signer: Rig) -> None:
    """No jump above 5 % of the largest speed; between the two the arm stays as high."""
    schedule = scheduled(TWO, signer)
    movement = moved(schedule, signer)
    v = signer.coordinates.index["f_arm_R.flexion"]
    h = 1e-4
    dense = np.arange(movement.start_s, movement.end_s, 1 / 120)
    largest = np.abs(np.diff(movement.sample(dense)[:, v])).max() * 120
    for block in schedule.recorded:
        for t in (block.start_s, block.end_s):
            q = movement.sample(np.array([t - 2 * h, t - h, t + h, t + 2 * h]))[:, v]
            assert abs((q[3] - q[2]) - (q[1] - q[0])) / h < 0.05 * largest
    first, second = schedule.recorded
    way = movement.sample(np.linspace(first.end_s, second.start_s, 30))[:, v]
    assert way.min() > min(way[0], way[-1]) - 0.1  # of an arm a third of a metre long: 3 cm
    before = movement.sample(np.array([movement.start_s - 1.0]))[0]
    assert np.array_equal(before, signer.coordinates.idle)


def test_with_time_between_an_arm_returns_to_rest(signer: Rig) -> None:
    schedule = scheduled("seq(list(recorded 'A, recorded 'B), 'gap = 3)", signer)
    v = signer.coordinates.index["f_arm_R.flexion"]
    middle = moved(schedule, signer).sample(np.array([4.5]))[0, v]
    assert middle == pytest.approx(signer.coordinates.idle[v])


def test_it_is_imposed_while_it_plays_and_life_fades_before(signer: Rig) -> None:
    schedule = scheduled("recorded 'A", signer)
    v = signer.coordinates.index["arm_R.flexion"]
    other = signer.coordinates.index["arm_L.flexion"]
    count = len(signer.coordinates)
    times = [Fraction(n, 10) for n in range(31)]
    found = imposed(schedule.recorded, times, count)
    assert [times[i] for i in np.flatnonzero(found.mask[:, v])] == times[10:26]
    assert not found.mask[:, other].any()
    seconds = np.array([0.0, 1.0 - LIFE_RAMP_S, 0.9, 1.0, 2.0, 2.5, 3.0])
    share = life_share(schedule.recorded, seconds, count)
    assert share[[0, 1, 6], v] == pytest.approx([1.0, 1.0, 1.0])
    assert share[[3, 4, 5], v] == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)
    assert 0.0 < share[2, v] < 1.0
    assert (share[:, other] == 1.0).all()
