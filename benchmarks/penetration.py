"""Measures how deep the skin enters itself at the key postures of all examples and rules.

`python -m benchmarks.penetration [-o FILE.json] [NAME …]`. It compiles every example below
examples/ and the example of every rule that ships. At each key posture it measures on the posed
mesh where the arms and digits of this key are inside trunk, head or each other, except at places
where a constraint brings two sites together. It prints the worst ten, and whether the report named
them.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from azee.compilation import perform, score_of
from azee.lang.library import shipped_library
from azee.lang.program import load
from azee.lang.rule_example import example_text
from azee.motion.tasks.key_posture import KeyPosture
from azee.score.score import Score
from azee_grammar.files import read_source
from azee_grammar.library import shipped_names
from azee_grammar.source import Source
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver.constraint import Place
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Side, SitePoint
from azee_solver.penetration import Contact, meant_contact, mesh_penetration

EXAMPLES = Path(__file__).parents[1] / "examples"
TOLERATED_M = 3e-3
WORST = 10


@dataclass(frozen=True, slots=True)
class Finding:
    """A limb inside another part of the body in a key posture of a sign."""

    sign: str
    time_s: float
    limb: str
    body: str
    depth_mm: float
    unmet: tuple[str, ...]
    """Constraints of the same moment that the report calls unmet."""


def sources(names: Sequence[str] = ()) -> Iterator[tuple[str, Source]]:
    """Yield the texts to measure, by name: all, or those that are named."""
    for path in sorted(EXAMPLES.glob("*/*.azee")):
        if not names or path.stem in names:
            yield path.stem, read_source(path)
    for library in shipped_names():
        for rule in shipped_library(library).namespace.rules.values():
            if not names or rule.name in names:
                yield f":{rule.name}", Source(rule.name, example_text(rule))


def scores(names: Sequence[str]) -> Iterator[tuple[str, Score]]:
    """Yield the scores of these texts."""
    for name, source in sources(names):
        yield name, score_of(load(source), None, None)


def findings(sign: str, score: Score, rig: Rig) -> Iterator[Finding]:
    """Measure the key postures of one score."""
    made = perform(score, rig, life=False)
    seen: set[bytes] = set()
    for posture in made.report.postures:
        q = np.asarray(posture.coordinates)
        if q.tobytes() in seen:
            continue
        seen.add(q.tobytes())
        unmet = tuple(c.kind for c in posture.report.constraints if not c.met)
        for found in mesh_penetration(rig, q, contacts(rig, posture)):
            if not {found.limb, found.body} & posture.limbs:
                continue  # on its way between two keys of its own
            yield Finding(
                sign,
                round(float(posture.time), 3),
                found.limb,
                found.body,
                round(1000 * found.depth_m, 2),
                unmet,
            )


def contacts(rig: Rig, posture: KeyPosture) -> list[Contact]:
    """Return the places where constraints bring two sites together."""
    evaluator = Evaluator(rig, Side.RIGHT)
    frames = rig.chain.frames(posture.coordinates)
    return [
        meant_contact(evaluator, frames, task.constraint)
        for task in posture.ik_tasks
        if isinstance(task.constraint, Place) and isinstance(task.constraint.point, SitePoint)
    ]


def main(given: Sequence[str] | None = None) -> int:
    """Print the worst. Returns: 1 if one is deeper than is tolerated."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", help="examples and rules; by default all")
    parser.add_argument("-o", "--output", type=Path, help="everything, as JSON")
    arguments = parser.parse_args(given)
    rig = load_rig()
    found: list[Finding] = []
    looked_at = 0
    for sign, score in scores(arguments.names):
        looked_at += 1
        found += findings(sign, score, rig)
    found.sort(key=lambda f: -f.depth_mm)
    print(f"{looked_at} examples and rules; where the skin enters itself most:")
    for f in found[:WORST]:
        note = f"  unmet: {', '.join(f.unmet)}" if f.unmet else ""
        print(
            f"{f.depth_mm:6.1f} mm  {f.sign:<22} at {f.time_s:5.2f} s  {f.limb} in {f.body}{note}"
        )
    if arguments.output:
        rows = [asdict(f) for f in found]
        arguments.output.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    return int(any(f.depth_mm > 1000 * TOLERATED_M for f in found))


if __name__ == "__main__":
    sys.exit(main())
