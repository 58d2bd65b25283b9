"""Draws the pictures of repl.md: types its session into a pseudo-terminal and keeps the screen.

The screen becomes an SVG of text, which stays small and sharp; the posture is the one that the
session renders.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path
from xml.sax.saxutils import escape

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "tests" / "repl"))

from terminal import COLUMNS, Terminal  # type: ignore[import-not-found]  # noqa: E402

PICTURES = HERE / "pictures"
CELL = 8.4, 18.0
"""Width and height of a character, pixels at 14 px."""
GROUND, INK = "#1b1f24", "#dfe3e8"
NAMED = {
    "black": "#30363d", "red": "#ff7b72", "green": "#7ee787", "brown": "#e3b341",
    "blue": "#79c0ff", "magenta": "#d2a8ff", "cyan": "#56d4dd", "white": "#c9d1d9",
    "brightblack": "#8b949e", "brightred": "#ffa198",
}  # fmt: skip
"""Colours by the terminal's names."""

RULE = """def phone
    'meaning "telephone"
    'source "mine"
    key .6
        cstr
            :#fingers('index = 1, 'middle = 1, 'ring = 1)
            :#thumb('spread = 1)
            place @T_PAD(s) @EAR(s) 'dist .02
            orient 'nrm !palm(s) 'along in(s)
            orient 'dir !palm(s) 'along vsum(^fwd, ^up)
"""


def main() -> None:
    """Draw them."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "mine.azee").write_text(RULE, encoding="utf-8")
        with Terminal(folder, "--no-history", "mine.azee") as terminal:
            terminal.wait("azee>")
            terminal.type(":info-about 'topic :pho")
            terminal.wait("telephone")
            terminal.press("tab")
            terminal.type(" 'info :bien\n")
            terminal.wait("solved in")
            terminal.type(":phone\n")
            terminal.wait("0.6 s, 1 block")
            terminal.wait(lambda text: text.count("solved in") == 2)
            terminal.type("/render phone.png .3 three-quarter\n")
            terminal.wait("wrote phone.png")
            terminal.type("morph 'sm")
            terminal.wait("mile")
            (PICTURES / "repl-session.svg").write_text(_svg(terminal), encoding="utf-8")
        _keep(folder / "phone.png", PICTURES / "repl-phone.png")


def _svg(terminal: Terminal) -> str:
    rows = len(terminal.text.splitlines())
    wide, high = CELL
    width, height = COLUMNS * wide + 24, rows * high + 24
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
        f'width="{width:.0f}" font-family="ui-monospace, Menlo, Consolas, monospace" '
        f'font-size="14" fill="{INK}">'
    )
    lines = [head, f'<rect width="100%" height="100%" rx="8" fill="{GROUND}"/>']
    for row in range(rows):
        lines += _row(terminal, row)
    return "\n".join([*lines, "</svg>"]) + "\n"


def _row(terminal: Terminal, row: int) -> Iterator[str]:
    wide, high = CELL
    cells = [terminal.screen.buffer[row][x] for x in range(COLUMNS)]
    looks = [_look(cell) for cell in cells]
    y = 12 + row * high
    for (ink, ground, bold), run in groupby(range(COLUMNS), key=looks.__getitem__):
        places = list(run)
        x = 12 + places[0] * wide
        text = "".join(cells[i].data for i in places)
        if ground != GROUND:
            size = f'width="{len(places) * wide:.1f}" height="{high}"'
            yield f'<rect x="{x:.1f}" y="{y:.1f}" {size} fill="{ground}"/>'
        if text.strip():
            weight = ' font-weight="600"' if bold else ""
            yield (
                f'<text x="{x:.1f}" y="{y + 13.5:.1f}" fill="{ink}"{weight} xml:space="preserve" '
                f'textLength="{len(text) * wide:.1f}">{escape(text)}</text>'
            )


def _look(cell: object) -> tuple[str, str, bool]:
    fg, bg = (getattr(cell, name) for name in ("fg", "bg"))
    ink, ground = _colour(fg, INK), _colour(bg, GROUND)
    if getattr(cell, "reverse"):  # noqa: B009 - pyte has no types
        ink, ground = ground, ink
    return ink, ground, bool(getattr(cell, "bold"))  # noqa: B009


def _colour(name: str, default: str) -> str:
    if name == "default":
        return default
    return NAMED.get(name, f"#{name}")


def _keep(drawn: Path, kept: Path) -> None:
    from PIL import Image

    image = Image.open(drawn).convert("RGB").resize((480, 600))
    image.quantize(128, kmeans=1).save(kept, optimize=True)


if __name__ == "__main__":
    main()
