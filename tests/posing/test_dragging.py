"""Dragging: sites follow, limits and collisions hold, and no frame takes long."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.posing.drag import OPTIONS
from azee.posing.session import Frame, PosingSession
from azee_grammar.diagnostic import AZeeError
from azee_rig.rig import Rig
from azee_solver import kinematics
from azee_solver.anatomy import anatomy
from azee_solver.collisions import Obstacles

Array = NDArray[np.float64]

SPACE = (
    "key .6\n    cstr\n        place @I_TIP(s) ^Mssp\n        orient 'nrm !palm(s) 'along ^down\n"
)
FOLLOWS_M = 0.005


@pytest.fixture(scope="module")
def session(signer: Rig) -> PosingSession:
    return PosingSession.open(SPACE, 0.3, signer)


@pytest.fixture
def at_rest(session: PosingSession) -> PosingSession:
    """A body of which nothing is asked but a finger in space, and of which nothing was dragged."""
    for handle in session.goals:
        session.release(handle)
    return session


def place_of(session: PosingSession, handle: str) -> Array:
    known = session.handle(handle)
    evaluator = session.instant.evaluator
    frames = kinematics.frames(evaluator.rig.chain, session.q)
    return evaluator.site(known.site, frames)  # type: ignore[union-attr]


def around(start: Array, share: float) -> Array:
    """An eight through the signing space, .2 m wide and .16 m high."""
    turn = 2 * math.pi * share
    offset = (0.1 * math.sin(turn), 0.08 * math.sin(2 * turn), 0.05 * (1 - math.cos(turn)))
    return np.asarray(start + np.array(offset))


def ahead(start: Array, share: float) -> Array:
    """Forward by 6 cm and back, and 3 cm up and down."""
    turn = 2 * math.pi * share
    offset = (0.0, 0.03 * math.sin(2 * turn), 0.03 * (1 - math.cos(turn)))
    return np.asarray(start + np.array(offset))


def aside(start: Array, share: float) -> Array:
    """Twice an eight, .2 m wide and .16 m high: with the weak elbow to the flank and away."""
    turn = 4 * math.pi * share
    offset = (0.1 * math.sin(turn), 0.08 * math.sin(2 * turn), 0.0)
    return np.asarray(start + np.array(offset))


def dragged(
    session: PosingSession, handle: str, path: Callable[[Array, float], Array], frames: int
) -> list[Frame]:
    start = place_of(session, handle)
    return [session.drag(handle, path(start, k / frames).tolist()) for k in range(frames)]


def check(session: PosingSession, frames: list[Frame]) -> None:
    """Limits hold to the last bit, no part that moves enters another, and frames are quick."""
    rig = session.instant.evaluator.rig
    for frame in frames:
        assert np.all(frame.q >= rig.coordinates.lower)
        assert np.all(frame.q <= rig.coordinates.upper)
        assert frame.blocked == ()


def test_a_site_follows_and_the_solver_is_fast(at_rest: PosingSession) -> None:
    frames = dragged(at_rest, "@I_TIP(s)", around, 20)
    assert max(frame.miss for frame in frames) < FOLLOWS_M
    check(at_rest, frames)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "at_s", "handle", "path"),
    [
        (SPACE, 0.3, "@I_TIP(s)", around),
        (SPACE, 0.3, "@PA(s)", around),
        (":bien\n", 0.85, "@PA(s)", around),
        (":arbre\n", 0.5, "@H_BACK(w)", ahead),
        (":arbre\n", 0.5, "@H_BACK(w)", aside),
        (":mignon\n", 0.4, "@M_TIP(s)", ahead),
    ],
)
def test_for_ten_seconds_a_hand_follows(
    text: str, at_s: float, handle: str, path: Callable[[Array, float], Array], signer: Rig
) -> None:
    """At 30 frames a second: within 5 mm; `benchmarks/run.py posing` has the times.

    Where the body is beside the hand, the way leads ahead of it; an elbow makes room by itself.
    """
    session = PosingSession.open(text, at_s, signer)
    frames = dragged(session, handle, path, 300)
    assert max(frame.miss for frame in frames) < FOLLOWS_M
    check(session, frames)


def test_a_hand_that_is_dragged_into_the_body_slides_along_it(at_rest: PosingSession) -> None:
    chest = np.array([0.0, 1.25, -0.1])
    frames = dragged(at_rest, "@PA(s)", lambda start, k: start + k * (chest - start), 25)
    check(at_rest, frames)
    assert frames[-1].miss > 0.05
    rig, binding = at_rest.instant.evaluator.rig, at_rest.instant.evaluator.binding
    found = Obstacles(binding, anatomy(rig.chain, rig.coordinates), []).overlaps(frames[-1].q)
    assert all(o.depth_m <= OPTIONS.overlap_m for o in found if "trunk" in (o.first, o.second))


def test_beyond_reach_the_arm_points_there_and_says_why(at_rest: PosingSession) -> None:
    target = (-0.2, 1.3, 2.0)
    for _ in range(15):
        frame = at_rest.drag("@I_TIP(s)", target)
    check(at_rest, [frame])
    assert frame.place is not None
    shoulder = at_rest.instant.evaluator.rig.landmarks.shoulder_middle
    assert np.linalg.norm(np.array(frame.place) - shoulder) > 0.5
    (told,) = at_rest.drop()
    assert told.reason is not None
    assert "out of reach" in told.summary


@pytest.mark.parametrize(
    ("handle", "target"),
    [
        ("nrm !palm(s)", (0.0, 1.0, 0.3)),
        ("!palm(s)", (0.3, 0.4, 1.0)),
        ("!index(s, 2)", (0.2, -0.5, 0.6)),
        ("gaze", (0.5, 1.2, 0.8)),
    ],
)
def test_bones_and_the_gaze_are_turned(
    handle: str, target: tuple[float, ...], at_rest: PosingSession
) -> None:
    frame = None
    for _ in range(4):
        frame = at_rest.drag(handle, target)
    assert frame is not None
    assert frame.miss < math.radians(1.0)


def test_fingers_bend_and_the_face_moves(at_rest: PosingSession) -> None:
    coordinates = at_rest.instant.evaluator.rig.coordinates
    bend = coordinates.index["index_R_1.flexion"]
    straight, bent = (at_rest.drag("'index_bend s", (w,)).q[bend] for w in (0.0, 0.6))
    assert bent - straight > math.radians(30)
    smile = at_rest.drag("'AU12", (0.7,)).unit_weights
    assert smile != at_rest.drag("'AU12", (0.0,)).unit_weights


def _upwards(start: Array, share: float) -> Array:
    return start + np.array((0.0, 0.1, 0.05)) * share


def test_what_depends_on_a_hand_goes_along(signer: Rig) -> None:
    """In `arbre` the strong elbow stands on the weak palm."""
    session = PosingSession.open(":arbre\n", 0.5, signer)
    before = place_of(session, "@EL(s)") - place_of(session, "@PA(w)")
    frames = dragged(session, "@H_BACK(w)", _upwards, 12)
    check(session, frames)
    after = place_of(session, "@EL(s)") - place_of(session, "@PA(w)")
    assert np.linalg.norm(after - before) < 0.005


@pytest.mark.parametrize(
    ("handle", "target", "words"),
    [
        ("@NOWHERE", (0, 1, 0), "AZee has no site"),
        ("@I_TIP(s)", (0, 9, 0), "too far"),
        ("@I_TIP(s)", (math.nan, 1, 0), "three numbers"),
        ("'AU12", (0.5, 1), "a weight"),
        ("^Mssp", (0, 1, 0), "unknown-site"),
    ],
)
def test_impossible_drags_are_refused(
    handle: str, target: tuple[float, ...], words: str, at_rest: PosingSession
) -> None:
    with pytest.raises(AZeeError, match=words):
        at_rest.drag(handle, target)


def test_an_instant_outside_the_clip_is_refused(at_rest: PosingSession) -> None:
    with pytest.raises(AZeeError, match="outside the clip"):
        PosingSession(at_rest.text, at_rest.made, 60.0)
