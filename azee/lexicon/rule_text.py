"""Writes a sign as an AZee rule: its header, its parts, what else moves, what was approximated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from azee.lexicon.blocks import Block, part_blocks
from azee.lexicon.face_text import gesture, others, sampa
from azee.lexicon.hands import Hand, Hands
from azee.lexicon.layout import Line, block_lines, joined_text, key_lines
from azee.lexicon.model import Manual, Sign
from azee.lexicon.moving import Mover
from azee.lexicon.numbers import number
from azee.lexicon.phrase import Moment, Phrase, joined
from azee.lexicon.posing import Posing, located
from azee.lexicon.sizes import BETWEEN_S, HELD_S


@dataclass
class Notes:
    """What a rule does not say as its notation does, by kind."""

    found: dict[str, str] = field(default_factory=dict)

    def __call__(self, kind: str, detail: str) -> None:
        """Note an approximation."""
        self.found.setdefault(kind, detail)


@dataclass(frozen=True, slots=True)
class RuleText:
    """A rule as text, and what was approximated in it, by kind."""

    text: str
    notes: dict[str, str]


def rule_text(sign: Sign, name: str, source: str) -> RuleText:
    """Return the rule of a sign.

    Raises: TooLongError: the sign has more movements than any has.
    """
    notes = Notes()
    parts = [part_blocks(*_performed(manual, notes), notes) for manual in sign.manuals]
    if any(manual.holds_over for manual in sign.manuals[1:]):
        notes("hold-over", "a hand that stays from one part to the next is not held")
    extras = _extras(sign, notes)
    lines = _score(parts, extras)
    header: list[Line] = [(0, f"def {name}")]
    for entry, text in (
        ("meaning", sign.gloss or name),
        ("source", source),
        ("status", "inferred"),
    ):
        header.append((1, f'\'{entry} "{_plain(text)}"'))
    comments: list[Line] = [(1, f"# Approximated: {detail}.") for detail in notes.found.values()]
    comments += [(1, f"# In the notation: {fault.detail}.") for fault in sign.faults]
    body: list[Line] = [(depth + 1, text) for depth, text in lines]
    return RuleText(joined_text([*header, *comments, *body]), notes.found)


def _plain(text: str) -> str:
    """Return a text that can stand between quotes on one line."""
    return " ".join(text.replace('"', "'").split())


def _performed(manual: Manual, notes: Notes) -> tuple[Phrase, tuple[str, ...]]:
    """Return the part of a sign in time, with its first and last moments, and its hands."""
    sides = ("s", "w") if manual.symmetry is not None else ("w" if manual.weak_alone else "s",)
    hands: Hands = {"s": Hand(), "w": Hand()}
    posing = Posing(manual.symmetry, notes)
    hands = posing.pose(manual.posture, hands, sides)
    used = tuple(n for n in ("s", "w") if n in sides or hands[n] != Hand())
    hands = located(hands, used)
    start = hands
    mover = Mover(manual.symmetry, notes, where=manual.posture.location)
    phrase, hands = mover.in_turn(manual.moves, hands, sides)
    used = tuple(n for n in ("s", "w") if n in used or hands[n] != Hand())
    ends = [
        Moment(time_s, name, state[name])
        for time_s, state in ((0.0, start), (phrase.duration_s, hands))
        for name in used
        if state[name] != Hand()
    ]
    if not phrase.duration_s:
        ends = ends[len(ends) // 2 :] if start == hands else ends
    return joined(phrase.duration_s, [phrase, Phrase(moments=ends)]), used


def _extras(sign: Sign, notes: Notes) -> list[tuple[str, list[Line]]]:
    """Return blocks that last as long as the hands: the mouth, and the rest of the body."""
    found: list[tuple[str, list[Line]]] = []
    if said := sampa(sign.nonmanual.mouthing, notes):
        found.append(("MOUTH", [(0, f'mouthing "{said}" \'sampa "{said}"')]))
    elif shape := gesture(sign.nonmanual, notes):
        found.append(("MOUTH", key_lines(1, [shape])))
    if constraints := others(sign.nonmanual, notes):
        found.append(("BODY", key_lines(1, constraints)))
    return found


def _score(
    parts: Sequence[Sequence[Block]], extras: Sequence[tuple[str, list[Line]]]
) -> list[Line]:
    """Return the score of a sign: its parts in sequence, the rest beside them."""
    beside: list[Line] = []
    first = "HANDS" if len(parts) == 1 else "PARTS"
    for name, lines in extras:
        beside += block_lines(name, lines, f"'with '{first}")
    if len(parts) == 1:
        blocks = [line for block in parts[0] for line in block.lines()]
        return [(0, "sync"), *_deeper(blocks), *_deeper(beside)]
    sequence: list[Line] = [(0, "seq"), (1, "list")]
    for part in parts:
        blocks = [line for block in part for line in block.lines()]
        sequence += [(2, "sync"), *_deeper(blocks, 3)]
    sequence.append((1, f"'gap {number(BETWEEN_S)}"))
    if not parts:
        sequence = [(0, f"blank {number(2 * HELD_S)}")]
    return [(0, "sync"), *_deeper(block_lines("PARTS", sequence, None)), *_deeper(beside)]


def _deeper(lines: Sequence[Line], by: int = 1) -> list[Line]:
    return [(depth + by, text) for depth, text in lines]
