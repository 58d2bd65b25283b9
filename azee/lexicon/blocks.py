"""The blocks of one part of a sign: what holds for how long, the ways, the trills.

What a hand is like is told apart into shape, orientation and place. What stays the same from one
moment to the next is one block; what changes is said at the moments, and the body finds its way.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from azee.lexicon.constraint_text import orientation_text, place_text, way_text
from azee.lexicon.hand_text import Told, hand_text
from azee.lexicon.layout import Line, block_lines, key_lines
from azee.lexicon.numbers import number
from azee.lexicon.phrase import CircleWay, Moment, Move, Phrase
from azee.lexicon.places import other
from azee.lexicon.sizes import HELD_S

_SAME_S = 2e-3
"""Times that are nearer to each other are the same."""


@dataclass(frozen=True, slots=True)
class Block:
    """A block of a `sync`. rule: when it is; None for the first."""

    name: str
    score: tuple[Line, ...]
    rule: str | None

    def lines(self) -> list[Line]:
        """Return its lines."""
        return block_lines(self.name, self.score, self.rule)


@dataclass(frozen=True, slots=True)
class _Run:
    """Constraints in force from one time to another."""

    start_s: float
    end_s: float
    constraints: tuple[str, ...]


def part_blocks(phrase: Phrase, names: Sequence[str], told: Told) -> list[Block]:
    """Return the blocks of a part. Times are from its start, held at both ends."""
    whole_s = phrase.duration_s + 2 * HELD_S
    runs = [run for name in names for run in _runs(phrase, name, told)]
    whole = [c for r in runs if _is_whole(r, whole_s) for c in r.constraints]
    first = key_lines(whole_s, whole) if whole else [(0, f"blank {number(whole_s)}")]
    blocks = [Block("HANDS", tuple(first), None)]
    ways = [_Run(m.start_s + HELD_S, m.end_s + HELD_S, (text,)) for m, text in _ways(phrase, told)]
    tremors = [_Run(t.start_s + HELD_S, t.end_s + HELD_S, (t.text,)) for t in phrase.tremors]
    groups = (("P", [r for r in runs if not _is_whole(r, whole_s)]), ("M", ways), ("T", tremors))
    for letter, found in groups:
        for i, run in enumerate(_grouped(found), start=1):
            start = "'start 'HANDS:start"
            if run.start_s > _SAME_S:
                start += f":{number(run.start_s)}"
            score = key_lines(run.end_s - run.start_s, run.constraints)
            blocks.append(Block(f"{letter}{i}", tuple(score), start))
    return blocks


def _is_whole(run: _Run, whole_s: float) -> bool:
    return run.start_s < _SAME_S and run.end_s > whole_s - _SAME_S


def _grouped(runs: Sequence[_Run]) -> Iterator[_Run]:
    """Yield runs of the same times as one, in the order of time."""
    found: dict[tuple[float, float], list[str]] = {}
    for run in runs:
        times = (round(run.start_s, 3), round(run.end_s, 3))
        found.setdefault(times, []).extend(c for c in run.constraints)
    for (start_s, end_s), constraints in sorted(found.items()):
        yield _Run(start_s, end_s, tuple(dict.fromkeys(constraints)))


def _runs(phrase: Phrase, name: str, told: Told) -> Iterator[_Run]:
    """Yield what holds for one hand, for how long."""
    moments = _moments(phrase, name)
    if not moments:
        return
    shapes = [
        () if m.hand.shape is None else tuple(hand_text(m.hand.shape, name, told)) for m in moments
    ]
    turned = [tuple(orientation_text(m.hand, name)) for m in moments]
    stays = not any(move.name == name for move in phrase.moves)
    placed = [tuple(place_text(m.hand, name, stays=stays)) for m in moments]
    moves = [move for move in phrase.moves if move.name == name and not _is_carried(move, phrase)]
    yield from _aspect(moments, shapes, [], phrase.duration_s)
    yield from _aspect(moments, turned, [], phrase.duration_s)
    yield from _aspect(moments, placed, moves, phrase.duration_s)


def _moments(phrase: Phrase, name: str) -> list[Moment]:
    """Return the moments of a hand, in order, one for each time."""
    found: dict[float, Moment] = {}
    for moment in phrase.moments:
        if moment.name == name:
            found[round(moment.time_s, 3)] = moment
    return [found[time_s] for time_s in sorted(found)]


def _aspect(
    moments: Sequence[Moment],
    texts: Sequence[tuple[str, ...]],
    moves: Sequence[Move],
    duration_s: float,
) -> Iterator[_Run]:
    """Yield runs of equal constraints; a movement between two moments separates them."""
    start = 0
    for i in range(1, len(moments) + 1):
        if i < len(moments):
            between = (moments[i - 1].time_s, moments[i].time_s)
            if texts[i] == texts[start] and not _is_moving(moves, *between):
                continue
        if texts[start]:
            begins, ends = moments[start].time_s, moments[i - 1].time_s
            yield (
                _Run(
                    0.0 if begins < _SAME_S else begins + HELD_S,
                    ends + HELD_S + (HELD_S if ends > duration_s - _SAME_S else 0),
                    texts[start],
                )
                if begins >= _SAME_S or ends > _SAME_S or not duration_s
                else _Run(0.0, HELD_S, texts[start])
            )
        start = i


def _is_moving(moves: Sequence[Move], start_s: float, end_s: float) -> bool:
    return any(m.start_s < end_s - _SAME_S and m.end_s > start_s + _SAME_S for m in moves)


def _is_carried(move: Move, phrase: Phrase) -> bool:
    """Whether a hand goes with the other one, which it touches before and after."""
    before, after = _ends(move, phrase)
    if before is None or after is None or before.hand.place != after.hand.place:
        return False
    place = after.hand.place
    if place is None or not place.is_at_hand:
        return False
    return any(
        m.name == other(move.name) and abs(m.start_s - move.start_s) < _SAME_S for m in phrase.moves
    )


def _ends(move: Move, phrase: Phrase) -> tuple[Moment | None, Moment | None]:
    """Return the moments at which a way begins and ends, if there are any."""
    moments = _moments(phrase, move.name)
    before = next((m for m in moments if abs(m.time_s - move.start_s) < _SAME_S), None)
    after = next((m for m in moments if abs(m.time_s - move.end_s) < _SAME_S), None)
    return before, after


def _ways(phrase: Phrase, told: Told) -> Iterator[tuple[Move, str]]:
    """Yield the ways that a site can keep to, from one moment at which it is placed to the next."""
    for move in phrase.moves:
        before, after = _ends(move, phrase)
        if before is None or after is None:
            told("way-between", "a way that does not end where a posture is said is not written")
            continue
        if before.hand.place is None or after.hand.place is None or after.hand.site is None:
            continue
        if before.hand.site != after.hand.site:
            told("site-changes", "the part of the hand that is placed changes on the way")
            continue
        same = before.hand.place == after.hand.place
        if _is_carried(move, phrase) or (same and not isinstance(move.way, CircleWay)):
            continue
        yield move, f"transpath {after.hand.site.text} {way_text(move.way, move.name)}"
