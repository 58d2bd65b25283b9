"""Which capsules may overlap where touching is meant, and by how much."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from stick_obstacles import RIG, Array, obstacles, pair
from tree_sign import S, W

from azee_rig.rig import Capsules, Rig
from azee_solver.anatomy import anatomy
from azee_solver.binding import Binding
from azee_solver.collisions import Obstacles
from azee_solver.constraint import Constraint, Place
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
