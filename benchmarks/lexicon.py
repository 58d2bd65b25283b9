"""How well imported signs are what their notation says: `benchmarks/run.py lexicon --sample 40`.

Signs of a file or an archive of SiGML are written as rules, checked and compiled. Where fingers
point, where the palm looks, where the hand is and what it touches are computed from the notation
by `lexicon_notation.py`, which knows nothing of the converter, and compared with the body at the
start and at the end of the sign.
"""

from __future__ import annotations

import argparse
import json
import time
import zipfile
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

import numpy as np
from numpy.typing import NDArray

import azee
from azee.compilation import Hand
from azee.lexicon.reading import read_bytes
from azee.lexicon.rule_text import rule_text
from azee.lexicon.sample import sample_of
from azee_grammar.diagnostic import AZeeError
from azee_rig.chain import DIR, NRM
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver.outcome import Outcome
from benchmarks.lexicon_notation import Hand as SaidHand
from benchmarks.lexicon_notation import Posture, Reader
from benchmarks.lexicon_touch import gap_m
from benchmarks.likeness_figures import FIGURES

Array = NDArray[np.float64]
ARCHIVE = Path(__file__).parents[1] / "lexicons/ngt/azee_ngt/ngt.zip"
INSIDE_S = 0.05
"""How far inside a sign its first and last postures are looked at."""
ANGLE_DEGREES, PLACE_M, TOUCH_M, GAP_M = 25.0, 0.03, 0.012, 0.001
TRUNK_DEGREES = 10.0
OVERLAP_M = 0.003


@dataclass
class Figures:
    """Measured values by what they are of, with the signs that they are from."""

    values: dict[str, list[tuple[float, str]]] = field(default_factory=lambda: defaultdict(list))
    outcomes: Counter[str] = field(default_factory=Counter)
    reasons: Counter[str] = field(default_factory=Counter)
    seconds: list[float] = field(default_factory=list)
    failed: list[str] = field(default_factory=list)
    whole: int = 0

    def add(self, what: str, value: float, sign: str) -> None:
        """Note a value."""
        self.values[what].append((value, sign))


BOUNDS = {
    "fingers at the start, degrees": ANGLE_DEGREES,
    "palm at the start, degrees": ANGLE_DEGREES,
    "fingers at the end, degrees": ANGLE_DEGREES,
    "palm at the end, degrees": ANGLE_DEGREES,
    "place at the start, m": PLACE_M,
    "touch at the start, m": TOUCH_M,
    "gap of touching skins, m": GAP_M,
    "trunk, degrees": TRUNK_DEGREES,
    "overlap of the body's skin, m": OVERLAP_M,
    "overlap of one hand's fingers, m": OVERLAP_M,
}
LIKENESS = {
    f"{figure.title}, {figure.unit}": figure
    for figure in FIGURES
    if figure.title in ("wrist between signs", "its acceleration", "arm joints")
}
"""Figures of likeness of which one sign has a value without life."""
BOUNDS |= {what: figure.at_most for what, figure in LIKENESS.items() if figure.at_most}
OVERLAP, FINGERS = "overlap of the body's skin, m", "overlap of one hand's fingers, m"


def signs_of(archive: Path) -> dict[str, bytes]:
    """Return the texts of the signs of an archive by name."""
    with zipfile.ZipFile(archive) as files:
        return {
            PurePosixPath(name).stem: files.read(name)
            for name in files.namelist()
            if name.endswith(".sigml")
        }


def measure(
    name: str,
    text: bytes,
    rig: Rig,
    figures: Figures,
    dominant: Hand = "right",
    *,
    overlap: bool = True,
) -> None:
    """Compile one sign and compare it with its notation. overlap: also measure that of its skin."""
    found = next(read_bytes(text, f"{name}.sigml"))
    if found.sign is None:
        figures.failed.append(name)
        return
    rule = rule_text(found.sign, "sign", "benchmark").text
    began = time.process_time()
    try:
        done = azee.compile(f"{rule}\n:sign\n", rig, life=False, dominant=dominant)
    except AZeeError as problem:
        figures.failed.append(f"{name}: {problem}")
        return
    figures.seconds.append(time.process_time() - began)
    report = done.report
    outcomes = Counter(c.outcome for c in report.constraints)
    figures.outcomes.update(o.value for c in report.constraints for o in (c.outcome,))
    figures.whole += outcomes[Outcome.MISSED] == 0
    for constraint in report.constraints:
        if constraint.outcome is Outcome.MISSED:
            figures.reasons[f"{constraint.kind}: {_kind(constraint.reason)}"] += 1
            figures.add("missed", 1, name)
    if overlap:
        measured = {OVERLAP: report.clip_penetration, FINGERS: report.self_contact}
        for what, overlaps in measured.items():
            unmeant = [p.depth_m for p in overlaps if not p.intended]
            figures.add(what, max(unmeant, default=0.0), name)
    figures.add("trunk, degrees", _trunk(done), name)
    for what, figure in LIKENESS.items():
        figures.add(what, max(figure.read(report.likeness), default=0.0), name)
    reader = Reader(text)
    if not reader.is_simple:
        return
    whole = [row for row in report.blocks if "'HANDS'" in str(row["path"])] or report.blocks
    start_s = min(float(str(row["start_s"])) for row in whole) + INSIDE_S
    end_s = max(float(str(row["end_s"])) for row in whole) - INSIDE_S
    start, end = reader.start(), reader.end()
    if dominant == "left":
        start, end = start.mirrored(), end and end.mirrored()
    _compare(done, start, start_s, "start", name, figures)
    if end is not None:
        _compare(done, end, end_s, "end", name, figures)


def _kind(reason: str | None) -> str:
    return (reason or "no reason").split(":")[0].split(",")[0]


def _trunk(done: azee.Compilation) -> float:
    """Return the largest turn of any joint of the trunk, in degrees."""
    names = done.rig.coordinates.names
    trunk = [i for i, name in enumerate(names) if name.startswith("back_")]
    return float(np.degrees(np.abs(done.clip.coordinates[:, trunk]).max()))


def _compare(
    done: azee.Compilation, said: Posture, time_s: float, when: str, name: str, figures: Figures
) -> None:
    clip, rig = done.clip, done.rig
    frame = int(np.abs(clip.times - (time_s + done.report.lead_s)).argmin())
    q = clip.coordinates[frame]
    frames = rig.chain.frames(q)
    for hand, expected in said.hands.items():
        side = said.sides[hand]
        node = rig.bones[f"palm_{side}"].node
        turned = frames.rotations[node]
        for what, vector, column in (
            ("fingers", expected.fingers, DIR),
            ("palm", expected.palm, NRM),
        ):
            if vector is not None:
                angle = np.degrees(np.arccos(np.clip(turned[:, column] @ vector, -1, 1)))
                figures.add(f"{what} at the {when}, degrees", float(angle), name)
        if when == "start":
            _compare_place(rig, q, expected, side, name, figures)


def _compare_place(
    rig: Rig, q: Array, expected: SaidHand, side: str, name: str, figures: Figures
) -> None:
    frames = rig.chain.frames(q)
    if expected.place is not None:
        palm = rig.sites[f"PA_{side}"].point(frames)
        meant = expected.place * rig.landmarks.arm_m + rig.landmarks.shoulder_middle
        off = np.where(np.isnan(meant), 0.0, palm - meant)
        figures.add("place at the start, m", float(np.linalg.norm(off)), name)
    if expected.touched:
        own = [
            site.point(frames)
            for key, site in rig.sites.items()
            if f"_{side}" in key and _is_of_hand(site.bone)
        ]
        touched = [rig.sites[key].point(frames) for key in expected.touched]
        nearest = min(np.linalg.norm(a - b) for a in own for b in touched)
        figures.add("touch at the start, m", float(nearest), name)
    if expected.touch is not None:
        gap = gap_m(rig, q, expected.touch, side)
        figures.add("gap of touching skins, m", gap, name)


def _is_of_hand(bone: str) -> bool:
    return bone.split("_")[0] in ("palm", "thumb", "index", "middle", "ring", "little")


def rows(figures: Figures) -> Iterator[str]:
    """Yield the table, a line each."""
    for what, bound in BOUNDS.items():
        found = figures.values.get(what, [])
        if found:
            values = np.array([value for value, _ in found])
            beyond = [(v, sign) for v, sign in found if v > bound]
            worst = ", ".join(f"{sign} {v:.3g}" for v, sign in sorted(beyond, reverse=True)[:6])
            share = 100 * (1 - len(beyond) / len(found))
            yield (
                f"{what:32} {len(found):5}  median {np.median(values):7.3g}  "
                f"within {bound:g}: {share:5.1f} %  {worst}"
            )
    total = sum(figures.outcomes.values())
    counts = ", ".join(f"{name} {n}" for name, n in figures.outcomes.most_common())
    yield f"constraints {total}: {counts}; signs without a miss {figures.whole}"
    for reason, count in figures.reasons.most_common(12):
        yield f"  {count:5}  {reason}"
    if figures.seconds:
        seconds = np.array(figures.seconds)
        yield f"seconds a sign: median {np.median(seconds):.2f}, all {seconds.sum():.0f}"
    for failed in figures.failed:
        yield f"failed: {failed}"


def main(arguments: Sequence[str]) -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(prog="lexicon", description=__doc__)
    parser.add_argument("--archive", type=Path, default=ARCHIVE)
    parser.add_argument("--sample", type=int, default=40, help="how many signs; 0 are all")
    parser.add_argument("--names", nargs="*", default=[], help="these signs")
    parser.add_argument("--rig", default="signer")
    parser.add_argument("--dominant", default="right", choices=["right", "left"])
    parser.add_argument("--no-overlap", action="store_true", help="skip what takes longest")
    parser.add_argument("--json", type=Path)
    options = parser.parse_args(list(arguments))
    texts = signs_of(options.archive)
    names = options.names or sample_of(texts, options.sample or len(texts))
    rig = load_rig(options.rig)
    figures = Figures()
    for name in names:
        measure(name, texts[name], rig, figures, options.dominant, overlap=not options.no_overlap)
    for row in rows(figures):
        print(row)
    if options.json:
        document = {
            "signs": len(names),
            "outcomes": figures.outcomes,
            "reasons": figures.reasons,
            "seconds": figures.seconds,
            "values": figures.values,
            "failed": figures.failed,
        }
        options.json.write_text(json.dumps(document, indent=1))
