"""Proposals: their words, where they are written, and that compiling them puts the hand there."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.cli.main import run
from azee.posing.proposal import Proposal
from azee.posing.session import PosingSession
from azee_grammar.format import format_file
from azee_grammar.source import Source
from azee_rig.rig import Rig
from azee_solver import kinematics
from azee_solver.outcome import Outcome

Array = NDArray[np.float64]

SPACE = """\
# hello
key .6
    cstr
        place @I_TIP(s) ^Mssp  # here
        orient 'nrm !palm(s) 'along ^down
"""
EXACT_M = 0.001


def place_of(session: PosingSession, handle: str) -> Array:
    evaluator = session.instant.evaluator
    frames = kinematics.frames(evaluator.rig.chain, session.q)
    return evaluator.site(session.handle(handle).site, frames)  # type: ignore[union-attr]


def dragged_by(session: PosingSession, handle: str, offset: Sequence[float]) -> Array:
    """Drag a site; where it is when it is dropped."""
    session.drag_along(handle, session.beside(handle, offset))
    session.drop()
    return place_of(session, handle)


def of_kind(found: Sequence[Proposal], kind: str) -> Proposal:
    """The most exact proposal of a kind."""
    return min((p for p in found if p.kind == kind), key=lambda p: p.off)


def test_the_constraint_of_the_text_is_replaced_and_the_rest_kept(signer: Rig) -> None:
    session = PosingSession.open(SPACE, 0.3, signer)
    there = dragged_by(session, "@I_TIP(s)", (0.02, 0.08, 0.04))
    best = session.proposals()[0]
    assert best.kind == "replace"
    after = best.document.text
    assert best.change.applied(SPACE) == after
    assert best.change.inverse(SPACE).applied(after) == SPACE
    assert after == SPACE.replace("place @I_TIP(s) ^Mssp", best.written)
    assert format_file(Source("a", after)) == after
    data = json.loads(json.dumps(best.as_json()))
    assert data["change"]["insert"] in after
    again = session.opened_with(best)
    assert again.made.report.met
    off = np.linalg.norm(place_of(again, "@I_TIP(s)") - there)
    assert abs(off - best.off) < EXACT_M


def test_a_site_that_is_near_is_named(signer: Rig) -> None:
    session = PosingSession.open("key .6 (place @I_TIP(s) @CH 'dist .05)\n", 0.3, signer)
    evaluator = session.instant.evaluator
    frames = kinematics.frames(evaluator.rig.chain, session.q)
    chin = evaluator.rig.sites["CH"]
    session.drag("@I_TIP(s)", (chin.point(frames) + 0.02 * chin.outward(frames)).tolist())
    assert any(p.written.startswith("place @I_TIP(s) @CH 'dist .0") for p in session.proposals())


@pytest.mark.parametrize(
    ("handle", "target", "written"),
    [
        ("!palm(s)", (0.02, 1.0, 0.03), "orient 'dir !palm(s) 'along ^up"),
        ("nrm !palm(s)", (0.7, 0.0, 0.72), "orient 'nrm !palm(s) 'along vsum(^fwd, in(s))"),
        ("gaze", (0.0, 1.5, 3.0), "look ^fwd"),
        ("'AU12", (0.4,), "morph 'AU12 .4"),
    ],
)
def test_directions_gaze_and_face_have_words(
    handle: str, target: tuple[float, ...], written: str, signer: Rig
) -> None:
    session = PosingSession.open(SPACE, 0.3, signer)
    for _ in range(4):
        session.drag(handle, target)
    found = session.proposals()
    assert written in [p.written for p in found[:3]]
    assert {p.kind for p in found} <= {"replace", "beside", "block"}
    for proposal in found:
        assert proposal.document.text.count("# here") == 1


def test_a_hand_shape_is_named_and_written_instead_of_another(signer: Rig) -> None:
    text = "key .5\n    cstr\n        :#fist\n        place @PA(s) ^Mssp\n"
    session = PosingSession.open(text, 0.25, signer)
    for finger in ("index", "middle", "ring", "little"):
        for joint in ("bend", "hook"):
            session.drag(f"'{finger}_{joint} s", (0.0,))
    found = session.proposals("'index_bend s")
    shapes = [p for p in found if p.written.startswith(":#")]
    assert shapes
    assert shapes[0].kind == "replace"
    assert "hand" in shapes[0].written
    assert ":#fist" not in shapes[0].document.text
    assert session.opened_with(shapes[0]).made.report.met


def test_where_nothing_is_in_force_a_block_is_added(signer: Rig) -> None:
    session = PosingSession.open("# a fist\nkey .5 :#fist  # closed\n", 0.25, signer)
    there = dragged_by(session, "@PA(s)", (0.05, 0.25, 0.2))
    exact = of_kind(session.proposals(), "block")
    assert exact.document.text.startswith("# a fist\nsync\n    'SIG (key .5 :#fist)  # closed\n")
    again = session.opened_with(exact)
    assert np.linalg.norm(place_of(again, "@PA(s)") - there) < EXACT_M


CASES = [
    (":bien\n", 0.08, "@PA(s)", ("argument", "relocate", "own-rule")),
    (":arbre\n", 0.5, "@H_BACK(w)", ("argument", "relocate", "own-rule")),
    (":armoire\n", 0.9, "@I_TIP(w)", ("argument", "own-rule")),
    (":bonjour\n", 0.1, "@M_PAD(s)", ("own-rule",)),
    (":info-about\n    'topic :cinéma\n    'info :bien\n", 1.2, "@PA(s)", ("block",)),
]


@pytest.mark.slow
@pytest.mark.parametrize(("text", "at_s", "handle", "kinds"), CASES)
def test_compiled_the_text_puts_the_hand_within_a_millimetre(
    text: str, at_s: float, handle: str, kinds: tuple[str, ...], signer: Rig
) -> None:
    session = PosingSession.open(text, at_s, signer)
    there = dragged_by(session, handle, (0.02, 0.04, 0.03))
    found = session.proposals()
    for kind in kinds:
        exact = of_kind(found, kind)
        again = session.opened_with(exact)
        off_m = float(np.linalg.norm(place_of(again, handle) - there))
        assert off_m < EXACT_M + eased_m(again), (kind, exact.written)


def eased_m(session: PosingSession) -> float:
    """By how much compiling has eased a placement for comfort, and says so."""
    eased = (c for c in session.made.report.constraints if c.outcome is Outcome.EASED)
    return max((c.residual or 0.0 for c in eased if c.unit == "m"), default=0.0)


def test_the_command_prints_and_writes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "hello.azee"
    file.write_text(SPACE, encoding="utf-8")
    asked = ["pose", str(file), "--at", ".3s", "--by", "I_TIP(s)", "0", "0.1", "0"]
    assert run(asked) == 0
    first = capsys.readouterr().out.splitlines()[0]
    assert first == "1  place @I_TIP(s) vtranslate(^Mssp, scale(^up, .1))"
    assert file.read_text(encoding="utf-8") == SPACE
    assert run([*asked, "--apply", "--quiet"]) == 0
    written = file.read_text(encoding="utf-8")
    assert written == SPACE.replace("^Mssp", "vtranslate(^Mssp, scale(^up, .1))")


def test_weights_are_changed_in_the_morph_that_has_them(signer: Rig) -> None:
    text = "key .5 (morph 'AU12 .2 'AU1 .5)\n"
    session = PosingSession.open(text, 0.25, signer)
    session.drag("'AU1", (0.25,))
    (proposal,) = session.proposals()
    assert proposal.document.text == text.replace(".5)", ".25)")
    assert math.isclose(proposal.off, 0.0, abs_tol=1e-9)
