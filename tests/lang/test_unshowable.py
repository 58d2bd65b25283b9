"""Warnings for what no body and no clip can show, as far as a text tells."""

from __future__ import annotations

import numpy as np
import pytest
from evaluations import constraints, problems, score

from azee.lang.known_vector import TINY, known
from azee.lang.unshowable import beyond_frames
from azee_grammar.diagnostic import Severity
from azee_rig.rig import Rig
from azee_solver import path
from azee_solver.constraint import Look
from azee_solver.evaluate import evaluator
from azee_solver.geometry import Side


def circling(turns: float, duration_s: float, between: str = " ") -> str:
    moving = f"moving (circle ^fwd .05 {turns:g}) ^Mssp ^Mssp"
    return f"key {duration_s:g}{between}(place @I_TIP(s) ({moving}))"


def led_around(turns: float, duration_s: float) -> str:
    held = "key .1 (place @I_TIP(s) ^Mssp)"
    led = f"key {duration_s:g} (transpath @I_TIP(s) (circle ^fwd .05 {turns:g}))"
    return f"seq\n    list\n        {held}\n        {led}\n        {held}"


def warned(text: str) -> list[tuple[str, int]]:
    """The code and the line of each warning; a text has nothing worse."""
    found = problems(text)
    assert all(d.severity is Severity.WARNING for d in found)
    return [(d.code, d.span.line) for d in found if d.span is not None]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("key 1\n    morph 'AU12 5", "no face shows `'AU12` with weight 5"),
        ("key 1\n    morph 'AU12 -1.01", "weight -1.01"),
        ("key 1\n    morph 'smile 2", "no face shows `'smile`"),
        ("key 1\n    rotate !head ^up 361", "no bone turns by 361°"),
        ("key 1\n    rotate !head ^up -400", "no bone turns by -400°"),
        ("key 1\n    trill !palm(s) ^up 'amp 181", "no bone goes 181° to either side"),
        ("key 1\n    trill !palm(s) ^up 'amp -181", "no bone goes -181° to either side"),
        ("key 1\n    trill !palm(s) ^up 'freq 99999", "no body shows 99999 oscillations a second"),
        (circling(100_000, 1, "\n    "), "no body shows 100000 turns a second"),
        (circling(-21, 1, "\n    "), "no body shows 21 turns a second"),
    ],
)
def test_what_no_body_shows_is_warned_of_where_it_is_written(text: str, words: str) -> None:
    assert warned(text) == [("beyond-body", 2)]
    assert words in problems(text)[0].message


@pytest.mark.parametrize(
    "text",
    [
        "key 1 (morph 'AU12 1)",
        "key 1 (morph 'AU12 -1)",
        "key 1 (morph 'index_bend s 1.5)",
        "key 1 (rotate !head ^up 360)",
        "key 1 (trill !palm(s) ^up 'amp 180)",
        "key 1 (trill !palm(s) ^up 'freq 20)",
        circling(20, 1),
        circling(100, 5),
        circling(100_000, 0),
        led_around(20, 1),
        "key 1 (look (rotated ^up ^fwd 3600))",
        "key 1 (place @I_TIP(s) (vtranslate ^Mssp vec(0, 0, 0)))",
        "key 1 (look (vsum ^up ^fwd))",
        "key 1 (look (vdiff ^up ^down))",
        "key 1 (look (cross ^up ^fwd))",
        "key 1 (look (vsum (dir !palm(s)) (oppvect (dir !palm(s)))))",
    ],
)
def test_what_a_body_may_show_is_left_to_the_report(text: str) -> None:
    assert problems(text) == []


def test_turns_count_by_the_time_that_a_block_has_in_the_end() -> None:
    around = circling(21, 2)
    short = (
        f"sync\n    'LONG (blank 1)\n    'ROUND ({around})\n    'start/end 'LONG:start 'LONG:end"
    )
    assert warned(short) == [("beyond-body", 3)]
    assert problems(short.replace("blank 1", "blank 2")) == []
    assert warned(led_around(21, 1)) == [("beyond-body", 4)]


@pytest.mark.parametrize(
    "direction",
    [
        "vec(0, 0, 0)",
        "vec(.0000000001, 0, 0)",
        "scale(dir(!palm(s)), 0)",
        "vsum(^up, ^down)",
        "vdiff(^up, ^up)",
        "vdiff(nrm(!palm(s)), nrm(!palm(s)))",
        "cross(^up, ^up)",
        "cross(^up, scale(^down, 3))",
        "cross(vec(1, 2, 3), vec(2, 4, 6))",
        "cross(dir(!palm(s)), dir(!palm(s)))",
        "vsum(out(s), in(s))",
        "vsum(out(s), out(w))",
        "vsum(unit(vec(0, 3, 0)), ^down)",
        "oppvect(vec(0, 0, 0))",
        "towards(@NO, @NO)",
        "rotated(vec(0, 0, 0), ^up, 30)",
    ],
)
def test_a_direction_without_length_is_warned_of_and_the_solver_sees_none(
    direction: str, signer: Rig
) -> None:
    assert warned(f"key 1 (look {direction})") == [("zero-vector", 1)]
    (look,) = constraints(f"look {direction}")
    assert isinstance(look, Look)
    numbers = known(look.vector, Side.RIGHT)
    assert numbers is not None
    assert np.isnan(path.unit(np.array(numbers))).all()
    played = evaluator(signer, Side.RIGHT)
    frames = signer.chain.frames(signer.coordinates.idle)
    assert np.linalg.norm(np.nan_to_num(played.vector(look.vector, frames))) <= TINY


@pytest.mark.parametrize(
    "constraint",
    [
        "orient 'nrm !palm(s) 'along vec(0, 0, 0)",
        "trill !palm(s) vec(0, 0, 0)",
        "rotate !head vec(0, 0, 0) 10",
        "look (rotated ^up vec(0, 0, 0) 10)",
        "place @I_TIP(s) (vtranslate ^Mssp (unit vec(0, 0, 0)))",
        "place @I_TIP(s) (moving (circle vec(0, 0, 0) .05) ^Mssp ^Mssp)",
        "lookat (vtranslate @NO (scale (unit vec(0, 0, 0)) 2))",
    ],
)
def test_all_that_needs_a_direction_is_looked_at(constraint: str) -> None:
    assert warned(f"key 1 ({constraint})") == [("zero-vector", 1)]


def test_turns_are_too_fast_for_frames_above_half_their_rate() -> None:
    assert list(beyond_frames(score(circling(15, 1)), 30.0)) == []
    (found,) = beyond_frames(score(circling(-16, 1)), 30.0)
    assert (found.code, found.severity) == ("beyond-frames", Severity.WARNING)
    assert "no 30 frames a second can show 16 turns a second" in found.message
    assert found.notes == ("written at text.azee:1:8",)
    assert len(list(beyond_frames(score(led_around(16, 1)), 30.0))) == 1
    assert list(beyond_frames(score(led_around(16, 1)), 60.0)) == []
