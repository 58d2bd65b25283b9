"""Draws a score with characters: blocks over a time axis, inner blocks below their block.

Every block is a bar as long as the block. Bars of one level share a row if neither they nor their
names overlap. A name that is wider than its bar is written behind it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from azee.export.score_layout import Box, lanes, nested
from azee.repl.ink import Ink, Line, cut, width
from azee.score.interval import Interval
from azee.score.score import Blank, Group, Hold, Key, Recorded, Score
from azee_grammar import vocabulary
from azee_solver.constraint import (
    Constraint,
    Look,
    LookAt,
    Morph,
    Orient,
    Place,
    Rotate,
    Transpath,
    Trill,
)

NARROWEST = 24
MOST_ROWS = 40
"""The most rows of a diagram; the deepest levels of a longer one are left out."""
_TRUNK = ("head", "neck", "back", "clav", "jaw")
_TICK_COLUMNS = 9
_STEPS = [Fraction(n, 20) for n in (1, 2, 4, 10, 20, 40, 100, 200, 400, 1200, 6000, 12000, 72000)]
_LEGEND = {
    Ink.HANDS: "hands",
    Ink.HEAD: "head and trunk",
    Ink.GAZE: "gaze",
    Ink.FACE: "face",
    Ink.HOLD: "hold",
    Ink.BLANK: "blank",
}


@dataclass(frozen=True, slots=True)
class _Bar:
    box: Box
    first: int
    end: int
    label: str
    label_at: int
    """The column where the label begins: inside the bar, or behind it."""

    @property
    def begin(self) -> int:
        """The first column that is drawn in."""
        return min(self.first, self.label_at)

    @property
    def reach(self) -> int:
        """The column after the last that is drawn in."""
        return max(self.end, self.label_at + width(self.label))


def diagram(score: Score, columns: int, *, colour: bool) -> tuple[Line, ...]:
    """Draw a score within a number of columns, at least `NARROWEST`.

    With colours, a bar is a coloured stretch, and its colour shows the part of the body that its
    constraints name. Without colours, it is drawn between `├` and `┤`.
    """
    columns = max(columns, NARROWEST)
    rows, left_out = _fitting_rows(nested(score), score.duration, columns)
    legend = _legend(dict.fromkeys(_ink(bar.box) for row in rows for bar in row))
    return (
        *_axis(score.duration, columns),
        *(_drawn(row, colour=colour) for row in rows),
        *((legend,) if colour and legend else ()),
        *((((Ink.FAINT, "what is left out here: /score tells it"),),) if left_out else ()),
    )


def _fitting_rows(whole: Box, duration: Fraction, columns: int) -> tuple[list[list[_Bar]], bool]:
    """Return the rows of as many levels as fit into `MOST_ROWS`, and whether some are left out."""
    deepest = max(box.depth for box in whole.all())
    for levels in range(deepest, -1, -1):
        rows = list(_rows([whole], duration, columns, levels))
        if len(rows) <= MOST_ROWS:
            return rows, levels < deepest
        if levels == 1:
            return rows[:MOST_ROWS], True
    return rows, False


def _rows(
    boxes: Sequence[Box], duration: Fraction, columns: int, levels: int
) -> Iterator[list[_Bar]]:
    """Yield rows of bars, each followed by the rows of inner blocks, down to a depth."""
    bars = [_bar(box, duration, columns) for box in boxes]
    taken = [Interval(Fraction(bar.begin), Fraction(bar.reach + 1)) for bar in bars]
    for lane in lanes(taken):
        row = [bars[i] for i in lane]
        yield row
        inner = [box for bar in row for box in bar.box.inner if box.depth <= levels]
        if inner:
            yield from _rows(inner, duration, columns, levels)


def _bar(box: Box, duration: Fraction, columns: int) -> _Bar:
    first = min(_column(box.interval.start, duration, columns), columns - 1)
    end = min(max(first + 1, _column(box.interval.end, duration, columns)), columns)
    inside, behind, before = end - first - 2, columns - end - 1, first - 1
    label = box.title
    if width(label) <= inside:
        return _Bar(box, first, end, label, first + 1)
    if width(label) <= behind:
        return _Bar(box, first, end, label, end + 1)
    if inside < behind or inside < before:
        if width(label) <= before:
            return _Bar(box, first, end, label, before - width(label))
        label = cut(label, max(behind, before))
        at = end + 1 if behind >= before else before - width(label)
        return _Bar(box, first, end, label, at)
    return _Bar(box, first, end, cut(label, inside), first + 1)


def _drawn(row: Sequence[_Bar], *, colour: bool) -> Line:
    """Write a row, from left to right."""
    line: list[tuple[Ink, str]] = []
    at = 0
    for bar in sorted(row, key=lambda bar: bar.begin):
        parts = [(bar.first, _ink(bar.box), _face(bar, colour=colour))]
        if not bar.first < bar.label_at < bar.end:
            parts.append((bar.label_at, Ink.PLAIN, bar.label))
        for start, ink, text in sorted(parts, key=lambda part: part[0]):
            line += [(Ink.PLAIN, " " * (start - at)), (ink, text)]
            at = start + width(text)
    return line


def _face(bar: _Bar, *, colour: bool) -> str:
    """Return the characters of a bar, with its name if that is inside."""
    size = bar.end - bar.first
    inside = bar.label if bar.first < bar.label_at < bar.end else ""
    rest = size - 1 - width(inside)
    if colour:
        return f" {inside}{' ' * rest}" if rest >= 0 else " " * size
    if size == 1:
        return "│"
    return f"├{inside}{'─' * (rest - 1)}┤"


def _ink(box: Box) -> Ink:
    """Return the colour of a block: that of the part that most of its constraints move."""
    match box.score:
        case Group():
            return Ink.GROUP if box.depth % 2 == 0 else Ink.GROUP_INSIDE
        case Hold():
            return Ink.HOLD
        case Blank():
            return Ink.BLANK
        case Recorded():
            return Ink.RECORDED
        case Key(constraints=constraints):
            found = {_moves(constraint) for constraint in constraints}
            order = (Ink.HANDS, Ink.HEAD, Ink.GAZE, Ink.FACE)
            return next((ink for ink in order if ink in found), Ink.BLANK)


def _moves(constraint: Constraint) -> Ink:
    match constraint:
        case Look() | LookAt():
            return Ink.GAZE
        case Morph(name=name):
            entry = vocabulary.MORPHS.get(name) or vocabulary.MORPHS.get(f"{name}_R")
            skeletal = entry is not None and "skeletal" in entry.kind
            return Ink.HANDS if skeletal else Ink.FACE
        case Rotate(bone=bone) | Trill(bone=bone):
            return Ink.HEAD if bone.name.startswith(_TRUNK) else Ink.HANDS
        case Place() | Orient() | Transpath():
            return Ink.HANDS


def _legend(inks: Iterable[Ink]) -> Line:
    line: list[tuple[Ink, str]] = []
    for ink in inks:
        if ink in _LEGEND:
            line += [(ink, "  "), (Ink.FAINT, f" {_LEGEND[ink]}   ")]
    return line


def _axis(duration: Fraction, columns: int) -> tuple[Line, Line]:
    """Write the time axis: seconds, and ticks below them."""
    most = max(1, columns // _TICK_COLUMNS)
    step = next((s for s in _STEPS if duration / s <= most), _STEPS[-1])
    numbers, ticks = [" "] * (columns + 8), ["─"] * columns
    end_text = f"{float(duration):.4g} s"
    count = int(duration / step) if duration else 0
    for i in range(count + 1):
        at = min(_column(i * step, duration, columns), columns - 1)
        text = f"{float(i * step):.4g}"
        ticks[at] = "┴"
        if at + len(text) < columns - len(end_text):
            numbers[at : at + len(text)] = text
    ticks[0], ticks[-1] = "├", "┤"
    at = columns - len(end_text)
    numbers[at:] = end_text
    return ((Ink.FAINT, "".join(numbers)),), ((Ink.FAINT, "".join(ticks)),)


def _column(time: Fraction, duration: Fraction, columns: int) -> int:
    return round(time / duration * columns) if duration else 0
