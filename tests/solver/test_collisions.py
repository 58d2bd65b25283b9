"""Distances of capsules, and which pairs count."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from stick_obstacles import BODY, RIG, Array, coordinate, obstacles, pair

from azee_rig.rig import Capsules, Rig
from azee_solver.anatomy import anatomy
from azee_solver.binding import Binding
from azee_solver.collisions import Obstacles, segment_distance
from azee_solver.geometry import (
    Side,
)

ends = st.lists(st.tuples(coordinate, coordinate, coordinate), min_size=4, max_size=4)


@given(ends)
def test_segments_are_as_near_as_their_nearest_samples(
    four: list[tuple[float, float, float]],
) -> None:
    p0, p1, q0, q1 = (np.array([e]) for e in four)
    t = np.linspace(0, 1, 60)[:, None]
    first, second = p0 + t * (p1 - p0), q0 + t * (q1 - q0)
    sampled = np.linalg.norm(first[:, None] - second[None], axis=-1).min()
    exact = segment_distance(p0, p1, q0, q1)[0]
    assert exact <= sampled + 1e-9
    assert sampled <= exact + 0.06


def free(*prefixes: str) -> list[int]:
    return [v for v, n in enumerate(RIG.coordinates.names) if n.startswith(prefixes)]


def test_only_pairs_that_move_against_each_other_count() -> None:
    these = obstacles()
    wrist = these.for_problem(free("palm_R"), [])
    names = np.array(RIG.capsules.names)[wrist.pairs]
    assert all("hand_R" in row for row in names)
    lean = these.for_problem(free("back_2"), [])
    assert any(
        {"fore_R", "trunk_1"} == set(row) for row in np.array(RIG.capsules.names)[lean.pairs]
    )


def test_what_a_later_problem_will_move_is_not_yet_in_the_way() -> None:
    these = obstacles()
    now = these.for_problem(free("arm_R", "f_arm_R"), free("arm_L", "f_arm_L", "palm_R"))
    rows = [set(row) for row in np.array(RIG.capsules.names)[now.pairs]]
    assert {"fore_R", "fore_L"} not in rows
    assert {"hand_R", "trunk_1"} in rows  # it is carried along, whatever its wrist will do


def test_fingers_side_by_side_need_be_no_farther_apart_than_when_straight() -> None:
    """Their axes are 20 mm apart, their radii 13 mm each."""
    c, names = RIG.capsules, RIG.chain.names
    nodes = [names.index("index_R_2"), names.index("middle_R_2")]
    ends = np.zeros((2, 3)), np.array([[0.0, 0.03, 0.0]] * 2)
    first = len(c.names)
    capsules = Capsules(
        (*c.names, "index", "middle"),
        np.r_[c.node, nodes],
        np.vstack([c.a, ends[0]]),
        np.vstack([c.b, ends[1]]),
        np.r_[c.radius, 0.013, 0.013],
        c.pairs,
        np.array([[first, first + 1]]),
    )
    rig = replace(RIG, capsules=capsules)
    these = Obstacles(Binding(rig, Side.RIGHT), anatomy(rig.chain, rig.coordinates), ())
    assert these.reach[-1] == pytest.approx(0.020)
    apart = replace(rig, capsules=replace(capsules, radius=np.r_[c.radius, 0.007, 0.007]))
    these = Obstacles(Binding(apart, Side.RIGHT), anatomy(rig.chain, rig.coordinates), ())
    assert these.reach[-1] == pytest.approx(0.014)


def test_arms_keep_clear_of_the_trunk_by_a_margin_and_of_each_other_by_none() -> None:
    """Also where the zero pose has them overlap: that is forgiven fingers alone."""
    c = RIG.capsules
    wide = np.where(np.array(c.names) == "trunk_1", 0.3, c.radius)
    rig = replace(RIG, capsules=replace(c, radius=wide))
    these = Obstacles(Binding(rig, Side.RIGHT), BODY, ())
    for reach, (i, j) in zip(these.reach, these.pairs, strict=True):
        limbs = [c.names[k].startswith(("upper", "fore", "hand")) for k in (i, j)]
        margin = 0.0 if all(limbs) else 0.004
        assert reach == pytest.approx(wide[i] + wide[j] + margin), (c.names[i], c.names[j])
    at_zero = rig.chain.frames(np.zeros(len(rig.coordinates)))
    n = pair(these, "hand_R", "trunk_1")
    k = c.names.index("hand_R")
    hand = at_zero.rotations[c.node[k]] @ c.a[k] + at_zero.positions[c.node[k]]
    assert np.linalg.norm(hand - [0.0, 1.07, 0.0]) < these.reach[n]


def test_overlaps_are_reported_deepest_first() -> None:
    q = np.array(RIG.coordinates.idle)
    q[RIG.coordinates.index["f_arm_R.flexion"]] = np.radians(120)
    q[RIG.coordinates.index["arm_R.rotation"]] = np.radians(90)
    q[RIG.coordinates.index["arm_R.flexion"]] = np.radians(-10)
    found = obstacles().overlaps(q)
    assert found[0].depth_m > 0.01
    assert {found[0].first, found[0].second} & {"fore_R", "hand_R"}
    depths = [o.depth_m for o in found]
    assert depths == sorted(depths, reverse=True)
    apart, radius = (
        axes_apart(RIG, q),
        dict(zip(RIG.capsules.names, RIG.capsules.radius, strict=True)),
    )
    for o in found:  # without the margin that a search keeps
        gap = apart[frozenset({o.first, o.second})]
        assert o.depth_m == pytest.approx(radius[o.first] + radius[o.second] - gap)


def axes_apart(rig: Rig, q: Array) -> dict[frozenset[str], float]:
    """Return how far the axes of pairs of capsules are apart in a posture, metres."""
    c, frames = rig.capsules, rig.chain.frames(q)
    R, o = frames.rotations[c.node], frames.positions[c.node]
    a, b = (np.einsum("kij,kj->ki", R, end) + o for end in (c.a, c.b))
    i, j = np.vstack([c.pairs, c.finger_pairs]).T
    gaps = segment_distance(a[i], b[i], a[j], b[j])
    return {
        frozenset({c.names[k], c.names[m]}): float(gap)
        for k, m, gap in zip(i, j, gaps, strict=True)
    }


def test_a_body_without_thumbs_keeps_clear_of_itself_too() -> None:
    bones = {name: nodes for name, nodes in RIG.bones.items() if not name.startswith("thumb")}
    these = Obstacles(Binding(replace(RIG, bones=bones), Side.RIGHT), BODY, ())
    np.testing.assert_array_equal(these.reach, obstacles().reach)


def test_thick_fingers_are_as_near_as_when_straight_and_thick_thumbs_as_in_the_mesh(
    signer: Rig,
) -> None:
    c = replace(signer.capsules, radius=2.5 * signer.capsules.radius)
    rig = replace(signer, capsules=c)
    these = Obstacles(Binding(rig, Side.RIGHT), anatomy(rig.chain, rig.coordinates), ())
    straight = axes_apart(rig, np.zeros(len(rig.coordinates)))
    modelled = axes_apart(rig, np.array(rig.coordinates.bind))
    digits = ("thumb", "index", "middle", "ring", "little")
    nearer = {"thumb": 0, "fingers": 0}
    for (i, j), reach in zip(these.pairs, these.reach, strict=True):
        names = frozenset({c.names[i], c.names[j]})
        if all("_R" in name and name.startswith(digits) for name in names):
            thumb = any(name.startswith("thumb") for name in names)
            gap, thick = (modelled if thumb else straight)[names], c.radius[i] + c.radius[j]
            assert reach == pytest.approx(min(thick, gap)), names
            nearer["thumb" if thumb else "fingers"] += bool(gap < thick)
    assert min(nearer.values()) > 0
