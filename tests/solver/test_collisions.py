"""Distances of capsules, which pairs count, and where touching is meant."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from stick_body import stick_body
from tree_sign import S, W

from azee_rig.rig import Rig
from azee_solver.anatomy import anatomy
from azee_solver.binding import Binding
from azee_solver.collisions import Obstacles, segment_distance
from azee_solver.constraint import Constraint, Place
from azee_solver.geometry import FreePoint, Side, Site, SitePoint
from azee_solver.winding import distances, winding_numbers

RIG = stick_body()
BODY = anatomy(RIG.chain, RIG.coordinates)


def obstacles(*constraints: Constraint) -> Obstacles:
    return Obstacles(Binding(RIG, Side.RIGHT), BODY, constraints)


def pair(these: Obstacles, first: str, second: str) -> int:
    names = RIG.capsules.names
    wanted = {names.index(first), names.index(second)}
    return next(n for n, (i, j) in enumerate(these.pairs) if {int(i), int(j)} == wanted)


coordinate = st.floats(-1, 1).map(lambda x: round(x, 2))
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


def test_a_meant_contact_allows_what_the_capsules_stand_out() -> None:
    plain = obstacles()
    n = pair(plain, "upper_R", "hand_L")
    placed = obstacles(Place(Site("EL", S), SitePoint(Site("PA", W))))
    called = obstacles(Place(Site("EL", S), SitePoint(Site("PA", W)), contact=True))
    # The palm's site is .02 from its axis, inside a capsule of radius .03.
    assert plain.reach[n] - placed.reach[n] == pytest.approx(0.01 + 0.001)
    assert plain.reach[n] - called.reach[n] == pytest.approx(0.01 + 0.009)
    other = pair(plain, "hand_R", "trunk_1")
    assert plain.reach[other] == placed.reach[other] == called.reach[other]


def test_what_touches_an_elbow_may_touch_upper_arm_and_forearm(signer: Rig) -> None:
    touch = Place(Site("EL", S), SitePoint(Site("PA", W)), contact=True)
    binding, body = Binding(signer, Side.RIGHT), anatomy(signer.chain, signer.coordinates)
    plain, called = (Obstacles(binding, body, asked) for asked in ((), (touch,)))
    names, allowed = signer.capsules.names, plain.reach - called.reach
    depth = {
        name: float(allowed[k])
        for k, pair in enumerate(plain.pairs)
        for name in ("upper_arm_R", "forearm_R", "shoulder_R", "hand_R_ulnar")
        if {name, "hand_L_ulnar"} == {names[i] for i in pair}
    }
    # The forearm's capsule does not stand out beyond the elbow, the upper arm's does by 19 mm.
    assert 0.009 < depth["forearm_R"] < 0.013
    assert depth["upper_arm_R"] == pytest.approx(depth["forearm_R"] + 0.019, abs=1e-3)
    assert depth["hand_R_ulnar"] == 0.0
    wrist = Place(Site("WR", S), SitePoint(Site("PA", W)), contact=True)
    at_wrist = plain.reach - Obstacles(binding, body, (wrist,)).reach
    near = {names[i] for k in np.flatnonzero(at_wrist) for i in plain.pairs[k] if "_R" in names[i]}
    assert {"forearm_R", "hand_R_ulnar"} <= near
    assert not near & {"upper_arm_R", "index_R_1", "thumb_R_1"}


def test_each_of_two_meant_contacts_allows_its_own_pairs_and_the_wider_one_what_both_touch() -> (
    None
):
    plain = obstacles()
    elbow = Place(Site("EL", S), SitePoint(Site("PA", W)), contact=True)
    chest = Place(Site("PA", S), SitePoint(Site("ST")))
    same = Place(Site("EL", S), SitePoint(Site("PA", W)))
    alone = {c: plain.reach - obstacles(c).reach for c in (elbow, chest, same)}
    at_elbow, at_chest = pair(plain, "upper_R", "hand_L"), pair(plain, "hand_R", "trunk_3")
    assert alone[elbow][at_elbow] > alone[same][at_elbow] > 0.0 == alone[chest][at_elbow]
    assert alone[chest][at_chest] > 0.0 == alone[elbow][at_chest]
    for two in ((elbow, chest), (chest, elbow), (elbow, same), (same, elbow)):
        both = plain.reach - obstacles(*two).reach
        np.testing.assert_allclose(both, np.maximum(*(alone[c] for c in two)), atol=1e-12)


def test_two_sites_at_one_place_are_meant_to_touch() -> None:
    point = FreePoint(0.0, -0.2, 0.3)
    met = obstacles(Place(Site("PA", S), point), Place(Site("PA", W), point))
    n = pair(met, "hand_R", "hand_L")
    assert obstacles().reach[n] - met.reach[n] == pytest.approx(0.02 + 0.001)
    apart = obstacles(Place(Site("PA", S), point, 0.1), Place(Site("PA", W), point))
    assert apart.reach[n] == obstacles().reach[n]


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


CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=np.float64)
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
CUBE = CORNERS[[t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))]]


def test_winding_numbers_tell_inside_from_outside_even_of_an_open_box() -> None:
    points = np.array([[0.5, 0.5, 0.5], [0.1, 0.9, 0.2], [1.5, 0.5, 0.5], [-0.2, 0.1, 0.1]])
    np.testing.assert_allclose(winding_numbers(points, CUBE), [1, 1, 0, 0], atol=1e-9)
    open_box = CUBE[2:]
    assert winding_numbers(points[:1], open_box)[0] > 0.7


@given(st.tuples(coordinate, coordinate, coordinate))
def test_distance_to_a_cube(point: tuple[float, float, float]) -> None:
    p = 2 * np.array([point])
    outside = np.linalg.norm(p - np.clip(p, 0, 1))
    inside = min(np.minimum(p, 1 - p).min(), 1.0)
    wanted = outside if outside > 0 else inside
    assert distances(p, CUBE)[0] == pytest.approx(wanted, abs=1e-12)
