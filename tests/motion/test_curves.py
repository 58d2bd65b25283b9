import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.motion.curves.limb_curves import (
    CALM_RAD_S2,
    CALM_RAD_S3,
    DIRECT_WITHIN_S,
    LONGEST_CALM_S,
    LONGEST_S,
    SHORTEST_S,
    LimbCurve,
    LimbKey,
    calm_transition_s,
    limb_curve,
    transition_s,
)
from azee.motion.curves.movement import Movement
from azee.motion.tasks.limbs import Limbs
from azee_rig.coordinates import Coordinates

NEUTRAL = np.zeros(2)
A, B, C = np.array([1.0, -0.5]), np.array([-0.3, 0.7]), np.array([0.4, 0.4])


def sample(t: LimbCurve, *times: float) -> NDArray[np.float64]:
    return t.sample(np.array(times))


def test_a_limb_is_at_its_keys_on_time_and_neutral_before_and_after() -> None:
    t = limb_curve([LimbKey(1.0, A), LimbKey(1.5, B)], NEUTRAL)
    assert sample(t, 1.0, 1.5) == pytest.approx(np.stack([A, B]))
    assert sample(t, t.start_s - 0.1, t.start_s, t.end_s, t.end_s + 9) == pytest.approx(0.0)
    assert t.start_s == pytest.approx(1.0 - transition_s(A, NEUTRAL))
    assert t.end_s == pytest.approx(1.5 + transition_s(B, NEUTRAL))


def test_transitions_from_and_to_neutral_last_longer_the_farther_they_lead() -> None:
    ways = [transition_s(NEUTRAL, np.array([way, 0.0])) for way in (0.0, 0.4, 1.0, 9.0)]
    assert ways == sorted(ways)
    assert ways[0] == SHORTEST_S
    assert ways[-1] == LONGEST_S


def test_a_quick_transition_by_forty_degrees_takes_the_mean_of_shortest_and_longest() -> None:
    turned = np.array([0.0, math.radians(-40.0)])
    assert transition_s(NEUTRAL, turned) == pytest.approx((SHORTEST_S + LONGEST_S) / 2)


def test_a_calm_transition_keeps_acceleration_and_jerk_within_their_bounds() -> None:
    tau = np.linspace(0.0, 1.0, 20_001)
    for degrees in (20.0, 60.0):
        turn = math.radians(degrees)
        duration = calm_transition_s(NEUTRAL, np.array([turn, 0.0]))
        assert SHORTEST_S < duration < LONGEST_CALM_S
        q, step = turn * minimum_jerk(tau), duration * (tau[1] - tau[0])
        acceleration = np.abs(np.diff(q, 2)).max() / step**2
        jerk = np.abs(np.diff(q, 3)).max() / step**3
        shares = acceleration / CALM_RAD_S2, jerk / CALM_RAD_S3
        assert max(shares) == pytest.approx(1.0, rel=1e-2)


def test_between_two_keys_a_limb_moves_straight_by_minimum_jerk() -> None:
    t = limb_curve([LimbKey(0.0, A), LimbKey(0.4, B)], NEUTRAL)
    tau = 0.25
    s = 10 * tau**3 - 15 * tau**4 + 6 * tau**5
    assert sample(t, 0.1)[0] == pytest.approx(A + s * (B - A))


def test_a_limb_needed_soon_goes_on_directly_and_one_needed_late_returns() -> None:
    soon = limb_curve([LimbKey(0.0, A), LimbKey(DIRECT_WITHIN_S, B)], NEUTRAL)
    assert len(soon.keys) == 4
    late = limb_curve([LimbKey(0.0, A), LimbKey(3.0, B)], NEUTRAL)
    assert sample(late, 1.0, 1.5, 2.0) == pytest.approx(0.0)
    assert len(late.keys) == 6


def test_a_limb_returns_to_neutral_only_where_there_is_time_to() -> None:
    far = np.array([3.0, 3.0])
    gap = 2 * LONGEST_S - 0.01
    assert len(limb_curve([LimbKey(0.0, far), LimbKey(gap, far)], NEUTRAL).keys) == 4


def test_a_limb_that_is_held_does_not_return() -> None:
    t = limb_curve([LimbKey(0.0, A, held=True), LimbKey(9.0, A)], NEUTRAL)
    assert sample(t, 4.5)[0] == pytest.approx(A)


def test_a_limb_passes_keys_on_its_way_without_stopping_or_jerking() -> None:
    keys = [LimbKey(0.0, A), LimbKey(0.3, C, passing=True), LimbKey(1.0, B)]
    t = limb_curve(keys, NEUTRAL)
    assert sample(t, 0.3)[0] == pytest.approx(C)
    h = 1e-3
    x = sample(t, *(0.3 + h * np.arange(-3, 4)))
    speed = (x[4] - x[2]) / (2 * h)
    assert np.abs(speed).max() > 0.5
    before = (2 * x[3] - 5 * x[2] + 4 * x[1] - x[0]) / h**2
    after = (2 * x[3] - 5 * x[4] + 4 * x[5] - x[6]) / h**2
    assert np.abs(after).max() > 50.0
    assert before == pytest.approx(after, abs=1e-3)
    ends = sample(t, 0.0, h, 1.0 - h, 1.0)
    assert np.abs(ends[1] - ends[0]).max() < 1e-6
    assert np.abs(ends[3] - ends[2]).max() < 1e-6


def test_an_idle_limb_never_moves() -> None:
    t = limb_curve([], A)
    assert sample(t, -1.0, 0.0, 7.0) == pytest.approx(np.stack([A, A, A]))


def test_two_keys_at_one_instant_do_no_harm() -> None:
    t = limb_curve([LimbKey(0.5, A), LimbKey(0.5, B)], NEUTRAL)
    assert np.all(np.isfinite(sample(t, 0.4, 0.5, 0.6)))


COORDINATES = Coordinates(
    ("arm_L.flexion", "arm_L.abduction", "head.axial"),
    np.array([-1.0, -0.2, -0.7]),
    np.array([1.0, 1.5, 0.7]),
    np.array([0.1, 0.2, 0.0]),
    np.zeros(3),
    np.ones(3),
)
unit = st.floats(0, 1)


@given(
    st.lists(
        st.tuples(
            st.integers(1, 40), st.lists(unit, min_size=3, max_size=3), st.booleans(), st.booleans()
        ),
        max_size=7,
    )
)
def test_no_coordinate_ever_leaves_its_limits(
    steps: list[tuple[int, list[float], bool, bool]],
) -> None:
    limbs = Limbs.of(COORDINATES)
    lower, upper = COORDINATES.lower, COORDINATES.upper
    time, keys = Fraction(0), []
    for gap, where, passing, held in steps:
        time += Fraction(gap, 20)
        keys.append((float(time), lower + np.array(where) * (upper - lower), passing, held))
    curves = {
        limb: limb_curve([LimbKey(t, q[m], passing, held) for t, q, passing, held in keys],
                    COORDINATES.idle[m])
        for limb, m in limbs.members.items()
    }  # fmt: skip
    q = Movement(COORDINATES, limbs, curves).sample(np.linspace(-1, float(time) + 1, 333))
    assert np.all(q >= lower)
    assert np.all(q <= upper)
    at_keys = Movement(COORDINATES, limbs, curves).sample(np.array([k[0] for k in keys]))
    for got, key in zip(at_keys, keys, strict=True):
        assert got == pytest.approx(key[1], abs=1e-9)
