"""Draws handshapes.png: every hand shape of HamNoSys that ships, with its variants, from two sides.

    python docs/rig/handshapes.py [OUT.png]

Each is solved on the signer from its rule, as in a sign, and it is told what it misses.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from azee.export.pictures.camera import Camera, camera
from azee.export.pictures.picture import contact_sheet, render
from azee.lang.program import evaluate_expression
from azee.score.score import Key, leaves
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver.geometry import Side
from azee_solver.solve import solve
from azee_solver.solve_report import SolveReport
from azee_solver.task import Task

HERE = Path(__file__).parent
SHOWN = json.loads((HERE / "postures.json").read_text(encoding="utf-8"))["show_hands"]

BENDS = ("bent", "round", "hooked", "dblbent", "dblhooked")
SHAPES: dict[str, tuple[str, ...]] = {
    "hamfist": ("", "'thumb = .thumb-over-index", "'thumb = .thumb-out"),
    "hamflathand": (
        "",
        "'thumb = .thumb-out",
        "'thumb = .thumb-across",
        *(f"'bend = :finger-{bend}" for bend in BENDS),
    ),
    "hamfinger2": (
        "",
        "'thumb = .thumb-out",
        *(f"'bend = :finger-{bend}" for bend in ("bent", "round", "hooked")),
    ),
    "hamfinger23": ("", "'thumb = .thumb-out", "'bend = :finger-bent", "'bend = :finger-hooked"),
    "hamfinger23spread": ("", "'thumb = .thumb-out", "'bend = :finger-hooked"),
    "hamfinger2345": (
        "",
        "'thumb = .thumb-out",
        *(f"'thumb = .thumb-out, 'bend = :finger-{bend}" for bend in ("bent", "round", "hooked")),
    ),
    "hampinch12": ("",),
    "hampinch12open": ("",),
    "hampinchall": ("",),
    "hamcee12": ("",),
    "hamcee12open": ("",),
    "hamceeall": ("",),
    "hand-of": (
        "'little = :finger-straight, 'thumb = .thumb-out",
        "'index = :finger-straight, 'little = :finger-straight, 'thumb = .thumb-over",
        "'index = :finger-straight, 'thumb = .thumb-out",
        "'little = :finger-straight",
    ),
}
"""The rules and the variants of each that are shown."""


def shapes() -> Iterator[str]:
    """Yield every shape as it is written where constraints stand."""
    for name, variants in SHAPES.items():
        for variant in variants:
            yield f":#{name}({variant})" if variant else f":#{name}"


def held_up(rig: Rig) -> NDArray[np.float64]:
    """Return idle with the right hand before the signer, (V,)."""
    q = np.array(rig.coordinates.idle)
    for name, degrees in SHOWN.items():
        q[rig.coordinates.index[name]] = np.radians(degrees)
    return np.clip(q, rig.coordinates.lower, rig.coordinates.upper)


def formed(rig: Rig, shape: str, side: Side = Side.RIGHT) -> SolveReport:
    """Solve a shape of the strong hand."""
    score = evaluate_expression(f"key(1, {shape})").score
    tasks = [
        Task(constraint, leaf.path, Fraction(0), rank)
        for leaf in leaves(score)
        if isinstance(leaf.score, Key)
        for rank, constraint in enumerate(leaf.score.constraints)
    ]
    q = held_up(rig)
    return solve(rig, tasks, dominant=side, start=q, reference=q)


def main(out: Path) -> None:
    """Write the sheet."""
    rig = load_rig()
    shown = []
    for shape in shapes():
        report = formed(rig, shape)
        for missed in (c for c in report.constraints if not c.met):
            print(f"{shape}: {missed.kind} misses by {missed.residual:.4f}: {missed.reason}")
        q = report.coordinates
        vertices = rig.skin(rig.pose(q))
        for number, side in enumerate(("palm", "thumb")):
            eye = camera(rig, q, f"right hand {side}")
            up = np.array([0.0, 0.015, 0.0])
            nearer = Camera(eye.eye + up, eye.target + up, 0.85 * eye.height_rad)
            title = _title(shape) if number == 0 else ""
            shown.append((title, render(vertices, rig.mesh, nearer, (150, 150))))
    pairs = [
        (shown[i][0], _side_by_side(shown[i][1], shown[i + 1][1])) for i in range(0, len(shown), 2)
    ]
    sheet = contact_sheet(pairs, 5)
    sheet.quantize(256, method=Image.Quantize.MAXCOVERAGE, kmeans=1).save(out, optimize=True)


def _title(shape: str) -> str:
    """Shorten a shape to its symbol and the words that vary it."""
    words = re.sub(r"'(?:thumb|bend) = |[.:](?:thumb|finger)-|[():#=',]", " ", shape)
    return " ".join(words.split())


def _side_by_side(left: Image.Image, right: Image.Image) -> Image.Image:
    both = Image.new("RGB", (left.width + right.width, left.height))
    both.paste(left, (0, 0))
    both.paste(right, (left.width, 0))
    return both


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "handshapes.png")
