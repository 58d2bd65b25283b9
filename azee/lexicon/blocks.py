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
from azee.lexicon.vectors import Vector, dot, times

_ON_THE_WAY_M = 0.01
"""How far off its way a hand may be that turns or changes on it."""
_OPPOSITE = -0.99
"""The cosine below which there is no shorter way round from a direction to another."""
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
    yields = name in _touching(phrase)
    shapes = [
        () if m.hand.shape is None else tuple(hand_text(m.hand.shape, name, told, yields=yields))
        for m in moments
    ]
    turned = [tuple(orientation_text(m.hand, name)) for m in moments]
    befores = (None, *moments[:-1])
    placed = [
        tuple(_placed(before, moment, site))
        for before, moment, site in zip(befores, moments, _sites(moments), strict=True)
    ]
    moves = [
        move
        for move in phrase.moves
        if move.name == name and not _is_carried(move, phrase) and not _goes_nowhere(move, phrase)
    ]
    yield from _aspect(moments, shapes, [], phrase.duration_s)
    yield from _aspect(moments, turned, [], phrase.duration_s)
    yield from _aspect(moments, placed, moves, phrase.duration_s)


def _touching(phrase: Phrase) -> frozenset[str]:
    """Return the hands that touch something at any moment, or are touched by the other."""
    found = set[str]()
    for moment in phrase.moments:
        place = moment.hand.place
        if place is not None and place.touches:
            found |= {moment.name, other(moment.name)} if place.is_at_hand else {moment.name}
    return frozenset(found)


def _placed(before: Moment | None, moment: Moment, site: Site | None) -> list[str]:
    """Return the constraint on where a hand is: at a place, or so far from where it was."""
    way = _way(before, moment)
    place = moment.hand.place
    if before is None or way is None or place is None or site is None:
        return place_text(moment.hand, moment.name)
    if place.is_space and site == moment.hand.site:
        return place_text(moment.hand, moment.name)
    vector = vector_text(way, moment.name)
    return [f"shift {site.text} {vector} 'from '{_mark(before.time_s + HELD_S)}"]


def _way(before: Moment | None, moment: Moment) -> Vector | None:
    """Return how far a hand moved since a moment, on or back, if it is said so.

    Back to a place that it had moved to; one that it started at is a place again.
    """
    if before is None or before.hand.place is None or moment.hand.place is None:
        return None
    start, end = before.hand.place, moment.hand.place
    on = end.way_from(start)
    if on is not None or end.origin is None:
        return on
    back = start.way_from(end)
    return None if back is None else times(back, -1)


def _sites(moments: Sequence[Moment]) -> list[Site | None]:
    """Return which site of a hand is placed at each moment.

    A hand that moves and turns or changes on the way is led by its palm, from then on until it is
    at a place again.
    """
    sites: list[Site | None] = []
    for i, moment in enumerate(moments):
        site = moment.hand.site
        if i and _way(moments[i - 1], moment) is not None:
            old, hand = moments[i - 1].hand, moment.hand
            turns = (old.pointing, old.facing, old.shape) != (
                hand.pointing,
                hand.facing,
                hand.shape,
            )
            if turns or sites[-1] != site:
                site = Site("PA", moment.name)
        sites.append(site)
    return sites


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


def _goes_nowhere(move: Move, phrase: Phrase) -> bool:
    """Whether a way ends where it begins: the hand stays."""
    before, after = _ends(move, phrase)
    if before is None or after is None or isinstance(move.way, CircleWay):
        return False
    return (before.hand.place, before.hand.site) == (after.hand.place, after.hand.site)


def _is_carried(move: Move, phrase: Phrase) -> bool:
    """Whether a hand goes with the other one, which it touches before and after.

    Hands that circle round each other do not.
    """
    before, after = _ends(move, phrase)
    if before is None or after is None or before.hand.place != after.hand.place:
        return False
    place = after.hand.place
    if place is None or not place.is_at_hand:
        return False
    return any(
        m.name == other(move.name)
        and abs(m.start_s - move.start_s) < _SAME_S
        and (m.way == move.way or not isinstance(move.way, CircleWay))
        for m in phrase.moves
    )


def _ends(move: Move, phrase: Phrase) -> tuple[Moment | None, Moment | None]:
    """Return the moments at which a way begins and ends, if there are any."""
    moments = _moments(phrase, move.name)
    before = next((m for m in moments if abs(m.time_s - move.start_s) < _SAME_S), None)
    after = next((m for m in moments if abs(m.time_s - move.end_s) < _SAME_S), None)
    return before, after


def _ways(phrase: Phrase, name: str, told: Told) -> Iterator[tuple[Move, str]]:
    """Yield the constraints that keep a hand on its ways, from one moment to the next."""
    moments = _moments(phrase, name)
    times = (round(moment.time_s, 3) for moment in moments)
    sites = dict(zip(times, _sites(moments), strict=True))
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
        ends = sites[round(before.time_s, 3)], sites[round(after.time_s, 3)]
        for text in _way_texts(move, before, after, ends, told):
            yield move, text


def _way_texts(
    move: Move,
    before: Moment,
    after: Moment,
    sites: tuple[Site | None, Site | None],
    told: Told,
) -> list[str]:
    """Return the constraints that keep a hand on its way; none where nothing needs to.

    sites: those that are placed at the two moments.
    """
    path = way_text(move.way, move.name)
    way = _way(before, after)
    if before.hand.place == after.hand.place and not isinstance(move.way, CircleWay):
        return []
    first, site = sites
    if first is None or site is None:
        return []
    if first == site:
        return [f"transpath {site.text} {path}"]
    if isinstance(move.way, StraightWay):
        return []
    if way is None:
        told("site-changes", "a curve on which the part of the hand changes is left out")
        return []
    if before.hand.shape != after.hand.shape:
        told("shape-changes", "a curve on which the hand changes its shape is left out")
        return []
    start = f"was('{_mark(before.time_s + HELD_S)}, {site.text})"
    end = f"vtranslate({start}, {vector_text(way, move.name)})"
    moving = f"place {site.text} moving({path}, {start}, {end}) 'within {number(_ON_THE_WAY_M)}"
    return [moving, *_turning(before, after)]


def _turning(before: Moment, after: Moment) -> list[str]:
    """Return the constraints on a hand that turns on its way."""
    axes = {
        "dir": (before.hand.pointing, after.hand.pointing),
        "nrm": (before.hand.facing, after.hand.facing),
    }
    return [
        f"turning '{axis} !palm({after.name})"
        for axis, (start, end) in axes.items()
        if start is not None and end is not None and dot(start, end) > _OPPOSITE
    ]
