"""Performs notated movements: from hands at the start to timed moments and ways.

A movement ends in the state that the next one starts from. Times follow the configuration of the
engine of JASigning (sizes.py); its manner of repeating was measured.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from azee.lexicon.clearance import circle_before_body, cleared
from azee.lexicon.codes import bulge, direction
from azee.lexicon.hand_text import Told
from azee.lexicon.hands import NO_FLIP, Hand, Hands, changed, flip_of, flipped, flipped_axis
from azee.lexicon.model import (
    Circle,
    Constellation,
    FingerPlay,
    ForEach,
    InTurn,
    Location,
    Movement,
    OnBody,
    Repeat,
    Still,
    Straight,
    Symmetry,
    Target,
    Together,
    Wrist,
)
from azee.lexicon.phrase import (
    ArcWay,
    CircleWay,
    Moment,
    Move,
    Phrase,
    StraightWay,
    Way,
    ZigzagWay,
    joined,
)
from azee.lexicon.phrase import together as stretched_together
from azee.lexicon.places import Place, other
from azee.lexicon.posing import Posing
from azee.lexicon.sizes import (
    BACK,
    BULGE,
    RADIUS_M,
    SHIFT_M,
    STEP_S,
    STRAIGHT_M,
    TURN_S,
    ZIGZAG_M,
    slowness,
)
from azee.lexicon.tremors import finger_play, wrist_tremor
from azee.lexicon.vectors import ZERO, Vector, is_close, plus, times

MOST_STEPS = 400
"""The most single movements of a sign; more are a notation that repeats repetitions."""
TIMES = {
    "fromstart": 2,
    "fromstart_several": 3,
    "continue": 2,
    "continue_several": 3,
    "reverse": 1,
    "tofroto": 2,
    "manyrandom": 3,
    "swap": 1,
}
"""How often a repetition is done."""
_HOURS = {"u": 0, "ur": 45, "r": 90, "dr": 135, "d": 180, "dl": 225, "l": 270, "ul": 315}
"""Degrees on a clock face."""
_RATIOS = {None: 1.0, "h": 0.5, "v": 2.0, "u": 2.0, "l": 0.5, "r": 0.5, "d": 2.0}
"""The height of ellipses over their width, by how they lie."""
_AGAIN = 0.85
"""How long the second time takes, compared with the first."""

Sides = tuple[str, ...]


class TooLongError(Exception):
    """A sign with more movements than any has."""


@dataclass
class Mover:
    """Performs the movements of one part of a sign.

    What is notated for both hands, the weak hand does as the symmetry tells. What is notated for
    each hand is as it stands, so movements of each are performed without symmetry.
    """

    symmetry: Symmetry | None
    told: Told
    steps: list[Movement] = field(default_factory=list)
    """The movements performed so far."""
    where: Location | None = None
    """Where the notation last said that the hands are."""

    def perform(
        self, move: Movement, hands: Hands, sides: Sides, slow: float = 1.0
    ) -> tuple[Phrase, Hands]:
        """Return the movement in time, and the hands at its end.

        Raises: TooLongError.
        """
        self.steps.append(move)
        if len(self.steps) > MOST_STEPS:
            raise TooLongError
        match move:
            case Straight():
                return self._straight(move, hands, sides, slow * slowness(move.manner))
            case Circle():
                return self._circle(move, hands, sides, slow * slowness(move.manner))
            case Wrist():
                tremors = wrist_tremor(move, sides, slow * slowness(move.manner), self._alternates)
                return Phrase(max(t.end_s for t in tremors), tremors=tremors), hands
            case FingerPlay():
                tremors = finger_play(move, sides, slow * slowness(move.manner))
                return Phrase(max(t.end_s for t in tremors), tremors=tremors), hands
            case Still():
                return Phrase(), hands
            case Target():
                return self._target(move, hands, sides, slow * slowness(move.manner))
            case Together():
                pairs = [(part, sides) for part in move.moves]
                return self._together(pairs, hands, slow * slowness(move.manner))
            case ForEach():
                pairs = [(move.strong, ("s",)), (move.weak, ("w",))]
                each = Mover(None, self.told, self.steps)
                return each._together(pairs, hands, slow * slowness(move.manner))
            case InTurn():
                if move.fused:
                    self.told("fused", "movements that run into each other are one after the other")
                return self.in_turn(move.moves, hands, sides, slow * slowness(move.manner))
            case Repeat():
                return self._repeat(move, hands, sides, slow * slowness(move.manner))

    @property
    def _alternates(self) -> bool:
        return self.symmetry is not None and self.symmetry.out_of_phase

    # Parts --------------------------------------------------------------------------------------

    def in_turn(
        self, moves: Sequence[Movement], hands: Hands, sides: Sides, slow: float = 1.0
    ) -> tuple[Phrase, Hands]:
        """Perform movements one after the other, with a moment between them."""
        parts, time_s = [], 0.0
        for i, move in enumerate(moves):
            before = hands
            phrase, hands = self.perform(move, hands, sides, slow)
            hands = self._outside_body(before, hands, sides)
            parts.append(phrase.at(time_s))
            time_s += phrase.duration_s
            if i < len(moves) - 1:
                parts.append(_moments(time_s, hands, sides))
        return joined(time_s, parts), hands

    def _outside_body(self, before: Hands, hands: Hands, sides: Sides) -> Hands:
        """Return hands of which none ends in the body."""
        outside = changed(hands, lambda name, hand: cleared(hand, before[name]), *sides)
        if outside != hands:
            self.told("into-the-body", "a movement that would end in the body ends before it")
        return outside

    def _together(
        self, pairs: Sequence[tuple[Movement, Sides]], hands: Hands, slow: float
    ) -> tuple[Phrase, Hands]:
        phrases = []
        for move, sides in pairs:
            phrase, hands = self.perform(move, hands, sides, slow)
            phrases.append(phrase)
        return stretched_together(phrases), hands

    def _target(
        self, move: Target, hands: Hands, sides: Sides, slow: float
    ) -> tuple[Phrase, Hands]:
        """Perform movements that end in a posture; where it has a place, they only shape the way.

        (Measured on the engine, and D: the public DTD.) Where two hands that do the same end beside
        each other at no place that is said, they go there together.
        """
        before = hands
        phrase, hands = self._together([(part, sides) for part in move.moves], hands, slow)
        location = self._meant(move.posture.location)
        if location is not None:
            self.where = location
            meeting = _meeting(before, hands) if self._meet(location) else None
            hands = {
                name: replace(hand, place=before[name].place, site=before[name].site)
                for name, hand in hands.items()
            }
            if meeting is not None:
                hands = {**hands, "w": replace(hands["w"], place=meeting)}
        posture = replace(move.posture, location=location)
        hands = Posing(self.symmetry, self.told).pose(posture, hands, sides)
        length_s = max(phrase.duration_s, STEP_S * slow)
        parts = [phrase]
        if location is not None:
            moving = {m.name for m in phrase.moves}
            went = [n for n in ("s", "w") if hands[n].place != before[n].place and n not in moving]
            parts.append(Phrase(moves=[Move(0, length_s, n, StraightWay()) for n in went]))
        return joined(length_s, parts), hands

    def _meant(self, location: Location | None) -> Location | None:
        """Return a location of which only the contact is said: that of the last one, with it."""
        if not isinstance(location, Constellation):
            return location
        if location != Constellation(contact=location.contact):
            return location
        if isinstance(self.where, OnBody):
            return replace(self.where, contact=location.contact)
        if isinstance(self.where, Constellation):
            return replace(self.where, contact=location.contact, place=None)
        return location

    def _meet(self, location: Location) -> bool:
        """Whether two hands that do the same end beside each other, and it is not said where."""
        return (
            self.symmetry is not None
            and isinstance(location, Constellation)
            and location.place is None
        )

    # Movements ----------------------------------------------------------------------------------

    def _straight(
        self, move: Straight, hands: Hands, sides: Sides, slow: float
    ) -> tuple[Phrase, Hands]:
        heading = direction(move.heading)
        size_m = STRAIGHT_M[move.size]
        length_s = STEP_S * slow * (1.1 if move.curve else 1)
        if move.brushed:
            self.told("brushing", "what is touched on the way is not")
        ways: dict[str, tuple[Vector, Way]] = {}
        for name in sides:
            flip = self._flip(name)
            way: Way = StraightWay()
            if move.curve:
                size = BULGE[move.curve_size] * size_m
                way = ArcWay(flipped(times(bulge(heading, move.curve), size), flip))
            elif move.zigzag:
                side = times(bulge(heading, "l" if heading[1] else "u"), ZIGZAG_M)
                way = ZigzagWay(flipped(side, flip), is_wave=move.zigzag == "wavy")
            ways[name] = flipped(times(heading, size_m), flip), way
        hands = _moved(hands, {name: vector for name, (vector, _) in ways.items()})
        moves = [Move(0, length_s, name, way, hands[name].site) for name, (_, way) in ways.items()]
        return Phrase(length_s, moves=moves), hands

    def _circle(
        self, move: Circle, hands: Hands, sides: Sides, slow: float
    ) -> tuple[Phrase, Hands]:
        axis = direction(move.axis)
        phase, turns = self._clock(move)
        ratio = _RATIOS.get(move.ellipse, 0.0)
        if not ratio:
            self.told("ellipse", "an ellipse that lies aslant is a circle")
        length_s = TURN_S * slow * turns
        moves = []
        for name in sides:
            half = 180 if name == "w" and self._alternates else 0
            way = CircleWay(
                flipped_axis(axis, self._flip(name)),
                RADIUS_M[move.size],
                turns,
                (phase + half) % 360,
                ratio or 1.0,
            )
            if not self._alternates:
                way = self._before_body(way, hands[name], told=bool(move.start or move.end))
            moves.append(Move(0, length_s, name, way, hands[name].site))
        return Phrase(length_s, moves=moves), hands

    def _before_body(self, way: CircleWay, hand: Hand, *, told: bool) -> CircleWay:
        """Return a circle outside the body. told: whether it is said where it starts or ends."""
        outside = circle_before_body(way, hand, is_start_told=told)
        if outside != way:
            done = "is smaller" if told else "starts where it is nearest to it"
            self.told("circle-into-the-body", f"a circle that would lead into the body {done}")
        return outside

    def _clock(self, move: Circle) -> tuple[int, float]:
        """Return where a circle starts, in degrees from its top, and how many turns it makes.

        A circle about an axis that points inward is drawn, and so read, as a clock that runs
        backward; all others as one that runs forward.
        """
        sense = -1 if "i" in move.axis.first else 1
        start = sense * _HOURS.get(move.start or "u", 0)
        if move.end is None:
            return start % 360, float(move.turns)
        part = (sense * _HOURS.get(move.end, 0) - start) % 360
        return start % 360, move.turns - 1 + (part or 360) / 360

    def _flip(self, name: str) -> Vector:
        return flip_of(self.symmetry) if name == "w" else NO_FLIP

    # Repetition ---------------------------------------------------------------------------------

    def _repeat(
        self, move: Repeat, hands: Hands, sides: Sides, slow: float
    ) -> tuple[Phrase, Hands]:
        count = TIMES[move.kind]
        if move.again:
            self.told("repeated-again", "a repetition that is repeated is done once")
        onward = times(direction(move.shift), SHIFT_M) if move.shift else ZERO
        if isinstance(move.move, Circle) and move.move.end is None:
            turns = move.move.turns * max(count, 2 if move.kind == "reverse" else 1)
            return self.perform(replace(move.move, turns=turns), hands, sides, slow)
        start = hands
        parts: list[Phrase] = []
        time_s = 0.0
        for i in range(count):
            before = hands
            phrase, hands = self.perform(move.move, hands, sides, slow * (_AGAIN if i else 1))
            hands = self._outside_body(before, hands, sides)
            parts.append(phrase.at(time_s))
            time_s += phrase.duration_s
            last = i == count - 1
            if last and move.kind != "reverse":
                break
            parts.append(_moments(time_s, hands, sides))
            if move.kind.startswith("continue") or not _differs(start, hands):
                continue
            back_s = STEP_S * slow * (1 if move.kind in ("reverse", "tofroto") else BACK)
            ways = [
                Move(time_s, time_s + back_s, name, StraightWay(), hands[name].site)
                for name in sides
            ]
            parts.append(Phrase(moves=ways))
            if move.shift:
                ways_on = {name: flipped(onward, self._flip(name)) for name in sides}
                start = _moved(start, ways_on)
            hands = start
            time_s += back_s
            if not last:
                parts.append(_moments(time_s, hands, sides))
        return joined(time_s, parts), hands


def _meeting(before: Hands, after: Hands) -> Place | None:
    """Return where two hands meet that went the same way or towards each other.

    Halfway between where they were before, farther on by the way that they have in common. None
    where only one of them moved, or nothing in space tells where halfway is.
    """
    strong, weak = before["s"].place, before["w"].place
    if strong is None or weak is None:
        return None
    ways = {name: _way(before[name].place, after[name].place) for name in ("s", "w")}
    if strong.is_at_hand and after["s"].place == strong:
        ways["s"] = ways["w"]  # it is carried
    if (ways["s"] is None) != (ways["w"] is None):
        return None
    if not strong.is_at_hand:
        if not (strong.is_space and weak.is_space):
            return None
        weak = Place(offset=times(plus(strong.offset, weak.offset), 0.5))
    way = times(plus(ways["s"] or ZERO, ways["w"] or ZERO), 0.5)
    return weak if is_close(way, ZERO) else Place(weak.sites, plus(weak.offset, way))


def _way(start: Place | None, end: Place | None) -> Vector | None:
    """Return how far a hand moved from one place to another; None if it did not."""
    return None if start is None or end is None else end.way_from(start)


def _moments(time_s: float, hands: Hands, sides: Sides) -> Phrase:
    return Phrase(moments=[Moment(time_s, name, hands[name]) for name in sides])


def _differs(start: Hands, hands: Hands) -> bool:
    return any(start[name] != hands[name] for name in start)


def _moved(hands: Hands, ways: dict[str, Vector]) -> Hands:
    """Return hands that went some way. Hands that touch and go the same way stay together."""
    out = dict(hands)
    for name, way in ways.items():
        hand = hands[name]
        if hand.place is None:
            continue
        if not hand.place.is_at_hand:
            out[name] = replace(hand, place=hand.place.moved(way))
            continue
        base = hands[other(name)]
        base_way = ways.get(other(name))
        if base_way is None:
            out[name] = replace(hand, place=hand.place.moved(way))
        elif not is_close(base_way, way) and base.place is not None:
            apart = replace(base.place.moved(way), origin=hand.place)
            out[name] = replace(hand, place=apart)
    return out
