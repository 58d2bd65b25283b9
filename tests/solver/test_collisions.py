"""Distances of capsules, which pairs count, and where touching is meant."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from stick_body import stick_body
from tree_sign import S, W

from azee_rig.rig import Capsules, Rig
from azee_solver import penetration
from azee_solver.anatomy import anatomy
from azee_solver.binding import Binding
from azee_solver.collisions import Obstacles, segment_distance
from azee_solver.constraint import Constraint, Place
from azee_solver.evaluate import evaluator
from azee_solver.geometry import (
    Between,
    FreePoint,
    Point,
    Side,
    Site,
    SitePoint,
    Vec,
    VTranslate,
    WorldPoint,
)
from azee_solver.penetration import meant_contact, mesh_penetration
from azee_solver.winding import distances, winding_numbers

Array = NDArray[np.float64]
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


def with_fingers(along_m: Sequence[float]) -> Rig:
    """The body with capsules on the index: how far they lie beyond the palm's site."""
    c, node = RIG.capsules, RIG.chain.names.index("index_L_1")
    zero = RIG.chain.frames(np.zeros(len(RIG.coordinates)))
    site, R, o = RIG.sites["PA_L"].point(zero), zero.rotations[node], zero.positions[node]
    toward = zero.rotations[RIG.bones["palm_L"].node][:, 1]
    at = np.array([R.T @ (site + x * toward - o) for x in along_m])
    names = tuple(f"index_{n}" for n in range(len(at)))
    trunk, first = c.names.index("upper_R"), len(c.names)
    capsules = Capsules(
        c.names + names,
        np.r_[c.node, [node] * len(at)],
        np.vstack([c.a, at]),
        np.vstack([c.b, at]),
        np.r_[c.radius, [0.01] * len(at)],
        np.vstack([c.pairs, [(trunk, first + n) for n in range(len(at))]]),
        c.finger_pairs,
    )
    return replace(RIG, capsules=capsules)


def allowed(rig: Rig, *constraints: Constraint) -> dict[frozenset[str], float]:
    """How much nearer pairs may come than without constraints, metres; only those that may."""
    body, binding = anatomy(rig.chain, rig.coordinates), Binding(rig, Side.RIGHT)
    plain, these = Obstacles(binding, body, ()), Obstacles(binding, body, constraints)
    names = np.array(rig.capsules.names)
    less = plain.reach - these.reach
    return {
        frozenset(names[pair].tolist()): float(m)
        for pair, m in zip(these.pairs, less, strict=True)
        if m != 0.0
    }


ELBOW_IN_PALM = Place(Site("EL", S), SitePoint(Site("PA", W)), contact=True)


def test_a_meant_contact_concerns_what_is_at_its_two_sites_and_nothing_else() -> None:
    """Neither the forearm below the palm nor the one above the elbow is near enough."""
    assert allowed(RIG, ELBOW_IN_PALM).keys() == {frozenset({"upper_R", "hand_L"})}
    near = replace(RIG.sites["EL_R"], position=np.array([0.0, 0.31, -0.04]))
    rig = replace(RIG, sites={**RIG.sites, "EL_R": near})
    assert allowed(rig, ELBOW_IN_PALM).keys() == {
        frozenset({"upper_R", "hand_L"}),
        frozenset({"fore_R", "hand_L"}),
    }


def test_a_site_of_the_lowest_joint_is_touched_like_others() -> None:
    """One that hangs on no joint at all has no capsules around it."""
    touch = Place(Site("PA", S), SitePoint(Site("ST")), contact=True)
    for node, touched in ((0, {frozenset({"hand_R", "trunk_1"})}), (-1, set())):
        low = replace(RIG.sites["ST"], bone="back_1", node=node, position=np.array([0, 0.1, 0.1]))
        rig = replace(RIG, sites={**RIG.sites, "ST": low})
        assert allowed(rig, touch).keys() == touched


def test_beyond_a_palm_the_farther_a_finger_is_the_less_it_may_overlap() -> None:
    """Wholly up to 4 cm from its skin, half as much at 7 cm and not at all from 10 cm."""
    skin_m = (0.03, 0.05, 0.07, 0.09, 0.12)
    share = (1.0, 5 / 6, 0.5, 1 / 6, 0.0)
    rig = with_fingers([m + 0.01 for m in skin_m])
    found = allowed(rig, ELBOW_IN_PALM)
    at_palm = found[frozenset({"upper_R", "hand_L"})]
    assert at_palm == pytest.approx(0.01 + 0.009)
    fingers = [found.get(frozenset({"upper_R", f"index_{n}"}), 0.0) for n in range(5)]
    np.testing.assert_allclose(fingers, at_palm * np.array(share), atol=1e-9)
    placed = allowed(rig, Place(Site("EL", S), SitePoint(Site("PA", W))))
    assert placed.keys() == {frozenset({"upper_R", "hand_L"})}


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


def test_two_sites_at_one_place_are_meant_to_touch() -> None:
    point = FreePoint(0.0, -0.2, 0.3)
    met = obstacles(Place(Site("PA", S), point), Place(Site("PA", W), point))
    n = pair(met, "hand_R", "hand_L")
    assert obstacles().reach[n] - met.reach[n] == pytest.approx(0.02 + 0.001)
    apart = obstacles(Place(Site("PA", S), point, 0.1), Place(Site("PA", W), point))
    assert apart.reach[n] == obstacles().reach[n]


def test_skin_that_may_be_touched_at_a_measured_place_counts_as_a_called_contact() -> None:
    chest = Site("ST")
    measured = obstacles(Place(Site("PA", S), WorldPoint(0.0, 1.2, 0.2, (chest,))))
    called, placed = (
        obstacles(Place(Site("PA", S), SitePoint(chest), contact=contact))
        for contact in (True, False)
    )
    np.testing.assert_array_equal(measured.reach, called.reach)
    assert (measured.reach < placed.reach).any()


def test_a_contact_between_sites_is_one_with_each_of_them() -> None:
    chest, chin = (SitePoint(Site(name)) for name in ("ST", "CH"))
    between = Between(VTranslate(chest, Vec(0.0, 0.01, 0.0)), chin, 0.5)
    plain = obstacles()
    called = obstacles(Place(Site("PA", S), between, contact=True, within_m=0.02))
    each = [obstacles(Place(Site("PA", S), p, contact=True)).reach for p in (chest, chin)]
    np.testing.assert_allclose(called.reach, np.minimum(*each))
    assert (called.reach < plain.reach).any()
    uncalled = obstacles(Place(Site("PA", S), between, within_m=0.02))
    np.testing.assert_array_equal(uncalled.reach, plain.reach)


def test_a_contact_between_sites_is_also_one_with_the_skin_between(signer: Rig) -> None:
    """The collar is hollow between neck and chest: capsules stand out more than at either."""
    binding = Binding(signer, Side.RIGHT)
    neck, chest = (SitePoint(Site(name)) for name in ("NK", "ST"))

    def reach(point: Point) -> Array:
        place = Place(Site("I_KNt", S, 1), point, contact=True)
        return Obstacles(binding, anatomy(signer.chain, signer.coordinates), (place,)).reach

    on_skin = reach(Between(neck, chest, 0.5, on_skin=True))
    each = np.minimum(reach(neck), reach(chest))
    assert (on_skin <= each).all()
    assert (on_skin < each - 0.005).any()


def test_other_fingers_of_a_hand_lie_on_the_trunk_that_one_touches(signer: Rig) -> None:
    def reach(other: Site) -> dict[tuple[str, str], float]:
        body = anatomy(signer.chain, signer.coordinates)
        place = Place(Site("M_PAD", S), SitePoint(other), contact=True)
        these = Obstacles(Binding(signer, Side.RIGHT), body, [place])
        names = signer.capsules.names
        return {(names[i], names[j]): r for (i, j), r in zip(these.pairs, these.reach, strict=True)}

    chest, tip = reach(Site("ST")), reach(Site("M_PAD", W))
    lower = {pair for pair in chest if chest[pair] < tip[pair] - 0.005}
    fingers = {name for pair in lower for name in pair if name.startswith(("index_R", "ring_R"))}
    assert {"index_R_3", "ring_R_3"} <= fingers
    assert all(any(name.startswith("trunk") for name in pair) for pair in lower)


@pytest.mark.parametrize(
    ("other", "contact", "wide"),
    [
        (Site("ST"), True, True),
        (Site("ST"), False, False),
        (Site("WR", W), True, True),
        (Site("WR", W), False, False),
        (Site("SH", W), True, True),
        (Site("M_PAD", W), True, False),
    ],
)
def test_other_fingers_take_part_where_one_is_called_to_touch_a_trunk_or_an_arm(
    signer: Rig, other: Site, contact: bool, wide: bool
) -> None:
    """Less than the one that touches does."""
    found = allowed(signer, Place(Site("M_PAD", S), SitePoint(other), contact=contact))
    most = {
        finger: max((m for pair, m in found.items() if any(n.startswith(finger) for n in pair)),
                    default=0.0)
        for finger in ("middle_R_3", "ring_R_3")
    }  # fmt: skip
    assert (most["ring_R_3"] > 0.0) == wide
    assert most["middle_R_3"] > 0.0
    assert most["ring_R_3"] <= most["middle_R_3"]


def test_a_contact_that_is_called_one_forgives_a_millimetre_more() -> None:
    """Two elbows, whose capsules do not stand out beyond their skin."""
    for contact, forgiven_m in ((False, 0.001), (True, 0.002)):
        elbows = Place(Site("EL", S), SitePoint(Site("EL", W)), contact=contact)
        assert allowed(RIG, elbows) == {
            frozenset({"upper_L", "upper_R"}): pytest.approx(forgiven_m)
        }


def test_how_far_a_forearm_stands_out_at_the_elbow_is_told_with_the_elbow_bent() -> None:
    """By nine tenths of 145°: there its capsule begins next to a site in the crook of the arm."""
    crook = replace(RIG.sites["EL_R"], position=np.array([0.0, 0.29, 0.02]))
    rig = replace(RIG, sites={**RIG.sites, "EL_R": crook})
    bent = np.radians(0.9 * 145.0)
    begins = np.array([0.3, 0.0]) + 0.03 * np.array([np.cos(bent), np.sin(bent)])
    out_m = 0.035 - np.linalg.norm(begins - crook.position[1:])
    found = allowed(rig, ELBOW_IN_PALM)[frozenset({"fore_R", "hand_L"})]
    assert found == pytest.approx(out_m + 0.01 + 0.009, abs=1e-6)


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


CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=np.float64)
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
CUBE = CORNERS[[t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))]]


def test_winding_numbers_tell_inside_from_outside_even_of_an_open_box() -> None:
    points = np.array([[0.5, 0.5, 0.5], [0.1, 0.9, 0.2], [1.5, 0.5, 0.5], [-0.2, 0.1, 0.1]])
    np.testing.assert_allclose(winding_numbers(points, CUBE), [1, 1, 0, 0], atol=1e-9)
    open_box = CUBE[2:]
    assert winding_numbers(points[:1], open_box)[0] > 0.7


@given(st.integers(0, 10**6), st.integers(1, 40))
def test_winding_numbers_are_the_sum_of_solid_angles(seed: int, count: int) -> None:
    """Also of surfaces that cross themselves, seen from their corners too, and of many turns."""
    random = np.random.default_rng(seed)
    tangle = random.normal(size=(count, 3, 3))
    surface = np.concatenate([tangle, np.repeat(CUBE, 3, axis=0), 2.0 * CUBE - 0.5])
    points = np.concatenate([random.uniform(-0.5, 1.5, (6, 3)), tangle[0, :1], CORNERS[:1]])
    a, b, c = np.moveaxis(surface[None] - points[:, None, None], 2, 0)
    lengths = [np.linalg.norm(v, axis=-1) for v in (a, b, c)]
    volume = np.einsum("ntk,ntk->nt", a, np.cross(b, c))
    spread = np.prod(lengths, axis=0)
    for v, w, length in zip((a, b, c), (b, c, a), (lengths[2], *lengths[:2]), strict=True):
        spread += np.einsum("ntk,ntk->nt", v, w) * length
    exact = np.arctan2(volume, spread)
    flat = np.abs(np.abs(exact) - np.pi) < 1e-9  # a point on a triangle sees it from either side
    sums = exact.sum(axis=1) / (2 * np.pi)
    seen = ~flat.any(axis=1)
    np.testing.assert_allclose(winding_numbers(points, surface)[seen], sums[seen], atol=1e-9)


@given(st.tuples(coordinate, coordinate, coordinate))
def test_distance_to_a_cube(point: tuple[float, float, float]) -> None:
    p = 2 * np.array([point])
    outside = np.linalg.norm(p - np.clip(p, 0, 1))
    inside = min(np.minimum(p, 1 - p).min(), 1.0)
    wanted = outside if outside > 0 else inside
    assert distances(p, CUBE)[0] == pytest.approx(wanted, abs=1e-12)


@pytest.mark.parametrize(
    ("site", "other", "radius_m"),
    [("PA", "ST", 0.055), ("I_TIP", "PA", 0.055), ("I_TIP", "ST", 0.02)],
)
def test_a_touch_is_meant_about_a_finger_and_farther_about_a_palm(
    signer: Rig, site: str, other: str, radius_m: float
) -> None:
    """Whichever of the two sites lies on the palm."""
    body, frames = evaluator(signer, Side.RIGHT), signer.chain.frames(signer.coordinates.idle)
    on = SitePoint(Site(other, Side.LEFT if other == "PA" else None))
    touch = meant_contact(body, frames, Place(Site(site, Side.RIGHT), on))
    assert touch.radius_m == radius_m
    np.testing.assert_allclose(touch.point, body.site(Site(site, Side.RIGHT), frames))


@pytest.mark.parametrize(("winding", "inside"), [(0.48, False), (0.52, True)])
def test_skin_is_inside_a_part_that_surrounds_it_more_than_half(
    signer: Rig, winding: float, inside: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Parts are open where others go on, so that about a wrist there is something in between."""
    monkeypatch.setattr(
        penetration, "winding_numbers", lambda points, surface: np.full(len(points), winding)
    )
    assert bool(mesh_penetration(signer, np.array(signer.coordinates.idle))) == inside
