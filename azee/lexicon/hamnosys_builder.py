"""Turns the tree of a notation in HamNoSys into a sign."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from lark import Token, Transformer

from azee.lexicon.hamnosys_symbols import NAMES
from azee.lexicon.model import (
    Circle,
    Constellation,
    EachAt,
    FingerPlay,
    ForEach,
    Form,
    HandConfig,
    HandPart,
    HandShape,
    Heading,
    InTurn,
    Location,
    Manner,
    Manual,
    Movement,
    OnBody,
    OnHand,
    Posture,
    Repeat,
    Still,
    Straight,
    Symmetry,
    Target,
    Together,
    Wrist,
)

_BASES = {"flathand": "flat", "ceeopen": "cee12open"}
_THUMBS = {"thumboutmod": "out", "thumbacrossmod": "across", "thumbopenmod": "opposed"}
_BENDS = {
    "fingerstraightmod": "bent",
    "fingerbendmod": "round",
    "fingerhookmod": "hooked",
    "doublebent": "dblbent",
    "doublehooked": "dblhooked",
}
_DIGITS = {
    "thumb": "1",
    "indexfinger": "2",
    "middlefinger": "3",
    "ringfinger": "4",
    "pinky": "5",
}
_SIZES = {"smallmod": "small", "largemod": "big"}
_CONTACTS = {"close": "close", "touch": "touch", "armextended": "armextended"}
_REPEATS = {
    "repeatfromstart": "fromstart",
    "repeatfromstartseveral": "fromstart_several",
    "repeatcontinue": "continue",
    "repeatcontinueseveral": "continue_several",
    "repeatreverse": "reverse",
}
_WRIST_SIDES = {
    "wristtopulse": "palmar",
    "wristtoback": "dorsal",
    "wristtothumb": "radial",
    "wristtopinky": "ulnar",
}


def _name(token: Token) -> str:
    return NAMES[str(token)]


def _of(children: list[Any], kind: str) -> list[str]:
    """Return the names of the tokens of a kind."""
    return [_name(c) for c in children if isinstance(c, Token) and c.type == kind]


def _heading(tokens: list[Any], kind: str, prefix: str) -> Heading:
    codes = [name.removeprefix(prefix) for name in _of(tokens, kind)]
    second = codes[1] if len(codes) > 1 and codes[1] != codes[0] else None
    return Heading(codes[0], second)


class Builder(Transformer[Token, Any]):
    """Builds from the leaves; a rule of the grammar is a method of its name."""

    def start(self, parts: list[Any]) -> Manual:
        """Return the whole notation."""
        prefix = next((p for p in parts if isinstance(p, Symmetry | str)), None)
        posture = next((p for p in parts if isinstance(p, Posture)), Posture())
        known = (Symmetry, str, Posture)
        moves = tuple(p for p in parts if not isinstance(p, known))
        symmetry = prefix if isinstance(prefix, Symmetry) else None
        return Manual(posture, moves, symmetry, weak_alone=prefix == "nondominant")

    def symmetry(self, parts: list[Any]) -> Symmetry:
        """Two hands that do the same; sizes and bends behind the symbol are further mirrors."""
        return Symmetry(
            left_right=_of(parts, "SYMMETRY") == ["symmlr"],
            up_down=bool(_of(parts, "SIZE")),
            out_in=bool(_of(parts, "BEND")),
            out_of_phase=bool(_of(parts, "ALTERNATING")),
        )

    def nondominant(self, _: list[Any]) -> str:
        """Return the weak hand alone."""
        return "nondominant"

    def posture(self, parts: list[Any]) -> Posture:
        """Hands and their place."""
        location = parts[1] if len(parts) > 1 else None
        if isinstance(parts[0], tuple):
            strong, weak = parts[0]
            return Posture(strong=strong, weak=weak, location=location)
        return Posture(parts[0], location=location)

    # Hands --------------------------------------------------------------------------------------

    def split_hands(self, parts: list[Any]) -> tuple[HandConfig, HandConfig]:
        """Return a strong and a weak hand."""
        strong, weak = (p for p in parts if isinstance(p, HandConfig))
        return strong, weak

    def hand(self, parts: list[Any]) -> HandConfig:
        """Shape, fingers, palm."""
        config = HandConfig()
        for part in parts:
            if isinstance(part, HandShape):
                config = replace(config, shape=part)
            else:
                name, heading = part
                config = replace(config, **{name: heading})
        return config

    def shape(self, parts: list[Any]) -> HandShape:
        """Return a form or one between two."""
        shapes = [p for p in parts if isinstance(p, HandShape)]
        first = shapes[0]
        if len(shapes) > 1 and shapes[1].form != first.form:
            return replace(first, second=shapes[1].form)
        return first

    def form(self, parts: list[Any]) -> HandShape:
        """Return a base with modifiers and digits."""
        base = _name(parts[0])
        thumbs = [_THUMBS[name] for name in _of(parts, "THUMB")]
        bends = [_BENDS[name] for name in _of(parts, "BEND")]
        digits = [p for p in parts if isinstance(p, tuple)]
        return HandShape(
            Form(
                _BASES.get(base, base), bends[0] if bends else None, thumbs[0] if thumbs else None
            ),
            fingers="".join(digit for digit, bend in digits if bend is None),
            bends=tuple((digit, bend) for digit, bend in digits if bend is not None),
        )

    def digit_bend(self, parts: list[Any]) -> tuple[str, str | None]:
        """Return a digit that counts, or one with a bend of its own."""
        return _DIGITS[_name(parts[0])], _BENDS[_name(parts[1])] if len(parts) > 1 else None

    def fingers(self, parts: list[Any]) -> tuple[str, Heading]:
        """Where the fingers point."""
        return "fingers", _heading(parts, "EXTFINGER", "extfinger")

    def palm(self, parts: list[Any]) -> tuple[str, Heading]:
        """How the hand is turned about its fingers."""
        return "palm", _heading(parts, "PALM", "palm")

    # Places -------------------------------------------------------------------------------------

    def own(self, parts: list[Any]) -> tuple[str, HandPart]:
        """Return the part of the hand that is at a place of the body."""
        return "own", parts[0]

    def body(self, parts: list[Any]) -> OnBody:
        """Return a place at the body, or between two."""
        places = [p for p in parts if isinstance(p, OnBody)]
        first, second = places[0], places[1] if len(places) > 1 else None
        if second is not None:
            first = replace(first, second=second.at, second_side=second.side)
            if first.second == first.at and first.second_side == first.side:
                first = replace(first, second=None, second_side=None)
        own = next((p[1] for p in parts if isinstance(p, tuple)), None)
        return replace(first, contact=_contact(parts), own=own, behind=bool(_of(parts, "BEHIND")))

    each_body = body
    constellation_place = body

    def place(self, parts: list[Any]) -> OnBody:
        """Return a part of the body; a mark before it is left, one behind it right."""
        at = next(i for i, token in enumerate(parts) if token.type == "BODY")
        side = None
        if len(parts) > 1:
            mark = _name(parts[1 - at] if len(parts) == 2 else parts[0])
            side = f"{'right' if at == 0 else 'left'}_{mark.removeprefix('lr')}"
        name = _name(parts[at])
        return OnBody(None if name == "neutralspace" else name, side)

    def hand_place(self, parts: list[Any]) -> OnHand:
        """Return a part of the other hand, or between two."""
        found = [p for p in parts if isinstance(p, HandPart)]
        return OnHand(found[0], found[1] if len(found) > 1 else None, _contact(parts))

    def split_place(self, parts: list[Any]) -> EachAt:
        """Return a place for each hand."""
        strong, weak = (p for p in parts if isinstance(p, OnBody | OnHand))
        return EachAt(strong, weak)

    def constellation(self, parts: list[Any]) -> Constellation:
        """Two hands beside each other."""
        hands = [p for p in parts if isinstance(p, HandPart)]
        place = next((p for p in parts if isinstance(p, OnBody)), None)
        weak, strong = (OnHand(hands[0]), OnHand(hands[1])) if hands else (None, None)
        return Constellation(weak, strong, place, _contact(parts))

    def digit_part(self, parts: list[Any]) -> HandPart:
        """Return a part of a finger."""
        digits = "".join(_DIGITS[name] for name in _of(parts, "DIGIT"))
        found = [name.removeprefix("finger") for name in _of(parts, "FINGERPART")]
        side = next((_WRIST_SIDES[name] for name in _of(parts, "PARTSIDE")), None)
        if marks := _of(parts, "LEFTRIGHT"):
            first = isinstance(parts[0], Token) and parts[0].type == "LEFTRIGHT"
            side = f"{'left' if first else 'right'}_{marks[0].removeprefix('lr')}"
        return HandPart(digits, found[0] if found else None, side)

    def hand_part(self, parts: list[Any]) -> HandPart:
        """Return a part of a hand or an arm."""
        name = _name(parts[0])
        side = next((_WRIST_SIDES[n] for n in _of(parts, "PARTSIDE")), None)
        if name == "wristpulse":
            return HandPart("", "wristback", "palmar")
        return HandPart("", name, side)

    # Movements ----------------------------------------------------------------------------------

    def action(self, parts: list[Any]) -> Movement:
        """Return a movement with its manner, perhaps repeated."""
        move: Movement = parts[0]
        names = _of(parts, "SPEED")
        if names and not isinstance(move, Still):
            manner = Manner(*(word in names for word in ("fast", "slow", "tense", "rest", "halt")))
            move = replace(move, manner=manner)
        for kind, alternates in (p for p in parts[1:] if isinstance(p, tuple)):
            move = Repeat(move, kind, alternating=alternates)
        return move

    def repetition(self, parts: list[Any]) -> tuple[str, bool]:
        """How a movement is repeated."""
        return _REPEATS[_name(parts[0])], len(parts) > 1

    def straight(self, parts: list[Any]) -> Movement:
        """Return a movement in a direction; a size behind an arc is that of the arc."""
        codes = _of(parts, "MOVE")
        if codes[0] in ("movecross", "movex"):
            return Still()
        arcs = [i for i, p in enumerate(parts) if p.type == "ARC"]
        cut = arcs[0] if arcs else len(parts)
        size = [_SIZES[n] for n in _of(parts[:cut], "SIZE") if n in _SIZES]
        bent = [_SIZES[n] for n in _of(parts[cut:], "SIZE") if n in _SIZES]
        wavy = _of(parts, "WAVY")
        return Straight(
            _heading(parts, "MOVE", "move"),
            size[0] if size else None,
            _name(parts[cut]).removeprefix("arc") if arcs else None,
            bent[0] if bent else None,
            wavy[0] if wavy else None,
        )

    def circle(self, parts: list[Any]) -> Circle:
        """Return a circle about an axis."""
        size = [_SIZES[n] for n in _of(parts, "SIZE") if n in _SIZES]
        hours = [name.removeprefix("clock") for name in _of(parts, "CLOCK")]
        marked = [hour for hour in hours if hour != "full"]
        ellipse = _of(parts, "ELLIPSE")
        return Circle(
            _heading(parts, "CIRCLE", "circle"),
            size[0] if size else None,
            1 + hours.count("full"),
            marked[0] if marked else None,
            marked[1] if len(marked) > 1 else None,
            ellipse[0].removeprefix("ellipse") if ellipse else None,
        )

    def wrist(self, parts: list[Any]) -> Wrist:
        """Return a movement of the wrist."""
        size = [_SIZES[n] for n in _of(parts, "SIZE") if n in _SIZES]
        return Wrist(_name(parts[0]), size[0] if size else None)

    def fingerplay(self, parts: list[Any]) -> FingerPlay:
        """Fingers that move one after the other."""
        return FingerPlay("".join(_DIGITS[name] for name in _of(parts, "DIGIT")))

    def still(self, _: list[Any]) -> Still:
        """No movement."""
        return Still()

    def target(self, parts: list[Any]) -> Target:
        """Return a movement that ends in a posture."""
        moves = tuple(p for p in parts if isinstance(p, Straight | Still)) or (Still(),)
        location: Location | None = next(
            (p for p in parts if isinstance(p, OnBody | OnHand | EachAt | Constellation)), None
        )
        for part in parts:
            if isinstance(part, tuple):
                return Target(moves, Posture(strong=part[0], weak=part[1], location=location))
            if isinstance(part, HandConfig):
                return Target(moves, Posture(part, location=location))
        return Target(moves, Posture(location=location))

    def together(self, parts: list[Any]) -> Together:
        """Movements at the same time."""
        return Together(tuple(p for p in parts if not isinstance(p, Token)))

    def in_turn(self, parts: list[Any]) -> InTurn:
        """Movements one after the other."""
        moves = tuple(p for p in parts if not isinstance(p, Token))
        return InTurn(moves, fused=bool(_of(parts, "FUSIONBEGIN")))

    def for_each(self, parts: list[Any]) -> ForEach:
        """Return a movement of each hand."""
        cut = next(i for i, p in enumerate(parts) if isinstance(p, Token) and p.type == "PLUS")
        strong = [p for p in parts[:cut] if not isinstance(p, Token)]
        weak = [p for p in parts[cut:] if not isinstance(p, Token)]
        return ForEach(_one(strong), _one(weak))


def _one(moves: list[Movement]) -> Movement:
    return moves[0] if len(moves) == 1 else InTurn(tuple(moves))


def _contact(parts: list[Any]) -> str | None:
    found = [_CONTACTS.get(name, "touch") for name in _of(parts, "CONTACT")]
    return found[0] if found else None
