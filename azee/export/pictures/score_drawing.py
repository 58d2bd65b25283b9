"""A score as a drawing: nested above, flattened below, tracks at the bottom, over one time axis.

The drawing follows figures 1 and 2 of Nunnari, Filhol & Heloir 2018: boxes on a time line, levels
inside each other, grey boxes for constraints. The tooltip of a box lists its constraints. The
tracks of a solved score have a row per part of the body, with a bar for each block that moves it
and a mark at each key.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from azee.export.pictures.shapes import Drawing, Line, Rect, Shape, Text, Told
from azee.export.score_layout import GAP, LEAF_HEIGHT, Box, boundaries, flattened, nested
from azee.export.track_rows import Bar, Row
from azee.score.score import Blank, Group, Hold, Key, Recorded, Score

MARGIN = 28.0
INSET = 2.5
"""How much narrower a box is than the box around it, so that edges at one instant are apart."""
CHARACTER = 7.4
NARROW, WIDE = 4.2, 9.4
"""Widths of most characters, of narrow ones and of capitals at 12 px, in a wide font."""
CAPTION = 26.0
THINNEST = 4.0
"""Width of a box that has no length."""
NARROWEST, WIDEST = 110.0, 420.0
"""Pixels a second: as many as the names need, within these bounds."""
WIDEST_PICTURE = 1600.0
"""The largest width of the picture that names may cause, in pixels."""
NARROWEST_PICTURE = 560.0
"""Width of the legend, in pixels."""
LANE = 22.0
"""Height of a row of tracks with its gap."""
LEGEND = (
    ("leaf", "constraints"),
    ("hold", "what another block reached, held"),
    ("blank", "nothing asked for"),
)


@dataclass(frozen=True, slots=True)
class _Axis:
    """Return the place of an instant, in pixels."""

    left: float
    scale: float
    end: Fraction

    def x(self, time: Fraction | float) -> float:
        return self.left + float(time) * self.scale


def score_drawing(score: Score, rows: Sequence[Row] = ()) -> Drawing:
    """Draw the nested score, the flattened one, and rows of tracks if there are any."""
    whole = nested(score, top=CAPTION)
    leaves_top = whole.top + whole.height + 2 * CAPTION
    leaf_boxes = flattened(score, top=leaves_top)
    leaves_bottom = max(box.top + box.height for box in leaf_boxes) + GAP
    tracks_top = leaves_bottom + 1.5 * CAPTION
    lanes = sum(len(row.lanes) for row in rows)
    bottom = tracks_top + lanes * LANE + GAP if rows else leaves_bottom
    left = max([MARGIN, *(width(row.name) + 20.0 for row in rows)])
    axis = _Axis(left, _scale([*whole.all(), *leaf_boxes], score.duration), score.duration)
    edges = left - INSET, axis.x(axis.end) + INSET
    shapes = [
        *_grid(axis, whole.top, bottom),
        Text("Score", left, 16, "caption"),
        *_box(whole, axis, *edges),
        Text("Flattened", left, leaves_top - 26, "caption"),
        *_keyframes(boundaries(score), axis, leaves_top - 8, leaves_bottom),
        *(shape for box in leaf_boxes for shape in _box(box, axis, *edges)),
        *_rows(rows, axis, tracks_top),
        *_time_line(axis, bottom),
        *_legend(left, bottom + 50, {_kind(box) for box in leaf_boxes}, bool(rows)),
    ]
    return Drawing(
        whole.title, max(axis.x(axis.end) + MARGIN, NARROWEST_PICTURE), bottom + 66.0, tuple(shapes)
    )


def width(text: str) -> float:
    """Return the approximate width of a text, in pixels; rather too much than too little."""
    return sum(
        WIDE if c.isupper() else NARROW if c in " .,:;'|!ijlt·()[]" else CHARACTER for c in text
    )


def _scale(boxes: Iterable[Box], duration: Fraction) -> float:
    """Return the pixels a second with which every name fits into its box, up to a bound."""
    needed = [
        (width(box.title) + 2 * INSET * (box.depth + 2)) / float(box.interval.duration)
        for box in boxes
        if box.interval.duration
    ]
    most = min(WIDEST, WIDEST_PICTURE / float(duration)) if duration else WIDEST
    return max(NARROWEST, min(max([0.0, *needed]), most))


def _box(box: Box, axis: _Axis, low: float, high: float) -> Iterable[Shape]:
    """Draw a box and its inner boxes, between the edges of the box around it."""
    low, high = low + INSET, high - INSET
    left, right = max(axis.x(box.interval.start), low), min(axis.x(box.interval.end), high)
    if right - left < THINNEST:
        left = min(max((left + right - THINNEST) / 2, low), high - THINNEST)
        right = left + THINNEST
    shapes: list[Shape] = [
        Rect(_kind(box), left, box.top, right - left, box.height, 3, box.depth % 2)
    ]
    baseline = box.top + (14.5 if isinstance(box.score, Group) else LEAF_HEIGHT / 2 + 4)
    if not box.interval.duration:
        shapes.append(Text(box.title, right + 4, baseline))
    elif name := _shortened(box.title, right - left - 8):
        shapes.append(Text(name, left + 5, baseline))
    yield Told(_tip(box), tuple(shapes))
    for inner in box.inner:
        yield from _box(inner, axis, left, right)


def _kind(box: Box) -> str:
    match box.score:
        case Group():
            return "group"
        case Hold():
            return "hold"
        case Blank():
            return "blank"
        case Recorded():
            return "recorded"
        case Key():
            return "leaf"


def _tip(box: Box) -> str:
    interval = f"{float(box.interval.start):.3g}–{float(box.interval.end):.3g} s"
    return "\n".join([f"{box.title}  {interval}", *box.details])


def _rows(rows: Sequence[Row], axis: _Axis, top: float) -> Iterable[Shape]:
    """Draw the tracks of each part of the body; overlapping blocks one below the other."""
    if not rows:
        return
    yield Text("Tracks", axis.left, top - 10, "caption")
    for row in rows:
        yield Text(row.name, axis.left - 10, top + 14, "row")
        for lane in row.lanes:
            for bar in lane:
                yield _bar(row, bar, axis, top)
            top += LANE


def _bar(row: Row, bar: Bar, axis: _Axis, top: float) -> Shape:
    x1, x2 = axis.x(bar.start_s), axis.x(bar.end_s)
    long = max(x2 - x1, THINNEST)
    shapes: list[Shape] = [Rect("track", x1, top + 1, long, LANE - 4, 2)]
    if name := _shortened(bar.name, long - 12):
        shapes.append(Text(name, x1 + 5, top + 12, "small"))
    shapes += [
        Line("mark", axis.x(key), top + LANE - 9, axis.x(key), top + LANE - 3) for key in bar.keys_s
    ]
    moved = ", ".join(bar.coordinates)
    keys = " ".join(f"{key:.3g}" for key in bar.keys_s) or "none"
    where = " › ".join(bar.path) or bar.name
    tip = f"{row.name}: {where}  {bar.start_s:.3g}–{bar.end_s:.3g} s\nkeys: {keys}\n{moved}"
    return Told(tip, tuple(shapes))


def _keyframes(
    times: Sequence[Fraction], axis: _Axis, top: float, bottom: float
) -> Iterable[Shape]:
    """Draw numbered lines at the boundaries; where numbers would touch, leave out the later one."""
    free = 0.0
    for number, time in enumerate(times):
        x = axis.x(time)
        yield Line("key", x, top, x, bottom)
        half = width(str(number)) / 2
        if x - half >= free:
            yield Text(str(number), x, top - 3, "number")
            free = x + half


def _ticks(axis: _Axis) -> list[Fraction]:
    """Return round instants at least 44 px apart, from zero to the end."""
    steps = (Fraction(n) for n in ("1/10", "1/5", "1/2", "1", "2", "5", "10", "20", "60", "300"))
    step = next((s for s in steps if float(s) * axis.scale >= 44), Fraction(600))
    return [step * n for n in range(int(axis.end / step) + 1)]


def _grid(axis: _Axis, top: float, bottom: float) -> Iterable[Shape]:
    for time in _ticks(axis):
        x = axis.x(time)
        yield Line("grid", x, top, x, bottom)


def _time_line(axis: _Axis, y: float) -> Iterable[Shape]:
    yield Line("axis", axis.left, y, axis.x(axis.end), y)
    for time in _ticks(axis):
        x = axis.x(time)
        yield Line("axis", x, y, x, y + 5)
        yield Text(f"{float(time):g} s", x, y + 19, "tick")


def _legend(x: float, y: float, kinds: Container[str], tracks: bool) -> Iterable[Shape]:
    recorded = [("recorded", "a recorded sign")] if "recorded" in kinds else []
    of_tracks = [("track", "a block's own coordinates")] if tracks else []
    for kind, meaning in (*LEGEND, *recorded, *of_tracks):
        yield Rect(kind, x, y - 10, 16, 12, 2)
        yield Text(meaning, x + 22, y, "small")
        x += 22 + width(meaning) + 18


def _shortened(text: str, room: float) -> str:
    if width(text) <= room:
        return text
    kept = len(text)
    while kept and width(text[:kept]) + CHARACTER > room:
        kept -= 1
    return f"{text[:kept].rstrip()}…" if kept else ""
