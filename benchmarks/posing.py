"""Measures dragging: how near a site follows, how long a frame takes, and what the text is worth.

Each row drags a site for ten seconds through the signing space, at 30 frames a second. Times are
processor times of one thread. `off` counts frames at which the site is more than 5 mm from where it
is dragged: other constraints of the text, limits or the body are in its way there; `late` counts
frames that took more than 50 ms, the goal being none. Then the most exact proposal of each kind is
compiled, and its last column tells how far the site is from where it was dragged.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from azee.posing.handle import SiteHandle
from azee.posing.proposal import Proposal
from azee.posing.session import PosingSession
from azee_rig.load import load_rig
from azee_solver import kinematics

Array = NDArray[np.float64]

SPACE = (
    "key .6\n    cstr\n        place @I_TIP(s) ^Mssp\n        orient 'nrm !palm(s) 'along ^down\n"
)
DRAGS = (
    (SPACE, 0.3, "@I_TIP(s)"),
    (SPACE, 0.3, "@PA(s)"),
    (":arbre\n", 0.5, "@H_BACK(w)"),
    (":bien\n", 0.08, "@PA(s)"),
    (":bonjour\n", 0.1, "@M_PAD(s)"),
    (":armoire\n", 0.9, "@I_TIP(w)"),
    (":info-about\n    'topic :cinéma\n    'info :bien\n", 1.2, "@PA(s)"),
)
SECONDS, FPS = 10, 30
LATE_MS, OFF_M = 50.0, 0.005


def main(arguments: Sequence[str] = ()) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="posing", description=__doc__)
    parser.add_argument("--seconds", type=float, default=SECONDS)
    parser.add_argument("--no-compile", action="store_true", help="do not compile proposals")
    options = parser.parse_args(arguments)
    rig = load_rig("signer")
    heads = ("ms median", "ms most", "late", "miss mm", "off", "beyond", "inside")
    print(f"{'':<44}" + "".join(f"{head:>10}" for head in heads))
    for text, at_s, handle in DRAGS:
        session = PosingSession.open(text, at_s, rig)
        frames = int(options.seconds * FPS)
        ms, misses, beyond, inside = dragged(session, handle, frames)
        name = f"{text.split(chr(10))[0]} {handle} at {at_s} s"
        late, off = (sum(np.array(x) > most) for x, most in ((ms, LATE_MS), (misses, OFF_M)))
        row = f"{np.median(ms):10.1f}{max(ms):10.1f}{late:10d}{max(misses) * 1e3:10.2f}{off:10d}"
        print(f"{name:<44}{row}{beyond:10d}{inside:10d}", flush=True)
        if options.no_compile:
            continue
        session.drop()
        there = place_of(session, handle)
        for proposal in exact(session.proposals()):
            off_m = np.linalg.norm(place_of(session.opened_with(proposal), handle) - there)
            print(f"    {proposal.kind:<12}{proposal.written:<62.60}{off_m * 1e3:10.2f} mm")


def dragged(
    session: PosingSession, handle: str, frames: int
) -> tuple[list[float], list[float], int, int]:
    """Drag a site along an eight, and end a little beside where it was.

    Returns: milliseconds and misses in metres of all frames; how many were beyond a limit, and in
    how many a part lay in another.
    """
    start, limits = place_of(session, handle), session.instant.evaluator.rig.coordinates
    ms, misses, beyond, inside = [], [], 0, 0
    for k in range(1, frames + 1):
        turn, share = 4 * math.pi * k / frames, k / frames
        eight = np.array((0.1 * math.sin(turn), 0.08 * math.sin(2 * turn), 0.0))
        target = start + eight + share * np.array((0.02, 0.04, 0.03))
        frame = session.drag(handle, target.tolist())
        ms.append(frame.solve_s * 1e3)
        misses.append(frame.miss)
        beyond += bool(np.any((frame.q < limits.lower) | (frame.q > limits.upper)))
        inside += bool(frame.blocked)
    return ms, misses, beyond, inside


def place_of(session: PosingSession, handle: str) -> Array:
    """Where a site is now, (3,) metres."""
    known, evaluator = session.handle(handle), session.instant.evaluator
    assert isinstance(known, SiteHandle)
    frames = kinematics.frames(evaluator.rig.chain, session.q)
    return evaluator.site(known.site, frames)


def exact(found: Sequence[Proposal]) -> list[Proposal]:
    """The most exact proposal of each kind."""
    best: dict[str, Proposal] = {}
    for proposal in sorted(found, key=lambda p: p.off):
        best.setdefault(proposal.kind, proposal)
    return [*best.values()]


if __name__ == "__main__":
    main()
