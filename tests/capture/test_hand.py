"""A person's hand: what is simulated comes back, inside the limits, as by the general solver."""

from __future__ import annotations

import numpy as np
import pytest

from azee.capture.calibration import calibrate
from azee.capture.hand import TIP_SHARE, Hand, HandShape
from azee.capture.hand_fit import HandFit
from azee.capture.markers import MarkersError
from azee.capture.places import digit_markers, place_of, root_markers
from azee_rig.rig import Rig
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Side
from azee_solver.solve import solve

NAMES = tuple(f"{d}_{p}" for d in ("thumb", "index", "middle", "ring", "little")
              for p in ("tip", "middle"))  # fmt: skip


def own_shape(hand: Hand, names: tuple[str, ...] = NAMES) -> HandShape:
    """The body's own hand, with markers at its sites."""
    markers = {name: (place, hand.site(place)) for name, place in digit_markers(names).items()}
    return HandShape(hand.own_offsets, markers, np.eye(3), np.zeros(3))


def bending(hand: Hand, count: int) -> np.ndarray:
    """Postures in which all digits bend and stretch, well inside the limits."""
    c = hand.limits
    q = np.tile(c.idle, (count, 1))
    share = 0.5 + 0.35 * np.sin(np.linspace(0.0, 6.0, count)[:, None] + hand.columns)
    low, high = c.lower[hand.columns], c.upper[hand.columns]
    q[:, hand.columns] = low + share * (high - low)
    last, before = hand.followers
    q[:, last] = np.clip(TIP_SHARE * q[:, before], c.lower[last], c.upper[last])
    return q


@pytest.mark.parametrize("side", ["R", "L"])
@pytest.mark.parametrize("coupled", [True, False])
def test_markers_are_met_inside_the_limits(signer: Rig, side: str, coupled: bool) -> None:
    hand = Hand(signer, side, coupled)
    shape = own_shape(hand)
    wanted = bending(hand, 40)
    targets = hand.marker_positions(shape, wanted)
    start = np.tile(hand.limits.idle, (40, 1))
    found = HandFit(hand, shape).solved(targets, start, 100.0, keep=0.01)
    off = np.linalg.norm(hand.marker_positions(shape, found) - targets, axis=-1)
    assert off.mean() < 4e-4
    assert (found >= signer.coordinates.lower).all()
    assert (found <= signer.coordinates.upper).all()


def test_targets_out_of_reach_leave_the_limits_exact(signer: Rig) -> None:
    hand = Hand(signer, "R")
    shape = own_shape(hand)
    idle = np.tile(hand.limits.idle, (10, 1))
    targets = hand.marker_positions(shape, idle) + [0.0, 0.0, -0.3]
    found = HandFit(hand, shape).solved(targets, idle, 100.0)
    c = signer.coordinates
    assert ((found >= c.lower) & (found <= c.upper)).all()
    assert np.isin(found[:, hand.columns], [c.lower, c.upper]).any()


def test_coupled_joints_follow_equation_2_1_exactly(signer: Rig) -> None:
    hand = Hand(signer, "R", coupled=True)
    shape = own_shape(hand)
    targets = hand.marker_positions(shape, bending(Hand(signer, "R"), 20)) + 0.005
    found = HandFit(hand, shape).solved(targets, np.tile(hand.limits.idle, (20, 1)), 100.0)
    last, before = hand.followers
    np.testing.assert_allclose(found[:, last], TIP_SHARE * found[:, before], rtol=0, atol=1e-15)


def test_each_marker_is_a_site_that_the_general_solver_places(signer: Rig) -> None:
    """The fit and `azee_solver.solve` agree on the same constraints of the same body."""
    hand = Hand(signer, "R")
    shape = own_shape(hand, ("index_tip", "index_middle"))
    fit = HandFit(hand, shape)
    wanted = bending(hand, 1)
    targets = hand.marker_positions(shape, wanted)
    tasks = fit.tasks(targets[0])
    found = fit.solved(targets, np.tile(hand.limits.idle, (1, 1)), 100.0, keep=0.01)[0]
    evaluator = Evaluator(fit.rig, Side.RIGHT)
    frames = fit.rig.chain.frames(found)
    assert all(evaluator.residual(task.constraint, frames, found)[0] < 5e-4 for task in tasks)
    general = solve(
        fit.rig, tasks, dominant=Side.RIGHT, start=signer.coordinates.idle,
        reference=signer.coordinates.idle,
    )  # fmt: skip
    assert all(constraint.met for constraint in general.constraints)


def test_a_larger_hand_is_found_from_its_markers(signer: Rig) -> None:
    hand = Hand(signer, "R")
    own = own_shape(hand)
    larger = HandShape(
        1.1 * own.offsets, {n: (p, 1.1 * at) for n, (p, at) in own.markers.items()},
        own.rotation, np.array([0.01, 0.02, 0.03]),
    )  # fmt: skip
    poses = larger.into_root(hand.marker_positions(larger, bending(hand, 30)))
    found = calibrate(poses, digit_markers(NAMES), hand)
    assert found.off_m.mean() < 0.0015
    lengths = np.linalg.norm(found.shape.offsets, axis=1) / np.linalg.norm(own.offsets, axis=1)
    assert lengths.mean() == pytest.approx(1.1, abs=0.12)  # they hardly tell


PLACES = {
    "index_tip": ("index", 3), "middle_middle": ("middle", 2), "middle_tip": ("middle", 3),
    "Ann:Thumb-Middle": ("thumb", 2), "pinky.mcp": ("little", 1), "ring 2": ("ring", 2),
    "R_index_dip": ("index", 3),
}  # fmt: skip


@pytest.mark.parametrize("name", PLACES)
def test_names_tell_places(name: str) -> None:
    found = place_of(name)
    assert found is not None
    assert (found.digit, found.bone) == PLACES[name]


@pytest.mark.parametrize("name", ["hand_top", "elbow", "index", "middle", "index_tip_middle"])
def test_other_names_tell_none(name: str) -> None:
    assert place_of(name) is None


def test_a_root_is_told_by_names_or_asked_for() -> None:
    assert root_markers(("hand_a", "wrist_b", "index_tip", "forearm")) == (
        "hand_a", "wrist_b", "forearm",
    )  # fmt: skip
    with pytest.raises(MarkersError, match="no three markers are the root's"):
        root_markers(("hand_a", "index_tip"))
    with pytest.raises(MarkersError, match="no marker's name tells a place on a finger"):
        digit_markers(("a", "b"))
