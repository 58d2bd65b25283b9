"""Places, directions and ways as AZee writes them."""

from __future__ import annotations

from azee.lexicon.hands import Hand
from azee.lexicon.numbers import number
from azee.lexicon.phrase import ArcWay, CircleWay, StraightWay, Way, ZigzagWay
from azee.lexicon.places import Place
from azee.lexicon.vectors import Vector, is_close, length

WITHIN_DEGREES = 24
WITHIN_M = 0.028
"""How far a hand in space may be from the middle of its place: notations have places that are
several times as far apart."""
NEAR_SKIN_M = 0.003
"""How far a hand that touches may be from a point between sites of the other hand, which is near
its skin, not on it."""
_NAMED: dict[Vector, str] = {
    (0, 1, 0): "^up",
    (0, -1, 0): "^down",
    (0, 0, 1): "^fwd",
    (0, 0, -1): "^back",
}
_LEAST_PART = 0.02
_LEAST_M = 0.0005


def orientation_text(hand: Hand, name: str) -> list[str]:
    """Return the constraints on where fingers point and the palm looks."""
    fingers, palm = hand.pointing, hand.facing
    if fingers is None:
        return []
    if palm is None:
        along = direction_text(fingers, name)
        return [f"orient 'dir !palm({name}) 'along {along} 'within {WITHIN_DEGREES}"]
    side = "" if name == "s" else f"'side = {name}, "
    pointing, facing = direction_text(fingers, name), direction_text(palm, name)
    return [f":#hand-faces({side}'fingers = {pointing}, 'palm = {facing})"]


def place_text(hand: Hand, name: str) -> list[str]:
    """Return the constraint on where a hand is."""
    if hand.site is None or hand.place is None:
        return []
    place = hand.place
    text = f"place {hand.site.text} {point_text(place, name)}"
    if place.gap:
        text += f" 'dist {number(place.gap)}"
    elif place.touches and place.is_on_skin:
        text += " 'contact"
    elif place.touches:
        text += f" 'contact 'within {number(NEAR_SKIN_M)}"
    elif place.is_space:
        text += f" 'within {number(WITHIN_M)}"
    return [text]


def point_text(place: Place, name: str) -> str:
    """Return a place as a point, seen from the hand that is there."""
    if place.is_space:
        return _call("in-space", _parts(place.offset, name, least=_LEAST_M, always=("fwd",)), name)
    sites = [site.text for site in place.sites]
    point = sites[0] if len(sites) == 1 else f"midpoint({', '.join(sites)})"
    parts = _parts(place.offset, name, least=_LEAST_M)
    if not parts:
        return point
    return _call("from", [f"'point = {point}", *parts], name)


def direction_text(vector: Vector, name: str) -> str:
    """Return a direction, seen from a hand."""
    for known, text in _NAMED.items():
        if is_close(vector, known):
            return text
    if is_close((abs(vector[0]), vector[1], vector[2]), (1, 0, 0)):
        outward = vector[0] < 0 if name == "s" else vector[0] > 0
        return f"{'out' if outward else 'in'}({name})"
    largest = max(abs(x) for x in vector)
    scaled = (vector[0] / largest, vector[1] / largest, vector[2] / largest)
    return _call("way", _parts(scaled, name, least=_LEAST_PART), name)


def way_text(way: Way, name: str) -> str:
    """Return a path."""
    match way:
        case StraightWay():
            return "straight"
        case ArcWay():
            return f"arc({vector_text(way.bulge, name)})"
        case CircleWay():
            axis = [
                f"'{word} = {number(x)}"
                for word, x in zip(("leftward", "up", "fwd"), way.axis, strict=True)
                if abs(x) > _LEAST_PART
            ]
            text = f"circle(:axis({', '.join(axis)}), {number(way.radius_m)}, {number(way.turns)}"
            text += f", 'phase, {way.phase}" if way.phase else ""
            return text + (f", 'ratio, {number(way.ratio)})" if way.ratio != 1 else ")")
        case ZigzagWay():
            return f"{'wave' if way.is_wave else 'zigzag'}({vector_text(way.side, name)}, 3)"


def vector_text(vector: Vector, name: str) -> str:
    """Return a way in metres, seen from a hand."""
    return _call("way", _parts(vector, name, least=_LEAST_M), name)


def _parts(vector: Vector, name: str, *, least: float, always: tuple[str, ...] = ()) -> list[str]:
    """Return the parts of a vector as arguments: out, up and forward."""
    outward = (-vector[0] if name == "s" else vector[0], vector[1], vector[2])
    if length(vector) <= least:
        return []
    return [
        f"'{word} = {number(x)}"
        for word, x in zip(("out", "up", "fwd"), outward, strict=True)
        if abs(x) > least or word in always
    ]


def _call(rule: str, arguments: list[str], name: str) -> str:
    side = [] if name == "s" else [f"'side = {name}"]
    if arguments and arguments[0].startswith("'point"):
        return f":{rule}({', '.join([arguments[0], *side, *arguments[1:]])})"
    return f":{rule}({', '.join([*side, *arguments])})"
