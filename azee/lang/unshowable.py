"""What no body, or no clip of a frame rate, can show of a score, as far as the text alone tells.

These are warnings: the score can be played, and the report measures how far the body comes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from functools import lru_cache

from azee.lang.known_vector import is_zero
from azee.score.score import Key, Score, leaves
from azee_grammar.diagnostic import Diagnostic, Severity
from azee_grammar.source import Span
from azee_grammar.vocabulary import MORPHS
from azee_solver.constraint import (
    Constraint,
    Look,
    LookAt,
    Morph,
    Orient,
    Place,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.geometry import Around, Circle, Moving, Rotated, Side, Slide, Unit, Vector
from azee_solver.notation import vector_text

Where = Callable[[Constraint], Span | None]

MOST_WEIGHT = 1.0
"""Of a facial morph, either way: 1 is the full movement, beyond it the skin would tear."""
MOST_TURN_RAD = 2.0 * math.pi
"""Of a bone from neutral; a rounding more is meant to be as much."""
MOST_HZ = 20.0
"""No part of a body goes to and fro or around so often in a second: orthostatic tremor, the
fastest oscillation known of people, has 13–18 Hz (Deuschl, Bain & Brin 1998)."""
_ROUNDING = 1.0 + 1e-9


def unshowable(score: Score, dominant: Side, where: Where) -> Iterator[Diagnostic]:
    """Yield `beyond-body` and `zero-vector` for what no body can show of a score."""
    for constraint, duration_s in _timed(score):
        for message, hint in (
            *_beyond_body(constraint, dominant),
            *_beyond_speed(constraint, duration_s),
        ):
            yield Diagnostic(
                "beyond-body", message, where(constraint), help=hint, severity=Severity.WARNING
            )
        for vector in _zero_vectors(constraint, dominant):
            yield Diagnostic(
                "zero-vector",
                f"`{vector_text(vector)}` has no direction: its length is 0",
                where(constraint),
                help="a direction is a vector of any other length",
                severity=Severity.WARNING,
            )


def beyond_frames(score: Score, fps: float) -> Iterator[Diagnostic]:
    """Yield `beyond-frames` for turns that frames cannot show, without a place in the text.

    A frame rate shows frequencies below half of it (Nyquist 1928, Shannon 1949). That of trills is
    in the report.
    """
    for constraint, duration_s in _timed(score):
        for turns_hz in _turn_rates(constraint, duration_s):
            if turns_hz > fps / 2:
                place = constraint.origin
                yield Diagnostic(
                    "beyond-frames",
                    f"no {fps:g} frames a second can show {turns_hz:g} turns a second",
                    None,
                    notes=(f"written at {place.file}:{place.line}:{place.column}",)
                    if place
                    else (),
                    help=f"{fps:g} frames show fewer than {fps / 2:g} turns",
                    severity=Severity.WARNING,
                )


def _timed(score: Score) -> Iterator[tuple[Constraint, float]]:
    """Yield all constraints, each with the duration of its block in seconds."""
    for leaf in leaves(score):
        if isinstance(leaf.score, Key):
            for constraint in leaf.score.constraints:
                yield constraint, float(leaf.interval.duration)


def _beyond_body(constraint: Constraint, dominant: Side) -> Iterator[tuple[str, str]]:
    """Yield what is said about a constraint that asks too much, with the remedy."""
    match constraint:
        case Morph() if abs(constraint.weight) > MOST_WEIGHT and _is_facial(constraint, dominant):
            most = f"{MOST_WEIGHT:g}"
            yield (
                f"no face shows `'{constraint.name}` with weight {constraint.weight:g}",
                f"weights are from −{most} to {most}; {most} is the full movement",
            )
        case Rotate() if abs(constraint.angle_rad) > MOST_TURN_RAD * _ROUNDING:
            yield (
                f"no bone turns by {math.degrees(constraint.angle_rad):g}°",
                "a turn is 360°; `trill` lets a bone go to and fro, `circle` leads a site around",
            )
        case Trill():
            widest = max(constraint.amplitude_rad, constraint.other_rad, key=abs)
            if abs(widest) > MOST_TURN_RAD / 2 * _ROUNDING:
                yield (
                    f"no bone goes {math.degrees(widest):g}° to either side",
                    "`'amp` is the angle to one side, 12° unless said",
                )
            if constraint.cycles is None and constraint.frequency_hz > MOST_HZ:
                yield (
                    f"no body shows {constraint.frequency_hz:g} oscillations a second",
                    f"people reach fewer than {MOST_HZ:g}; `'freq` is 5 unless said",
                )
        case Place() | Orient() | Look() | LookAt() | Morph() | Rotate() | Transpath():
            pass


def _beyond_speed(constraint: Constraint, duration_s: float) -> Iterator[tuple[str, str]]:
    """Yield what is said about circles and counted trills that are too fast, with the remedy."""
    if isinstance(constraint, Trill) and constraint.cycles is not None and duration_s > 0.0:
        hz = constraint.hz(duration_s)
        if hz > MOST_HZ:
            yield (
                f"no body shows {hz:g} oscillations a second",
                f"people reach fewer than {MOST_HZ:g}: ask for fewer, or give the block more time",
            )
    for turns_hz in _turn_rates(constraint, duration_s):
        if turns_hz > MOST_HZ:
            yield (
                f"no body shows {turns_hz:g} turns a second",
                f"people reach fewer than {MOST_HZ:g}: ask for fewer, or give the block more time",
            )


def _is_facial(morph: Morph, dominant: Side) -> bool:
    entry = MORPHS.get(morph.key(dominant))
    return entry is not None and "facial" in entry.kind


def _turn_rates(constraint: Constraint, duration_s: float) -> Iterator[float]:
    """Yield the turns a second of every circle that a constraint moves on; none lasts no time."""
    if duration_s > 0.0:
        for turns in _turns(constraint):
            yield abs(turns) / duration_s


@lru_cache(maxsize=4096)
def _turns(constraint: Constraint) -> tuple[float, ...]:
    """Return the turns of every circle that a constraint moves on."""
    whole = (constraint.path,) if isinstance(constraint, Transpath) else ()
    inner = (node.path for node in _nodes(constraint) if isinstance(node, Moving))
    named = [path.path if isinstance(path, Slide) else path for path in (*whole, *inner)]
    return tuple(path.turns for path in named if isinstance(path, Circle | Around))


@lru_cache(maxsize=4096)
def _zero_vectors(constraint: Constraint, dominant: Side) -> tuple[Vector, ...]:
    """Return the vectors without length where a constraint needs a direction, outermost first."""
    return tuple(v for v in _directions(constraint) if is_zero(v, dominant))


def _directions(constraint: Constraint) -> Iterator[Vector]:
    """Yield the vectors of a constraint that must have a direction, outermost first."""
    match constraint:
        case Orient(vector=vector) | Look(vector=vector):
            yield vector
        case Trill(axis=axis) | Rotate(axis=axis):
            yield axis
        case Place() | LookAt() | Morph() | Transpath():
            pass
    for node in _nodes(constraint):
        if isinstance(node, Unit):
            yield node.vector
        elif isinstance(node, Rotated | Circle | Around):
            yield node.axis


def _nodes(node: object) -> Iterator[object]:
    """Yield the parts of a constraint, outermost first."""
    if isinstance(node, tuple):
        for item in node:
            yield from _nodes(item)
    elif is_dataclass(node):
        yield node
        for part in fields(node):
            yield from _nodes(getattr(node, part.name))
