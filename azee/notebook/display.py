"""What each kind of object shows in a notebook: data by MIME type.

A notebook that is not trusted drops scripts and frames and shows pictures and tables only.
"""

from __future__ import annotations

import base64
import io
from collections.abc import Iterable
from html import escape
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from azee.animation import Animation
    from azee.clip.clip import Clip
    from azee.compilation import Compilation
    from azee.quality.motion_report import MotionReport
    from azee.score.score import Score
    from azee_rig.rig import Rig

Bundle = dict[str, str | bytes]

_PORTRAIT = (300, 375)
_STYLE = "text-align: left; padding: 1px 10px; white-space: nowrap"


def score(shown: Score) -> Bundle:
    """Show a score as `azee score` draws it."""
    from azee.export.pictures.score_svg import draw
    from azee.export.score_text import tree

    return {"image/svg+xml": draw(shown), "text/plain": tree(shown)}


def compilation(made: Compilation) -> Bundle:
    """Show the score, the moving body, and the table of constraints."""
    from azee.export.pictures.score_svg import draw

    moving = _moving(made.clip, made.rig, made.animation.key_times)
    drawing = f'<div style="overflow-x: auto">{draw(made.score)}</div>'
    parts = (drawing, moving, _table(made.report))
    return {"text/html": "\n".join(parts), "text/plain": _summary(made.report)}


def animation(made: Animation) -> Bundle:
    """Show the table of constraints; the clip is shown with its body."""
    return report(made.report)


def clip(shown: Clip) -> Bundle:
    """Show a clip on the shipped body if it was made for that, otherwise its labels."""
    from azee_rig.load import load_rig

    facts = f"a clip of {shown.duration_s:.2f} s, {len(shown.times)} frames"
    rig = load_rig()
    rows = _rows(
        ("label", "from", "to"),
        ((f"{' ' * 3 * x.depth}{x.text}", f"{x.start_s:.2f} s", f"{x.end_s:.2f} s")
         for x in shown.labels),
    )  # fmt: skip
    html = f"<p>{facts}</p>{rows}"
    if shown.coordinates.shape[1] == len(rig.coordinates):
        moments = [float(t) for t in shown.times[:: max(1, len(shown.times) // 24)]]
        html = f"{_moving(shown, rig, moments)}{html}"
    return {"text/html": html, "text/plain": facts}


def report(shown: MotionReport) -> Bundle:
    """Show every constraint with its residual."""
    return {"text/html": _table(shown), "text/plain": _summary(shown)}


def rig(shown: Rig) -> Bundle:
    """Show a body in its idle posture, and what it has."""
    from azee.export.pictures.picture import picture

    data = io.BytesIO()
    picture(shown, shown.coordinates.idle, "front", size=_PORTRAIT).save(data, "PNG")
    facts = (
        ("bones", len(shown.bones)),
        ("sites", len(shown.sites)),
        ("coordinates", len(shown.coordinates)),
        ("morphs of the face", len(shown.face_morphs)),
        ("triangles", len(shown.mesh.triangles)),
    )
    text = f"the body `{shown.name}`: {', '.join(f'{n} {what}' for what, n in facts)}"
    rows = _rows((shown.name, ""), ((what, str(count)) for what, count in facts))
    html = f"<div>{_image(data.getvalue())}{rows}</div>"
    return {"text/html": html, "text/plain": text}


def _moving(shown: Clip, body: Rig, moments: Iterable[float]) -> str:
    """Return a player, with a picture for notebooks where players are not allowed."""
    from azee.notebook.view import framed, page, still

    moments = tuple(moments)
    picture = _image(still(shown, body, moments))
    folded = f"<details><summary>key postures</summary>{picture}</details>"
    return f"{framed(page(shown, body, moments))}{folded}"


def _table(shown: MotionReport) -> str:
    from azee.quality.outcome import amount

    rows = (
        (
            f"{r.start_s:.2f}–{r.end_s:.2f} s",
            "/".join(r.path),
            r.text,
            amount(r.residual, r.unit),
            amount(r.tolerance, r.unit),
            "met" if r.met else r.reason or f"eased: meeting it would take {r.price}",
        )
        for r in sorted(shown.constraints, key=lambda r: (r.met, r.start_s, r.path))
    )
    table = _rows(("time", "block", "constraint", "off by", "tolerance", ""), rows)
    summary = escape(_summary(shown))
    return f"<details><summary>{summary}</summary>{table}</details>"


def _summary(shown: MotionReport) -> str:
    from azee.quality.outcome import outcome
    from azee.wording import counted

    keys = counted(len(shown.postures), "key posture")
    return f"{shown.duration_s:.2f} s on `{shown.rig}`, {keys}, {outcome(shown)}"


def _rows(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    def row(cells: Iterable[str], tag: str) -> str:
        inside = "".join(f'<{tag} style="{_STYLE}">{escape(cell)}</{tag}>' for cell in cells)
        return f"<tr>{inside}</tr>"

    return f"<table>{row(head, 'th')}{''.join(row(cells, 'td') for cells in rows)}</table>"


def _image(png: bytes) -> str:
    return f'<img src="data:image/png;base64,{base64.b64encode(png).decode("ascii")}">'
