"""What a sign is made of, as one searches for it: hands, handshapes, places, movements."""

from __future__ import annotations

from collections.abc import Iterator

from azee.lexicon.model import (
    Circle,
    Constellation,
    EachAt,
    FingerPlay,
    ForEach,
    InTurn,
    Location,
    Manual,
    Movement,
    OnBody,
    OnHand,
    Posture,
    Repeat,
    Sign,
    Still,
    Straight,
    Target,
    Together,
    Wrist,
)

KINDS = ("hands", "handshape", "place", "movement", "face")
"""What can be searched for."""


def features_of(sign: Sign) -> dict[str, tuple[str, ...]]:
    """Return the values of each kind, sorted, without kinds that have none."""
    found: dict[str, set[str]] = {kind: set() for kind in KINDS}
    for manual in sign.manuals:
        found["hands"].add(_hands(manual))
        for posture in postures(manual):
            found["handshape"].update(_shapes(posture))
            if posture.location is not None:
                found["place"].update(_places(posture.location))
        for move in manual.moves:
            found["movement"].update(_movements(move))
    if sign.nonmanual.mouthing:
        found["face"].add("mouthing")
    found["face"].update(tier.name for tier in sign.nonmanual.tiers)
    return {kind: tuple(sorted(values)) for kind, values in found.items() if values}


def postures(manual: Manual) -> Iterator[Posture]:
    """Yield all postures of a part of a sign, the initial one first."""
    yield manual.posture
    for move in manual.moves:
        yield from _targets(move)


def _targets(move: Movement) -> Iterator[Posture]:
    if isinstance(move, Target):
        yield move.posture
    for inner in _parts(move):
        yield from _targets(inner)


def _parts(move: Movement) -> tuple[Movement, ...]:
    match move:
        case Target() | Together() | InTurn():
            return move.moves
        case ForEach():
            return move.strong, move.weak
        case Repeat():
            return (move.move,)
        case Straight() | Circle() | Wrist() | FingerPlay() | Still():
            return ()


def _hands(manual: Manual) -> str:
    symmetry = manual.symmetry
    if symmetry is None:
        two = any(
            p.weak is not None or isinstance(p.location, EachAt | Constellation)
            for p in postures(manual)
        )
        return "two" if two else "weak" if manual.weak_alone else "one"
    if symmetry.out_of_phase:
        return "alternating"
    return "mirrored" if symmetry.left_right else "parallel"


def _shapes(posture: Posture) -> Iterator[str]:
    for config in (posture.both, posture.strong, posture.weak):
        if config is not None and config.shape is not None:
            yield config.shape.form.base


def _places(location: Location) -> Iterator[str]:
    match location:
        case OnBody():
            yield from (place for place in (location.at, location.second) if place)
        case OnHand():
            yield location.at.part or "hand"
        case EachAt():
            for each in (location.strong, location.weak):
                if each is not None:
                    yield from _places(each)
        case Constellation():
            yield "hands"
            if location.place is not None:
                yield from _places(location.place)


def _movements(move: Movement) -> Iterator[str]:
    match move:
        case Straight():
            yield "arc" if move.curve else "straight"
        case Circle():
            yield "circle"
        case Wrist():
            yield move.kind
        case FingerPlay():
            yield "fingerplay"
        case Repeat():
            yield "repeated"
        case Target():
            if move.posture.both.shape or move.posture.strong or move.posture.weak:
                yield "change"
        case Still() | Together() | InTurn() | ForEach():
            pass
    for inner in _parts(move):
        yield from _movements(inner)
