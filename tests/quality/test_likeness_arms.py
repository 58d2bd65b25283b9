"""Wrists, transitions and onsets, on movements whose figures are known in closed form."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from movements import ARM_L, ARM_R, drawn, moves, span, still, then

from azee.quality.kinematics import Kinematics
from azee.quality.signing_dynamics import SHOULDERS_M
from azee.quality.transitions import correlation, transitions
from azee.quality.wrists import largest_wrist_acceleration, largest_wrist_speed, wrist_bend
from azee_rig.rig import Rig

SHARE = 1.0 - 2.0 * (0.5 - math.sqrt(0.25 - math.sqrt(0.1 / 16.0)))
"""Of a minimum-jerk movement that is faster than a tenth of its peak: 16 τ²(1 − τ)² = .1."""


def test_a_minimum_jerk_hand_has_its_peak_speed_and_acceleration(signer: Rig) -> None:
    """1.875 L/T and 10/√3 L/T² (Flash and Hogan 1985)."""
    k = drawn(signer, 1.5, wrists={"R": moves(0.4, 0.4, 0.6), "L": still()})
    speed = largest_wrist_speed(k, (), "transitional")
    assert speed is not None
    assert speed.value == pytest.approx(1.875 * 0.4 / 0.6, rel=2e-3)
    assert speed.of == "palm_R"
    assert speed.at_s == pytest.approx(0.7, abs=0.6 / 120)
    acceleration = largest_wrist_acceleration(k, (), "transitional")
    assert acceleration is not None
    assert acceleration.value == pytest.approx(10.0 / math.sqrt(3.0) * 0.4 / 0.6**2, rel=5e-3)
    at = 0.4 + 0.6 * (0.5 - math.sqrt(3.0) / 6.0)
    assert min(abs(acceleration.at_s - t) for t in (at, 1.4 - at)) < 0.01


def test_of_two_hands_that_are_equally_fast_the_left_is_told(signer: Rig) -> None:
    both = drawn(signer, 1.5, wrists=dict.fromkeys("RL", moves(0.4, 0.4, 0.6)))
    for measured in (largest_wrist_speed, largest_wrist_acceleration):
        found = measured(both, (), "transitional")
        assert found is not None
        assert found.of == "palm_L"


def test_a_forearm_swings_its_wrist_on_an_arc(signer: Rig) -> None:
    """1.875 times the angle by the time, times the forearm, where shoulders are .36 m apart."""
    k = drawn(signer, 1.2, {"f_arm_L.flexion": moves(40.0, 0.3, 0.5, 30.0)})
    speed = largest_wrist_speed(k, (), "transitional")
    assert speed is not None
    shoulders = np.linalg.norm(k.joint("arm_L")[0] - k.joint("arm_R")[0])
    forearm = signer.landmarks.forearm_m * SHOULDERS_M / shoulders
    assert speed.value == pytest.approx(1.875 * math.radians(40.0) / 0.5 * forearm, rel=5e-3)
    assert speed.of == "palm_L"


def test_movement_that_is_asked_for_is_lexical_and_all_other_transitional(signer: Rig) -> None:
    k = drawn(signer, 3.0, wrists={"R": then(moves(0.3, 0.5, 0.5), moves(0.1, 1.5, 0.5))})
    spans = [
        span(0.0, 0.5),
        span(1.0, 1.5),
        span(1.5, 2.0, limb="index_R", limbs=ARM_R, moving=True),
    ]
    between = largest_wrist_speed(k, spans, "transitional")
    inside = largest_wrist_speed(k, spans, "lexical")
    assert between is not None
    assert inside is not None
    assert between.value == pytest.approx(1.875 * 0.3 / 0.5, rel=3e-3)
    assert inside.value == pytest.approx(1.875 * 0.1 / 0.5, rel=3e-3)
    assert largest_wrist_speed(k, spans[:2], "lexical") is None
    assert largest_wrist_acceleration(k, spans[:2], "lexical") is None


def test_a_hand_that_follows_the_other_moves_because_it_is_asked_to(signer: Rig) -> None:
    k = drawn(signer, 2.0, wrists={"L": moves(0.3, 0.5, 0.5), "R": still()})
    path = span(0.5, 1.0, limb="index_R", limbs=ARM_R, moving=True)
    follows = span(0.2, 1.5, limb="palm_L", limbs=ARM_L, reads=frozenset({"index_R"}))
    inside = largest_wrist_speed(k, [path, follows], "lexical")
    assert inside is not None
    assert inside.of == "palm_L"
    alone = largest_wrist_speed(k, [path], "lexical")
    assert alone is not None
    assert alone.of == "palm_R"


def test_a_clip_that_is_measured_has_the_same_figures_at_any_rate(signer: Rig) -> None:
    from azee.clip.clip import Clip

    values = []
    for fps in (30.0, 60.0, 120.0):
        k = drawn(signer, 1.0, {"f_arm_L.flexion": moves(40.0, 0.2, 0.6, 30.0)}, fps=fps)
        clip = Clip(k.times_s + 0.5, k.q, (), k.unit_weights)
        again = Kinematics.of(clip, signer, zero_s=0.5)
        assert again.times_s[0] == pytest.approx(0.0)
        assert Kinematics.of(clip, signer).times_s[0] == pytest.approx(0.5)
        speed = largest_wrist_speed(again, (), "transitional")
        assert speed is not None
        values.append(speed.value)
    assert values == pytest.approx([values[-1]] * 3, rel=5e-3)


def test_a_slow_movement_that_dips_is_one_transition(signer: Rig) -> None:
    """Between its two peaks of .31 m/s it falls to .06: slower than stopped, faster than onset."""
    first, second = moves(0.15, 0.5, 0.9), moves(0.15, 1.25, 0.9)
    k = drawn(signer, 3.0, wrists={"R": lambda t: first(t) + second(t), "L": still()})
    (found,) = transitions(k, [span(0.2, 0.4, limbs=ARM_R), span(2.5, 3.0, limbs=ARM_R)])
    assert found.distance_m == pytest.approx(0.3, abs=0.01)


def test_a_transition_has_its_way_and_its_time(signer: Rig) -> None:
    """The rest at both ends, and the ways from and to rest, are left out."""
    course = then(moves(0.2, 0.0, 0.5), moves(0.3, 1.0, 0.6), moves(-0.5, 2.0, 0.5))
    k = drawn(signer, 3.0, wrists={"R": course, "L": still()})
    spans = [span(0.5, 1.0, limbs=ARM_R), span(1.6, 2.0, limbs=ARM_R)]
    (found,) = transitions(k, spans)
    assert found.side == "R"
    assert found.duration_s == pytest.approx(SHARE * 0.6, abs=2 / 120)
    edge = (1.0 - SHARE) / 2.0
    assert found.start_s == pytest.approx(1.0 + edge * 0.6, abs=1.5 / 120)
    tau = edge
    left_out = 2.0 * (10 * tau**3 - 15 * tau**4 + 6 * tau**5)
    assert found.distance_m == pytest.approx(0.3 * (1.0 - left_out), rel=0.02)
    assert found.onset_spread_ms is None


def test_a_way_from_rest_that_ends_late_and_one_too_short_are_left_out(signer: Rig) -> None:
    course = then(moves(0.2, 0.0, 0.8), moves(0.018, 1.5, 0.2), moves(-0.2, 2.3, 0.8))
    k = drawn(signer, 3.5, wrists={"R": course, "L": still()})
    assert transitions(k, [span(0.5, 1.0, limbs=ARM_R), span(1.8, 2.6, limbs=ARM_R)]) == ()


def test_a_transition_ends_where_a_path_begins(signer: Rig) -> None:
    k = drawn(signer, 3.0, wrists={"R": moves(0.8, 0.5, 2.0), "L": still()})
    spans = [
        span(0.0, 0.5, limbs=ARM_R),
        span(1.5, 2.5, limbs=ARM_R, moving=True),
    ]
    (found,) = transitions(k, spans)
    assert found.end_s == pytest.approx(1.5, abs=1.5 / 120)
    assert found.distance_m == pytest.approx(0.4, rel=0.03)


@pytest.mark.parametrize(("even", "wanted"), [(False, 1.0), (True, 0.0)])
def test_times_that_grow_with_distance_are_correlated(
    signer: Rig, even: bool, wanted: float
) -> None:
    """Time that is proportional to distance: 1. The same time for any distance: 0."""
    ways = (0.1, 0.2, 0.3, 0.4, 0.5)
    starts, courses, spans = [0.5], [moves(0.2, 0.0, 0.4)], []
    for way in ways:
        duration = 0.4 if even else 2.0 * way
        courses.append(moves(way, starts[-1] + 0.2, duration))
        spans.append(span(starts[-1], starts[-1] + 0.2, limbs=ARM_R))
        starts.append(starts[-1] + 0.2 + duration)
    spans.append(span(starts[-1], starts[-1] + 0.2, limbs=ARM_R))
    k = drawn(signer, starts[-1] + 1.0, wrists={"R": then(*courses), "L": still()})
    found = transitions(k, spans)
    assert len(found) == len(ways)
    r = correlation(found)
    assert r is not None
    assert r == pytest.approx(wanted, abs=0.005)
    if not even:
        assert all(a.distance_m < b.distance_m for a, b in pairwise(found))
    assert correlation(found[:3]) is None


def test_transitions_of_one_length_have_no_correlation_with_distance(signer: Rig) -> None:
    from azee.quality.transitions import Transition

    found = [Transition("R", 0.0, 0.25 + 0.003 * n, 0.1 * n, None) for n in range(1, 6)]
    assert correlation(found) == 0.0
    found = [Transition("R", 0.0, 0.1 * n, 0.6 - 0.1 * n, None) for n in range(1, 6)]
    assert correlation(found) == pytest.approx(-1.0)


def test_joints_that_start_one_after_the_other_spread_their_onsets(signer: Rig) -> None:
    k = drawn(
        signer,
        3.0,
        {
            "arm_R.abduction": moves(30.0, 1.0, 0.5, 12.0),
            "f_arm_R.flexion": moves(40.0, 1.03, 0.5, 40.0),
            "palm_R.flexion": moves(20.0, 1.06, 0.5),
            "arm_R.rotation": moves(0.5, 0.8, 0.5),
        },
    )
    spans = [span(0.5, 1.0, limbs=ARM_R), span(1.6, 2.0, limbs=ARM_R)]
    (found,) = transitions(k, spans)
    assert found.onset_spread_ms == pytest.approx(60.0, abs=0.5)


@pytest.mark.parametrize(("turned_deg", "counts"), [(4.8, False), (5.2, True)])
def test_a_joint_that_turns_less_than_five_degrees_has_no_onset(
    signer: Rig, turned_deg: float, counts: bool
) -> None:
    """A wrist beside the elbow: with one joint alone there is no spread."""
    k = drawn(
        signer,
        3.0,
        {
            "f_arm_R.flexion": moves(40.0, 1.0, 0.6, 30.0),
            "palm_R.flexion": moves(turned_deg, 1.15, 0.3),
        },
        {"R": then(moves(0.2, 0.0, 0.5), moves(0.3, 1.0, 0.6)), "L": still()},
    )
    (found,) = transitions(k, [span(0.5, 1.0, limbs=ARM_R), span(1.6, 2.0, limbs=ARM_R)])
    assert (found.onset_spread_ms is not None) == counts


def test_a_slower_joint_s_onset_comes_later(signer: Rig) -> None:
    """A tenth of the peak is passed at .0864 of the time: of .7 s later than of .5 s."""
    k = drawn(
        signer,
        3.0,
        {
            "arm_R.abduction": moves(40.0, 1.0, 0.5, 12.0),
            "f_arm_R.flexion": moves(40.0, 1.0, 0.7, 40.0),
        },
    )
    spans = [span(0.5, 1.0, limbs=ARM_R), span(1.8, 2.0, limbs=ARM_R)]
    (found,) = transitions(k, spans)
    assert found.onset_spread_ms == pytest.approx(1e3 * 0.2 * (1.0 - SHARE) / 2.0, abs=0.3)


def test_what_joints_do_after_a_transition_is_none_of_its_onset(signer: Rig) -> None:
    """A joint that leaps a frame later is fastest then; its onset is that in the transition."""
    wrists = {"R": moves(0.3, 1.0, 0.5), "L": still()}
    spans = [span(0.5, 1.0, limbs=ARM_R), span(1.6, 2.0, limbs=ARM_R)]
    swing = moves(40.0, 1.0, 0.5, 12.0)
    elbow = moves(40.0, 1.05, 0.5, 40.0)

    def spread(*, leap_s: float) -> tuple[float | None, float]:
        def leaps(t: np.ndarray) -> np.ndarray:
            return np.asarray(elbow(t) + np.where(t > leap_s, 30.0, 0.0))

        k = drawn(signer, 3.0, {"arm_R.abduction": swing, "f_arm_R.flexion": leaps}, wrists)
        (found,) = transitions(k, spans)
        return found.onset_spread_ms, found.end_s

    plain, end_s = spread(leap_s=9.0)
    assert plain is not None
    assert plain == pytest.approx(50.0, abs=1.0)
    assert spread(leap_s=end_s + 1.5 / 120)[0] == plain
    assert spread(leap_s=end_s + 0.5 / 120)[0] != plain


def test_joints_that_start_together_have_no_spread(signer: Rig) -> None:
    k = drawn(
        signer,
        3.0,
        {
            "arm_R.abduction": moves(30.0, 1.0, 0.5, 12.0),
            "f_arm_R.flexion": moves(40.0, 1.0, 0.5, 40.0),
            "palm_R.flexion": moves(3.0, 1.2, 0.3),
        },
    )
    spans = [span(0.5, 1.0, limbs=ARM_R), span(1.6, 2.0, limbs=ARM_R)]
    (found,) = transitions(k, spans)
    assert found.onset_spread_ms == pytest.approx(0.0, abs=0.5)


def test_the_angle_of_a_wrist_is_that_of_hand_and_forearm(signer: Rig) -> None:
    def bent(t: np.ndarray) -> np.ndarray:
        return np.where((t >= 0.2) & (t < 0.5), 40.0, 0.0)

    k = drawn(signer, 1.0 - 1 / 120, {"palm_L.flexion": bent, "palm_R.flexion": still(10.0)})
    found = wrist_bend(k)
    assert found.beyond_share == pytest.approx(0.3, abs=1 / 120)
    assert found.largest_deg.value == pytest.approx(40.0)
    assert found.largest_deg.of == "palm_L"
    alike = {f"palm_{side}.flexion": bent for side in "RL"}
    assert wrist_bend(drawn(signer, 1.0, alike)).largest_deg.of == "palm_L"
    both = drawn(signer, 0.1, {"palm_R.flexion": still(30.0), "palm_R.deviation": still(-20.0)})
    angle = wrist_bend(both).largest_deg.value
    frames, bones = both.frames, signer.bones
    f_arm, palm = (frames.rotations[0, bones[b].node, :, 1] for b in ("f_arm_R", "palm_R"))
    assert angle == pytest.approx(math.degrees(math.acos(f_arm @ palm)), abs=1e-6)


@pytest.mark.parametrize(("way_m", "counts"), [(0.0195, False), (0.0210, True)])
def test_a_way_of_two_centimetres_is_a_transition(signer: Rig, way_m: float, counts: bool) -> None:
    """What it leaves out of a way of minimum jerk, before and after, is less than 2 %."""
    course = then(moves(0.2, 0.0, 0.8), moves(1.02 * way_m, 1.5, 0.2), moves(-0.2, 2.3, 0.8))
    k = drawn(signer, 3.5, wrists={"R": course, "L": still()})
    found = transitions(k, [span(0.5, 1.2, limbs=ARM_R), span(1.8, 2.6, limbs=ARM_R)])
    assert len(found) == counts
    assert all(t.distance_m == pytest.approx(way_m, rel=0.02) for t in found)


def test_a_way_on_which_the_clip_ends_ends_with_it(signer: Rig) -> None:
    k = drawn(signer, 1.3, wrists={"R": moves(0.4, 1.0, 0.6), "L": still()})
    (found,) = transitions(k, [span(0.2, 0.9, limbs=ARM_R), span(1.6, 2.0, limbs=ARM_R)])
    assert found.end_s == pytest.approx(1.3, abs=1.5 / 120)
