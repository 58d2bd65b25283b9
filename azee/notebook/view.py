"""A moving body as HTML that needs no network: the file, its player, a still picture."""

from __future__ import annotations

import base64
import html
import io
import tempfile
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from azee.clip.clip import Clip
    from azee_rig.rig import Rig

SIZE = (560, 480)
_STILL = (140, 175)
_MOST = 6
"""Number of postures in the still picture."""

_PAGE = """<!doctype html><html><head><meta charset="utf-8"><style>
body {{ margin: 0; font: 13px system-ui, sans-serif }}
#stage {{ width: {width}px }}
canvas {{ width: {width}px; height: {height}px; cursor: grab; touch-action: none; display: block }}
#bar {{ display: flex; gap: 8px; align-items: center; padding: 4px 0 }}
input {{ flex: 1 }} button {{ width: 3em }} output {{ width: 4.5em; text-align: right }}
</style></head><body><div id="stage"><canvas width="{wide}" height="{high}"></canvas>
<div id="bar"><button></button><input type="range" min="0" step="0.01" value="0">
<output></output></div></div>
<img id="still" hidden src="data:image/png;base64,{still}">
<script>{script}
const stage = document.getElementById('stage');
let played = false;
try {{ played = play(stage, "{data}"); }} catch (error) {{ console.error(error); }}
if (!played) {{ stage.hidden = true; document.getElementById('still').hidden = false; }}
</script></body></html>"""


def page(clip: Clip, rig: Rig, moments: Sequence[float]) -> str:
    """Return a document that plays a clip, or shows a picture if it cannot.

    Args: moments: seconds on the clip's time line that the picture shows.
    """
    width, height = SIZE
    return _PAGE.format(
        width=width,
        height=height,
        wide=2 * width,
        high=2 * height,
        script=_script(),
        still=_encoded(still(clip, rig, moments)),
        data=_encoded(_glb(clip, rig)),
    )


def framed(document: str) -> str:
    """Return a document as a frame of its own, which cannot access the notebook around it."""
    width, height = SIZE
    return (
        f'<iframe sandbox="allow-scripts" width="{width + 10}" height="{height + 45}" '
        f'style="border: 0" srcdoc="{html.escape(document)}"></iframe>'
    )


def still(clip: Clip, rig: Rig, moments: Sequence[float]) -> bytes:
    """Return a strip of the most informative postures of a clip, PNG."""
    from azee.export.pictures.picture import contact_sheet, picture
    from azee.export.pictures.storyboard import telling_frames

    pictures = []
    for frame in telling_frames(clip, moments, _MOST):
        weights = dict(zip(clip.units, clip.unit_weights[frame], strict=True))
        drawn = picture(rig, clip.coordinates[frame], "front", weights, _STILL)
        pictures.append((f"{clip.times[frame]:.2f} s", drawn))
    data = io.BytesIO()
    contact_sheet(pictures).save(data, "PNG", optimize=True)
    return data.getvalue()


def _glb(clip: Clip, rig: Rig) -> bytes:
    from azee.export.formats.glb import write_glb

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "clip.glb"
        write_glb(clip, rig, path)
        return path.read_bytes()


def _encoded(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")


@cache
def _script() -> str:
    return (Path(__file__).parent / "viewer.js").read_text(encoding="utf-8")
