"""The drawing of a score as SVG."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from xml.sax.saxutils import escape

from azee.export.files import replace_file
from azee.export.pictures.score_drawing import score_drawing
from azee.export.pictures.shapes import Line, Rect, Shape, Text, Told
from azee.export.track_rows import Row
from azee.score.score import Score

STYLE = """
text { font: 12px system-ui, "Segoe UI", "Helvetica Neue", Arial, sans-serif; fill: #222 }
.caption { font-weight: 600 }
.small { font-size: 11px; fill: #555 }
.row { font-size: 11px; text-anchor: end }
.tick { font-size: 11px; text-anchor: middle }
.number { font-size: 11px; text-anchor: middle; fill: #b03a2e }
.group { stroke: #444 }
.leaf { stroke: #555; fill: #d3d3d3 }
.hold { stroke: #555; fill: url(#stripes) }
.blank { stroke: #888; fill: #fff; stroke-dasharray: 3 3 }
.recorded { stroke: #8a5a14; fill: #f3dfc1 }
.track { stroke: #5b7fa6; fill: #d9e5f2 }
.mark { stroke: #1f4e86; stroke-width: 2 }
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
"""Fills of groups, which alternate with depth."""


def write_svg(score: Score, path: str | Path, rows: Sequence[Row] = ()) -> None:
    """Draw a score, and rows of tracks, into a file.

    Raises: OSError: the file cannot be written.
    """
    with replace_file(path) as file:
        file.write(draw(score, rows).encode())


def draw(score: Score, rows: Sequence[Row] = ()) -> str:
    """Return a whole SVG document."""
    drawing = score_drawing(score, rows)
    size = f"{drawing.width:.0f} {drawing.height:.0f}"
    head = f'viewBox="0 0 {size}" width="{drawing.width:.0f}"'
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {head}>',
        f"<title>{_text(drawing.title)}</title>",
        f"<defs>{STRIPES}</defs><style>{STYLE}</style>",
        '<rect width="100%" height="100%" fill="#fff"/>',
        *(line for shape in drawing.shapes for line in _lines(shape)),
        "</svg>",
    ]
    return "\n".join(parts) + "\n"


def _lines(shape: Shape) -> Iterable[str]:
    match shape:
        case Rect(kind, x, y, width, height, radius, shade):
            fill = f' fill="{SHADES[shade]}"' if kind == "group" else ""
            yield (
                f'<rect class="{kind}"{fill} x="{x:.1f}" y="{y:.1f}" '
                f'width="{width:.1f}" height="{height:.1f}" rx="{radius:g}"/>'
            )
        case Line(kind, x1, y1, x2, y2):
            yield f'<line class="{kind}" x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}"/>'
        case Text(text, x, y, kind):
            named = f' class="{kind}"' if kind else ""
            yield f'<text{named} x="{x:.1f}" y="{y:.1f}">{_text(text)}</text>'
        case Told(tip, shapes):
            yield f"<g><title>{_text(tip)}</title>"
            for inner in shapes:
                yield from _lines(inner)
            yield "</g>"


def _text(text: str) -> str:
    """Escape for XML, and drop the control characters that XML cannot hold."""
    return escape("".join(c for c in text if c >= " " or c in "\n\t"))
