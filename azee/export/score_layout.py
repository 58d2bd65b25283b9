"""Places the blocks of a score for drawing: lanes on a time axis, nested or flattened."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from azee.score.interval import Interval
from azee.score.score import Blank, Group, Hold, Key, Recorded, Score, leaves
from azee_solver.notation import constraint_text

LEAF_HEIGHT = 28.0
HEADER = 20.0
GAP = 6.0


@dataclass(frozen=True, slots=True)
class Box:
    """A block to be drawn. `interval` is on the time line of the whole; `top` and `height` px."""

    title: str
    score: Score
    interval: Interval
    depth: int
    top: float
    height: float
    inner: tuple[Box, ...] = ()

    @property
    def details(self) -> tuple[str, ...]:
        """The constraints of its leaf, a line each; empty for a group."""
        match self.score:
            case Key(constraints=constraints):
                return tuple(map(constraint_text, constraints))
            case Hold(block=block, channels=channels):
                return (f"hold '{block}: {', '.join(channels)}",)
            case Blank():
                return ("blank",)
            case Recorded(motion=motion):
                return (f"recorded '{motion.name}'",)
            case Group():
                return ()

    def all(self) -> Iterable[Box]:
        """Yield it and all boxes inside, outer before inner."""
        yield self
        for box in self.inner:
            yield from box.all()


def title(name: str, score: Score) -> str:
    """Return the name of a block, with the rule that its score came from."""
    rule = score.calls[0].title if score.calls else ""
    if not name:
        return rule or type(score).__name__.lower()
    return f"{name} · {rule}" if rule and rule != name else name


def nested(score: Score, top: float = 0.0) -> Box:
    """Lay out a score with its levels inside each other (2018 paper, figure 1)."""
    return _nested("", score, Interval(Fraction(0), score.duration), 0, top)


def _nested(name: str, score: Score, interval: Interval, depth: int, top: float) -> Box:
    if not isinstance(score, Group):
        return Box(title(name, score), score, interval, depth, top, LEAF_HEIGHT)
    inner: list[Box] = []
    bottom = top + HEADER
    placed = [block.interval_in_parent.shifted(interval.start) for block in score.blocks]
    for lane in lanes(placed):
        boxes = [
            _nested(score.blocks[i].name, score.blocks[i].score, placed[i], depth + 1, bottom)
            for i in lane
        ]
        inner += boxes
        bottom = max(box.top + box.height for box in boxes) + GAP
    return Box(title(name, score), score, interval, depth, top, bottom - top, tuple(inner))


def flattened(score: Score, top: float = 0.0) -> tuple[Box, ...]:
    """Lay out the leaves alone, projected on the one time line (2018 paper, figure 2)."""
    found = list(leaves(score))
    names = [_short_path(leaf.path) for leaf in found]
    rows = lanes([leaf.interval for leaf in found])
    return tuple(
        Box(
            title(names[i], found[i].score),
            found[i].score,
            found[i].interval,
            0,
            top + row * (LEAF_HEIGHT + GAP),
            LEAF_HEIGHT,
        )
        for row, lane in enumerate(rows)
        for i in lane
    )


def _short_path(path: Sequence[str]) -> str:
    """Return the last name of a path; a number, as in a `seq`, follows the name before it."""
    if not path:
        return ""
    return " ".join(path[-2:]) if path[-1].isdecimal() else path[-1]


def boundaries(score: Score) -> tuple[Fraction, ...]:
    """Return the instants at which a leaf begins or ends: the keyframes of the flattened score."""
    found = [leaf.interval for leaf in leaves(score)]
    return tuple(sorted({i.start for i in found} | {i.end for i in found}))


def lanes(intervals: Sequence[Interval]) -> list[list[int]]:
    """Distribute intervals over as few rows as possible: no two in a row overlap or coincide.

    Returns: rows of indices; each interval, in the order given, in the first row that has room.
    """
    rows: list[list[int]] = []
    for i, interval in enumerate(intervals):
        for row in rows:
            if not any(_collide(interval, intervals[j]) for j in row):
                row.append(i)
                break
        else:
            rows.append([i])
    return rows


def _collide(a: Interval, b: Interval) -> bool:
    if a.start == b.start:
        return True
    first, second = (a, b) if a.start < b.start else (b, a)
    return second.start < first.end
