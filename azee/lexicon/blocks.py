"""The blocks of one part of a sign: what holds for how long, the ways, the trills.

What a hand is like is told apart into shape, orientation and place. What stays the same from one
moment to the next is one block; what changes is said at the moments, and the body finds its way.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from azee.lexicon.constraint_text import orientation_text, place_text, vector_text, way_text
from azee.lexicon.hand_text import Told, hand_text
from azee.lexicon.layout import Line, block_lines, key_lines
from azee.lexicon.numbers import number
from azee.lexicon.phrase import CircleWay, Moment, Move, Phrase, StraightWay
from azee.lexicon.places import Site, other
from azee.lexicon.sizes import HELD_S
from azee.lexicon.vectors import Vector

_ON_THE_WAY_M = 0.01
"""How far off its way a hand may be that turns or changes on it."""
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
    postures = list(_grouped([r for r in runs if not _is_whole(r, whole_s)]))
    ending = {_mark(run.end_s): f"P{i}" for i, run in enumerate(postures, start=1)}
    ways = [
        _Run(move.start_s + HELD_S, move.end_s + HELD_S, (text,))
        for name in names
        for move, text in _ways(phrase, name, told)
    ]
    tremors = [_Run(t.start_s + HELD_S, t.end_s + HELD_S, (t.text,)) for t in phrase.tremors]
    groups = (("P", postures), ("M", list(_grouped(ways))), ("T", list(_grouped(tremors))))
    for letter, found in groups:
        for i, run in enumerate(found, start=1):
            start = "'start 'HANDS:start"
            if run.start_s > _SAME_S:
                start += f":{number(run.start_s)}"
            constraints = [_marked(constraint, ending) for constraint in run.constraints]
            score = key_lines(run.end_s - run.start_s, constraints)
            blocks.append(Block(f"{letter}{i}", tuple(score), start))
    return blocks


def _mark(time_s: float) -> str:
    """Return what stands for the name of the block that ends at a time, until it has one."""
    return f"<{time_s:.3f}>"


def _marked(constraint: str, ending: Mapping[str, str]) -> str:
    """Return a constraint with the names of blocks."""
    for mark, name in ending.items():
        constraint = constraint.replace(mark, name)
    return constraint


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
    placed = [tuple(_placed(before, m, stays=stays)) for before, m in _with_before(moments)]
    moves = [move for move in phrase.moves if move.name == name and not _is_carried(move, phrase)]
    yield from _aspect(moments, shapes, [], phrase.duration_s)
    yield from _aspect(moments, turned, [], phrase.duration_s)
    yield from _aspect(moments, placed, moves, phrase.duration_s)


def _with_before(moments: Sequence[Moment]) -> Iterator[tuple[Moment | None, Moment]]:
    """Yield moments, each with the one before it."""
    yield from zip((None, *moments[:-1]), moments, strict=True)


def _placed(before: Moment | None, moment: Moment, *, stays: bool) -> list[str]:
    """Return the constraint on where a hand is: at a place, or so far from where it was."""
    way = _way(before, moment)
    if before is None or way is None:
        return place_text(moment.hand, moment.name, stays=stays)
    place, site = moment.hand.place, _moving_site(before, moment)
    assert place is not None
    if place.is_space and site == moment.hand.site:
        return place_text(moment.hand, moment.name, stays=stays)
    vector = vector_text(way, moment.name)
    return [f"shift {site.text} {vector} 'from '{_mark(before.time_s + HELD_S)}"]


def _way(before: Moment | None, moment: Moment) -> Vector | None:
    """Return how far a hand moved since a moment, if it is said so."""
    if before is None or before.hand.place is None or moment.hand.place is None:
        return None
    return moment.hand.place.way_from(before.hand.place)


def _moving_site(before: Moment, moment: Moment) -> Site:
    """Return what moves: the site that is placed, or the palm if the hand turns or changes."""
    hand, old = moment.hand, before.hand
    turns = (old.pointing, old.facing, old.shape) != (hand.pointing, hand.facing, hand.shape)
    if turns or hand.site is None or hand.site != old.site:
        return Site("PA", moment.name)
    return hand.site


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


def _ways(phrase: Phrase, name: str, told: Told) -> Iterator[tuple[Move, str]]:
    """Yield the ways from one moment at which a hand is placed to the next."""
    for move in phrase.moves:
        if move.name != name or _is_carried(move, phrase):
            continue
        before, after = _ends(move, phrase)
        if before is None or after is None:
            if not isinstance(move.way, StraightWay):
                told("way-between", "a curve between moments of which nothing is said is straight")
            continue
        if before.hand.place is None or after.hand.place is None or after.hand.site is None:
            continue
        text = _way_text(move, before, after, told)
        if text is not None:
            yield move, text


def _way_text(move: Move, before: Moment, after: Moment, told: Told) -> str | None:
    """Return the constraint that keeps a hand on its way; None where nothing needs to."""
    path = way_text(move.way, move.name)
    way = _way(before, after)
    if before.hand.place == after.hand.place and not isinstance(move.way, CircleWay):
        return None
    site = after.hand.site if way is None else _moving_site(before, after)
    assert site is not None
    if site in (before.hand.site, after.hand.site) and before.hand.site == after.hand.site:
        return f"transpath {site.text} {path}"
    if isinstance(move.way, StraightWay):
        return None
    if way is None:
        told("site-changes", "a curve on which the part of the hand changes is left out")
        return None
    start = f"was('{_mark(before.time_s + HELD_S)}, {site.text})"
    end = f"vtranslate({start}, {vector_text(way, move.name)})"
    return f"place {site.text} moving({path}, {start}, {end}) 'within {number(_ON_THE_WAY_M)}"
