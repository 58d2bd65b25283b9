"""Compares tracks with flattening on every example: `python docs/motion_table.py`.

Writes the table of docs/motion.md anew, between its two markers; with --print only prints it.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from pathlib import Path

import azee
from azee.compilation import Compilation
from azee.motion.tasks.key_selection import MODES, Mode

HERE = Path(__file__).parent
PAGE = HERE / "motion.md"
BEGIN, END = "<!-- table: python docs/motion_table.py -->", "<!-- end of the table -->"
FPS = 60.0
SHOWS_M = 0.003
"""Deeper penetration is reported."""
HEAD = (
    "| example | mode | keys | solved | every frame | missed | speed °/s | acceleration °/s² "
    "| jerk °/s³ | penetration mm |"
)


def rows() -> Iterator[str]:
    """Yield a line of the table for every example and mode."""
    yield HEAD
    yield "|" + "---|" * (HEAD.count("|") - 1)
    for source in sorted(HERE.parent.glob("examples/*/*.azee")):
        for mode in MODES:
            yield _row(source.stem, mode, azee.compile(source, mode=mode, fps=FPS, life=False))


def _row(name: str, mode: Mode, made: Compilation) -> str:
    report = made.report
    fastest = max(report.peaks, key=lambda p: p.speed)
    keys = [p for p in report.postures if not p.reused]
    depth = max(
        (
            p.depth_m
            for p in report.clip_penetration
            if not p.intended and p.depth_m > SHOWS_M
        ),
        default=0.0,
    )
    cells = (
        name,
        mode,
        len(report.postures),
        len(keys),
        math.floor(report.score_s * FPS) + 1,
        f"{sum(not c.met for c in report.constraints)} of {len(report.constraints)}",
        f"{math.degrees(fastest.speed):.0f} {fastest.coordinate}",
        f"{math.degrees(max(p.acceleration for p in report.peaks)):,.0f}",
        f"{math.degrees(max(p.jerk for p in report.peaks)):,.0f}",
        f"{1e3 * depth:.0f}" if depth else "none",
    )
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def main() -> None:
    """Print the table, or put it into the page."""
    table = "\n".join(rows())
    if "--print" in sys.argv[1:]:
        print(table)
        return
    page = PAGE.read_text(encoding="utf-8")
    before, after = page.split(BEGIN)[0], page.split(END)[1]
    PAGE.write_text(f"{before}{BEGIN}\n\n{table}\n\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
