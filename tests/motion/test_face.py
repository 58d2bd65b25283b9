from fractions import Fraction

import numpy as np
import pytest

from azee.motion.overlay.face import Plateau, face_weights, weight_curve
from azee.motion.tasks.requirement import Requirement
from azee.motion.tasks.timed_task import TimedTask
from azee.score.interval import Interval
from azee_solver.constraint import Morph
from azee_solver.geometry import Side

F = Fraction


def curve(*blocks: tuple[str, str, float], at: list[float]) -> list[float]:
    plateaus = [Plateau(F(start), F(end), weight) for start, end, weight in blocks]
    return [round(w, 9) for w in weight_curve(plateaus, np.array(at)).tolist()]


def face(name: str, weight: float, start: str, end: str) -> TimedTask:
    interval = Interval(F(start), F(end))
    requirement = Requirement(Morph(name, None, weight), ("FACE",), None, interval, interval, 0)
    nothing: frozenset[int] = frozenset()
    return TimedTask(requirement, "face", nothing, nothing, frozenset(), frozenset(), dynamic=False)


def test_a_long_block_is_a_plateau_between_two_ramps_inside_it() -> None:
    assert curve(("0", "1", 0.8), at=[0, 0.15, 0.5, 0.85, 1]) == [0, 0.8, 0.8, 0.8, 0]
    rising = curve(("0", "1", 0.8), at=[0.03, 0.06, 0.1])
    assert rising == sorted(rising)
    assert rising[0] > 0


def test_a_short_block_is_a_bell_with_its_apex_in_the_middle() -> None:
    assert curve(("1", "1.2", -0.4), at=[1, 1.1, 1.2]) == [0, -0.4, 0]
    assert curve(("1", "1.2", -0.4), at=[1.05]) == curve(("1", "1.2", -0.4), at=[1.15])


def test_a_block_of_no_length_still_reaches_its_weight() -> None:
    assert curve(("1", "1", 1.0), at=[0.95, 0.975, 1, 1.025, 1.05]) == [0, 0.5, 1, 0.5, 0]


def test_a_hold_goes_on_without_a_dip() -> None:
    at = np.linspace(0.2, 1.8, 50).tolist()
    assert curve(("0", "1", 0.6), ("1", "2", 0.6), at=at) == [0.6] * 50


def test_a_weight_goes_straight_to_the_next_one() -> None:
    values = curve(("0", "1", 0.2), ("1", "2", 0.8), at=[0.5, 1.0, 1.05, 1.1, 1.15, 1.5])
    assert values[:2] == [0.2, 0.2]
    assert values == sorted(values)
    assert values[-1] == 0.8


def test_blocks_that_overlap_show_the_stronger() -> None:
    assert curve(("0", "2", 0.3), ("0.5", "1.5", -0.9), at=[0.3, 1.0, 1.8]) == [0.3, -0.9, 0.3]


MORPHS = {"AU1": {"brow": 1.0}, "AU2": {"brow": 0.5, "lid": -0.5}}


def test_different_morphs_add_up_on_the_units_they_share_but_never_beyond_a_whole() -> None:
    blocks = [face("AU1", 0.3, "0", "1"), face("AU2", 0.8, "0", "1")]
    times = np.array([0.5, 2.0])
    weights = face_weights(blocks, MORPHS, ("brow", "lid", "jaw"), Side.RIGHT, times)
    assert weights[0] == pytest.approx([0.7, -0.4, 0.0])
    assert weights[1] == pytest.approx(0.0)
    loud = [face("AU1", 0.9, "0", "1"), face("AU2", 0.8, "0", "1")]
    assert face_weights(loud, MORPHS, ("brow", "lid"), Side.RIGHT, times)[0, 0] == 1.0
    alone = [face("AU1", 1.4, "0", "1")]
    assert face_weights(alone, MORPHS, ("brow", "lid"), Side.RIGHT, times)[0, 0] == 1.4
