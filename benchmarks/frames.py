"""Checks every constraint in every frame: all examples and rules, at 30 and 60 frames/s.

`python benchmarks/run.py frames [-o FILE.json] [NAME …]`. The benchmark compiles each text and
reads its report: constraints that are missed in some frame of their block, with the reason;
coordinates beyond their limits; penetration of the posed skin in any frame where no contact is
meant; the speed of joints. It prints only conspicuous rows and the sums.
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from azee.compilation import perform
from azee.quality.motion_report import MotionReport
from azee_rig.load import load_rig
from benchmarks.penetration import TOLERATED_M, scores

RATES = (30.0, 60.0)
SHOWN_DEG_S = 1500.0
"""Faster turns are printed."""


@dataclass(frozen=True, slots=True)
class Row:
    """What one score did at one rate."""

    sign: str
    fps: float
    constraints: int
    missed: tuple[str, ...]
    untold: int
    excess_rad: float
    entered: tuple[str, ...]
    fastest_deg_s: float
    fastest: str

    def __str__(self) -> str:
        parts = [*self.missed, *self.entered]
        if self.excess_rad > 0.0:
            parts.append(f"{math.degrees(self.excess_rad):.1g}° beyond limits")
        if self.fastest_deg_s > SHOWN_DEG_S:
            parts.append(f"{self.fastest} turns at {self.fastest_deg_s:.0f} °/s")
        return f"{self.sign}, {self.fps:.0f} frames/s: {'; '.join(parts)}" if parts else ""


def row(sign: str, fps: float, report: MotionReport) -> Row:
    """Read a report."""
    missed = [c for c in report.constraints if not c.met]
    deep = {
        (" in ".join(p.pair), round(1e3 * p.depth_m))
        for p in report.clip_penetration
        if not p.intended and p.depth_m > TOLERATED_M
    }
    fastest = max(report.peaks, key=lambda p: p.speed)
    return Row(
        sign,
        fps,
        len(report.constraints),
        tuple(f"{c.subject} by {c.residual:.3g}: {c.reason or 'no reason'}" for c in missed),
        sum(not c.reason for c in missed),
        report.max_excess_rad,
        tuple(f"{pair}, {depth} mm" for pair, depth in sorted(deep)),
        math.degrees(fastest.speed),
        fastest.coordinate,
    )


def rows(names: list[str]) -> Iterator[Row]:
    """Yield a row for every score and rate."""
    rig = load_rig()
    for sign, score in scores(names):
        for fps in RATES:
            yield row(sign, fps, perform(score, rig, fps=fps, life=False).report)


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the conspicuous rows and the sums."""
    parser = argparse.ArgumentParser(prog="frames", description=__doc__)
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help="examples or rules; by default all"
    )
    parser.add_argument("-o", "--out", type=Path, metavar="FILE.json")
    options = parser.parse_args(arguments)
    found = []
    for one in rows(options.names):
        found.append(one)
        if text := str(one):
            print(text, flush=True)
    print(
        f"{len(found)} clips, {sum(r.constraints for r in found)} constraints: "
        f"{sum(len(r.missed) for r in found)} missed, {sum(r.untold for r in found)} of them "
        f"without a reason; {sum(r.excess_rad > 0 for r in found)} clips beyond limits; "
        f"{sum(bool(r.entered) for r in found)} with skin deeper than "
        f"{1e3 * TOLERATED_M:.0f} mm in the body where no touch is meant"
    )
    if options.out:
        options.out.write_text(json.dumps([asdict(r) for r in found], indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
