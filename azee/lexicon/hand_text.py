"""A notated handshape as posture rules of the core."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from azee.lexicon.hand_sites import FINGER
from azee.lexicon.model import BENDS, Form, HandShape, bend_of
from azee.lexicon.numbers import number

_BETWEEN_THUMBS = {
    frozenset(("beside", "out")): ".thumb('spread = .45)",
    frozenset(("beside", "across")): ".thumb('opposed = .35, 'bend = .2)",
    frozenset(("beside", "opposed")): ".thumb('opposed = .4, 'spread = .2)",
    frozenset(("out", "across")): ".thumb('opposed = .3, 'spread = .3, 'bend = .15)",
    frozenset(("out", "opposed")): ".thumb('opposed = .4, 'spread = .6)",
    frozenset(("across", "opposed")): ".thumb('opposed = .8, 'spread = .15, 'bend = .2)",
}
"""Thumbs halfway between two positions; the weights are ours."""

Told = Callable[[str, str], None]
"""Notes an approximation: its kind, and what it is."""

_FINGERS = {
    "fist": "",
    "flat": "2345",
    "finger2": "2",
    "finger23": "23",
    "finger23spread": "23",
    "finger2345": "2345",
    "pinch12": "2",
    "pinchall": "2345",
    "pinch12open": "2",
    "cee12": "2",
    "ceeall": "2345",
    "cee12open": "2",
}
"""The fingers that a form is about."""
_NAMES = dict(zip("2345", ("index", "middle", "ring", "little"), strict=True))
YIELD_DEGREES = 20
"""How far joints of a hand that touches something may yield: half of what a straight finger and a
round one differ by."""
_CLOSED = (0.955, 0.95)
_PINCHED = {"pinch12": (0.68, 0.62), "pinch12open": (0.68, 0.62), "pinchall": (0.92, 0.48)}
_BEND_RULES = {bend_of(name): f":finger-{name}" for name in BENDS if name != "halfbent"}
_THUMBS: Mapping[str | None, Mapping[str, str]] = {
    "out": {},
    "opposed": {},
    "across": {
        "fist": ".thumb-over-index",
        "finger2": ".thumb-rests",
        "finger23": ".thumb-over-ring",
        "finger23spread": ".thumb-over-ring",
    },
    None: {
        "flat": ".thumb-beside",
        "finger2345": ".thumb-across",
        "finger2": ".thumb-rests",
        "fist": ".thumb-on-index",
    },
}
_USUAL_THUMB = {
    "out": ".thumb-out",
    "opposed": ".thumb-opposed",
    "across": ".thumb-across",
    None: ".thumb-over-ring",
}


def hand_text(shape: HandShape, hand: str, told: Told, *, yields: bool = False) -> list[str]:
    """Return a handshape as lines of a constraint set.

    Shapes that the core has as a rule are written by their name; others finger by finger. What
    neither can say is told. yields: whether digits yield to what they touch, within what the
    notation distinguishes.
    """
    _tell_losses(shape, told)
    if _is_plain(shape):
        return [_rule(shape, hand, yields=yields)]
    return _finger_by_finger(shape, hand, told, yields=yields)


def _is_plain(shape: HandShape) -> bool:
    bends = [digit for digit, _ in shape.bends if digit != "1"]
    form, second = shape.form, shape.second
    if shape.fingers or bends or shape.exempt or shape.crossing:
        return False
    if second is not None and (second.base != form.base or form.base == "fist"):
        return False
    return not (_is_ring(form.base) and (second or form.bend or form.thumb or form.opening))


def _is_ring(base: str) -> bool:
    """Whether the thumb and the fingers form a ring, closed or open."""
    return base.startswith(("pinch", "cee"))


def _rule(shape: HandShape, hand: str, *, yields: bool) -> str:
    form = shape.form
    arguments = _general(hand, yields=yields)
    bend = bend_of(form.bend)
    if shape.second is not None:
        bend = _between(bend, bend_of(shape.second.bend))
    if bend != BENDS["straight"] and form.base != "fist":
        arguments.append(f"'bend = {_bend(bend)}")
    if _is_between_thumbs(shape):
        arguments.append(f"'thumb = {_yielding(_thumb_between(shape), yields=yields)}")
    elif form.thumb or form.base == "finger2":  # no point of a nail is notated, it may lie anywhere
        arguments.append(f"'thumb = {_yielding(_thumb(form), yields=yields)}")
    name = {"flat": "flathand"}.get(form.base, form.base)
    return f":#ham{name}" + (f"({', '.join(arguments)})" if arguments else "")


def _general(hand: str, *, yields: bool) -> list[str]:
    """Return the arguments that all rules of handshapes have."""
    side = [] if hand == "s" else [f"'side = {hand}"]
    return [*side, f"'yield = {YIELD_DEGREES}"] if yields else side


def _yielding(thumb: str, *, yields: bool) -> str:
    """Return a thumb that yields, if its rule tells angles; others are led by what they are at."""
    if not yields or not thumb.startswith((".thumb-out", ".thumb-opposed", ".thumb(")):
        return thumb
    bound = f"'yield = {YIELD_DEGREES}"
    return f"{thumb[:-1]}, {bound})" if thumb.endswith(")") else f"{thumb}({bound})"


def _is_between_thumbs(shape: HandShape) -> bool:
    return shape.second is not None and _thumb_at(shape.form) != _thumb_at(shape.second)


def _thumb_at(form: Form) -> str:
    """Return where a thumb is: as said, or where the form has it."""
    if form.thumb:
        return form.thumb
    if _is_ring(form.base):
        return "opposed"
    return "beside" if form.base in ("flat", "fist") else "across"


def _thumb_between(shape: HandShape) -> str:
    """Return a thumb halfway between those of two forms."""
    assert shape.second is not None
    return _BETWEEN_THUMBS[frozenset((_thumb_at(shape.form), _thumb_at(shape.second)))]


def _thumb(form: Form) -> str:
    return _THUMBS[form.thumb].get(form.base, _USUAL_THUMB[form.thumb])


def _finger_by_finger(shape: HandShape, hand: str, told: Told, *, yields: bool) -> list[str]:
    form = shape.form
    bends = _bends(form, shape.fingers)
    spread = _spread(form)
    if shape.second is not None:
        others = _bends(shape.second, "")
        bends = {d: _between(bends[d], others[d]) for d in bends}
        spread = (spread + _spread(shape.second)) / 2
    for digit in shape.exempt:
        if digit in bends:
            bends[digit] = BENDS["straight"]
    for digit, bend in shape.bends:
        if digit in bends:
            bends[digit] = bend_of(bend)
    touching = _touching(shape, told)
    if touching is not None:
        if not _is_bent_pinch(shape):
            bends[touching] = _PINCHED["pinch12"]
        return _touching_hand(shape, hand, bends, touching, spread, yields=yields)
    arguments = _general(hand, yields=yields)
    arguments += [f"'{_NAMES[d]} = {_bend(bend)}" for d, bend in bends.items() if bend != _CLOSED]
    if spread:
        arguments.append(f"'spread = {number(spread)}")
    arguments.append(f"'thumb = {_yielding(_any_thumb(shape, bends), yields=yields)}")
    crossed = [f"morph 'fingers_crossed {hand} 1"] if _is_crossed(shape) else []
    return [f":#hand-of({', '.join(arguments)})", *crossed]


def _any_thumb(shape: HandShape, bends: Mapping[str, tuple[float, float]]) -> str:
    if _is_between_thumbs(shape):
        return _thumb_between(shape)
    base = shape.form.base
    if not _is_ring(base):
        return _thumb(shape.form)
    pinched = base in _PINCHED and bends["2"] == _PINCHED[base]
    return ".thumb-pinch" if pinched else ".thumb-opposed"


def _touching(shape: HandShape, told: Told) -> str | None:
    """Return the finger that the thumb touches, where that is no usual pinch of the index."""
    crossing = shape.crossing
    if crossing is not None:
        pair = {crossing.digit, crossing.other}
        if "1" in pair:
            return max(pair)
        if not _is_crossed(shape):
            told("crossing", "two fingers that touch are not written")
        return None
    if shape.form.base not in _PINCHED or _is_between_thumbs(shape):
        return None
    if "2" in (shape.fingers or "2"):
        return "2" if _is_bent_pinch(shape) else None
    return next((d for d in shape.fingers if d in _NAMES), None)


def _is_bent_pinch(shape: HandShape) -> bool:
    """Whether thumb and index touch, with fingers that are bent in another way than usual."""
    bent = shape.form.bend or any(digit == "2" for digit, _ in shape.bends)
    return shape.form.base in ("pinch12", "pinchall") and bool(bent) and not shape.fingers


def _is_crossed(shape: HandShape) -> bool:
    crossing = shape.crossing
    return crossing is not None and {crossing.digit, crossing.other} == {"2", "3"}


def _touching_hand(
    shape: HandShape,
    hand: str,
    bends: Mapping[str, tuple[float, float]],
    touching: str,
    spread: float,
    *,
    yields: bool,
) -> list[str]:
    """Return a hand whose thumb touches a finger, which yields so far that they meet."""
    items = []
    others = f" 'soft {YIELD_DEGREES}" if yields else ""
    for digit, bend in bends.items():
        soft = " 'soft" if digit == touching else others
        for word, weight in zip(("bend", "hook"), bend, strict=True):
            items.append(f"'{_NAMES[digit]}_{word} {hand} {number(weight)}{soft}")
    items.append(f"'fingers_spread {hand} {number(spread)}")
    part = shape.crossing.part if shape.crossing else "tip"
    site = {"nail": "NA({0})", "midjoint": "KN({0}, 2)", "base": "KN({0}, 1)"}.get(part, "TIP({0})")
    return [
        f"morph {' '.join(items)}",
        f"place @T_TIP({hand}) @{FINGER[touching]}_{site.format(hand)} 'contact",
    ]


def _bends(form: Form, fingers: str) -> dict[str, tuple[float, float]]:
    """Return how far each finger is bent and hooked."""
    selected = set(fingers or _FINGERS[form.base])
    bends = {}
    for digit in "2345":
        if digit not in selected:
            bends[digit] = BENDS["straight"] if form.base.endswith("open") else _CLOSED
        elif form.base in _PINCHED:
            bends[digit] = _with(_PINCHED[form.base], form.bend)
        elif form.base.startswith("cee"):
            bends[digit] = _opened(bend_of(form.bend or "round"), form.opening)
        else:
            bends[digit] = bend_of(form.bend)
    return bends


def _with(pinched: tuple[float, float], bend: str | None) -> tuple[float, float]:
    """Return the fingers of a pinch that is bent in another way than usual."""
    return pinched if bend is None else _between(pinched, bend_of(bend))


def _opened(bend: tuple[float, float], opening: str | None) -> tuple[float, float]:
    """Return the fingers of a cee that is wider or narrower than usual."""
    factor = {"slack": 0.7, "tight": 1.25}.get(opening or "", 1.0)
    return round(bend[0] * factor, 3), round(bend[1] * factor, 3)


def _between(a: tuple[float, float], b: tuple[float, float]) -> tuple[float, float]:
    return round((a[0] + b[0]) / 2, 3), round((a[1] + b[1]) / 2, 3)


def _spread(form: Form) -> float:
    if "spread" in form.base or form.base == "finger2345":
        return 1.0
    return 0.8 if form.base.endswith("open") else 0.0


def _bend(bend: tuple[float, float]) -> str:
    return _BEND_RULES.get(bend) or f"list({number(bend[0])}, {number(bend[1])})"


def _tell_losses(shape: HandShape, told: Told) -> None:
    if shape.thumb_enclosed:
        told("thumb-enclosed", "a thumb within the fist is over the index")
    if any(digit == "1" for digit, _ in shape.bends):
        told("thumb-bend", "the bend of a single thumb is not written")
