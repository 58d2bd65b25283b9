"""A score drawn as SVG: nested above, flattened below, over one time axis in seconds.

After figures 1 and 2 of Nunnari, Filhol & Heloir 2018: boxes on a time line, levels inside each
other, grey where the recursion ends in constraints. Every box shows its constraints as a tooltip.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from xml.sax.saxutils import escape

from azee.export.files import replace_file
from azee.export.score_layout import GAP, LEAF_HEIGHT, Box, boundaries, flattened, nested
from azee.score.score import Blank, Group, Hold, Score

MARGIN = 28.0
INSET = 2.5
"""How much narrower a box is than the box around it, so that edges of one instant stay apart."""
CHARACTER = 7.4
NARROW, WIDE = 4.2, 9.4
"""Widths of most characters, of narrow ones and of capitals at 12 px, in a wide font."""
CAPTION = 26.0
THINNEST = 4.0
"""Width of a box that has no length."""
NARROWEST, WIDEST = 110.0, 420.0
"""Pixels a second: as many as the names need, within these."""
WIDEST_PICTURE = 1600.0
"""Up to which the picture grows for the sake of names, in pixels."""
NARROWEST_PICTURE = 560.0
"""What the legend needs, in pixels."""

STYLE = """
text { font: 12px system-ui, "Segoe UI", "Helvetica Neue", Arial, sans-serif; fill: #222 }
.caption { font-weight: 600 }
.small { font-size: 11px; fill: #555 }
.tick { font-size: 11px; text-anchor: middle }
.number { font-size: 11px; text-anchor: middle; fill: #b03a2e }
.group { stroke: #444 }
.leaf { stroke: #555; fill: #d3d3d3 }
.hold { stroke: #555; fill: url(#stripes) }
.blank { stroke: #888; fill: #fff; stroke-dasharray: 3 3 }
.grid { stroke: #e3e3e3 }
.axis { stroke: #222 }
.key { stroke: #b03a2e; stroke-dasharray: 2 3 }
""".strip()
STRIPES = (
    '<pattern id="stripes" width="6" height="6" patternUnits="userSpaceOnUse" '
    'patternTransform="rotate(45)"><rect width="6" height="6" fill="#eee"/>'
    '<rect width="2" height="6" fill="#bbb"/></pattern>'
)
SHADES = ("#ffffff", "#f4f7fb")


@dataclass(frozen=True, slots=True)
class _Axis:
    """Where an instant lies, in pixels."""

    scale: float
    end: Fraction

    def x(self, time: Fraction) -> float:
        return MARGIN + float(time) * self.scale


def write_svg(score: Score, path: str | Path) -> None:
    """Draw a score into a file.

    Raises: OSError: the file cannot be written.
    """
    with replace_file(path) as file:
        file.write(draw(score).encode())


def draw(score: Score) -> str:
    """Return a whole SVG document: the nested score, the flattened one, and the time axis."""
    whole = nested(score, top=CAPTION)
    leaves_top = whole.top + whole.height + 2 * CAPTION
    leaf_boxes = flattened(score, top=leaves_top)
    bottom = max(box.top + box.height for box in leaf_boxes) + GAP
    axis = _Axis(_scale([*whole.all(), *leaf_boxes], score.duration), score.duration)
    edges = MARGIN - INSET, axis.x(axis.end) + INSET
    width = max(axis.x(axis.end) + MARGIN, NARROWEST_PICTURE)
    height = bottom + 66.0
    size = f"{width:.0f} {height:.0f}"
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size}" width="{width:.0f}">',
        f"<title>{_text(whole.title)}</title>",
        f"<defs>{STRIPES}</defs><style>{STYLE}</style>",
        '<rect width="100%" height="100%" fill="#fff"/>',
        *_grid(axis, whole.top, bottom),
        _label("Score", MARGIN, 16, "caption"),
        *_box(whole, axis, *edges),
        _label("Flattened", MARGIN, leaves_top - 26, "caption"),
        *_keyframes(boundaries(score), axis, leaves_top - 8, bottom),
        *(line for box in leaf_boxes for line in _box(box, axis, *edges)),
        *_time_line(axis, bottom),
        *_legend(bottom + 50),
        "</svg>",
    ]
    return "\n".join(parts) + "\n"


def _scale(boxes: Iterable[Box], duration: Fraction) -> float:
    """Pixels a second that let every name stand in its box, if that is not too many."""
    needed = [
        (_width(box.title) + 2 * INSET * (box.depth + 2)) / float(box.interval.duration)
        for box in boxes
        if box.interval.duration
    ]
    most = min(WIDEST, WIDEST_PICTURE / float(duration)) if duration else WIDEST
    return max(NARROWEST, min(max([0.0, *needed]), most))


def _box(box: Box, axis: _Axis, low: float, high: float) -> Iterable[str]:
    """Draw a box and what is inside, between the edges of the box around it."""
    low, high = low + INSET, high - INSET
    left, right = max(axis.x(box.interval.start), low), min(axis.x(box.interval.end), high)
    if right - left < THINNEST:
        left = min(max((left + right - THINNEST) / 2, low), high - THINNEST)
        right = left + THINNEST
    kind, fill = _kind(box)
    yield f"<g><title>{_text(_tooltip(box))}</title>"
    yield (
        f'<rect class="{kind}"{fill} x="{left:.1f}" y="{box.top:.1f}" '
        f'width="{right - left:.1f}" height="{box.height:.1f}" rx="3"/>'
    )
    baseline = box.top + (14.5 if isinstance(box.score, Group) else LEAF_HEIGHT / 2 + 4)
    if not box.interval.duration:
        yield _label(box.title, right + 4, baseline)
    elif name := _shortened(box.title, right - left - 8):
        yield _label(name, left + 5, baseline)
    yield "</g>"
    for inner in box.inner:
        yield from _box(inner, axis, left, right)


def _kind(box: Box) -> tuple[str, str]:
    """Return the class of a box, and the fill of a group, which alternates with depth."""
    match box.score:
        case Group():
            return "group", f' fill="{SHADES[box.depth % 2]}"'
        case Hold():
            return "hold", ""
        case Blank():
            return "blank", ""
        case _:
            return "leaf", ""


def _tooltip(box: Box) -> str:
    interval = f"{float(box.interval.start):.3g}–{float(box.interval.end):.3g} s"
    return "\n".join([f"{box.title}  {interval}", *box.details])


def _keyframes(times: Sequence[Fraction], axis: _Axis, top: float, bottom: float) -> Iterable[str]:
    """Numbered lines at the boundaries; where numbers would touch, the later one is left out."""
    free = 0.0
    for number, time in enumerate(times):
        x = axis.x(time)
        yield f'<line class="key" x1="{x:.1f}" y1="{top:.1f}" x2="{x:.1f}" y2="{bottom:.1f}"/>'
        half = _width(str(number)) / 2
        if x - half >= free:
            yield _label(str(number), x, top - 3, "number")
            free = x + half


def _ticks(axis: _Axis) -> list[Fraction]:
    """Return round instants at least 44 px apart, from zero to the end."""
    steps = (Fraction(n) for n in ("1/10", "1/5", "1/2", "1", "2", "5", "10", "20", "60", "300"))
    step = next((s for s in steps if float(s) * axis.scale >= 44), Fraction(600))
    return [step * n for n in range(int(axis.end / step) + 1)]


def _grid(axis: _Axis, top: float, bottom: float) -> Iterable[str]:
    for time in _ticks(axis):
        x = axis.x(time)
        yield f'<line class="grid" x1="{x:.1f}" y1="{top:.1f}" x2="{x:.1f}" y2="{bottom:.1f}"/>'


def _time_line(axis: _Axis, y: float) -> Iterable[str]:
    end = axis.x(axis.end)
    yield f'<line class="axis" x1="{MARGIN}" y1="{y:.1f}" x2="{end:.1f}" y2="{y:.1f}"/>'
    for time in _ticks(axis):
        x = axis.x(time)
        yield f'<line class="axis" x1="{x:.1f}" y1="{y:.1f}" x2="{x:.1f}" y2="{y + 5:.1f}"/>'
        yield _label(f"{float(time):g} s", x, y + 19, "tick")


def _legend(y: float) -> Iterable[str]:
    x = MARGIN
    for kind, meaning in (
        ("leaf", "constraints"),
        ("hold", "what another block reached, held"),
        ("blank", "nothing asked for"),
    ):
        yield f'<rect class="{kind}" x="{x:.1f}" y="{y - 10:.1f}" width="16" height="12" rx="2"/>'
        yield _label(meaning, x + 22, y, "small")
        x += 22 + _width(meaning) + 18


def _shortened(text: str, room: float) -> str:
    if _width(text) <= room:
        return text
    kept = len(text)
    while kept and _width(text[:kept]) + CHARACTER > room:
        kept -= 1
    return f"{text[:kept].rstrip()}…" if kept else ""


def _width(text: str) -> float:
    return sum(
        WIDE if c.isupper() else NARROW if c in " .,:;'|!ijlt·()[]" else CHARACTER for c in text
    )


def _label(text: str, x: float, y: float, kind: str = "") -> str:
    named = f' class="{kind}"' if kind else ""
    return f'<text{named} x="{x:.1f}" y="{y:.1f}">{_text(text)}</text>'


def _text(text: str) -> str:
    """Escape for XML, and drop the control characters that XML cannot hold."""
    return escape("".join(c for c in text if c >= " " or c in "\n\t"))
