"""Checks whether a small change of a target gives a small change of the posture.

`python -m benchmarks.continuity [--sweeps N] [-o FILE.json]`. Targets move through the signing
space in steps of a millimetre, along straight lines drawn with fixed seeds. The targets are for a
fingertip, for a palm, and for a palm that also faces forwards. Every posture starts from the one
before and is drawn to it thirty times more than to idle, as when a live target is followed. The
benchmark measures the largest change of any coordinate from one step to the next. The bound is 2°
within 98 % of reach and 4° beyond. It prints steps that change more, and what changed.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver.anatomy import Part, anatomy
from azee_solver.constraint import BoneAxis, Constraint, Orient, Place, Relation
from azee_solver.geometry import Bone, Side, Site, Vec, WorldPoint
from azee_solver.options import SolveOptions
from azee_solver.solve import solve
from azee_solver.solve_report import SolveReport
from azee_solver.task import Task

Array = NDArray[np.float64]

STEP_M = 1e-3
LENGTH_M = 0.25
WITHIN = 0.98
ALLOWED_DEG = {True: 2.0, False: 4.0}
"""Largest allowed changes of a coordinate in a step, within 98 % of reach and beyond."""
INERTIA = 30.0
"""How much more a posture is drawn to the one before than to idle."""
SEED = 7
SPACE_M = np.array([[-0.45, -0.45, 0.15], [0.2, 0.3, 0.65]])
"""Ranges of the ends of lines, from the middle of the shoulders."""
FORWARD = Vec(0.0, 0.0, 1.0)


@dataclass(frozen=True, slots=True)
class Jump:
    """A step with a greater change than is allowed.

    reach: distance of the target from the shoulder, divided by that of the stretched arm. missed:
        what was out of tolerance before or after. at_limits: how many coordinates of trunk and arm
        are at their limits. moved: parts that the solver moved before and after.
    """

    kind: str
    sweep: int
    step: int
    reach: float
    coordinate: str
    change_deg: float
    missed: tuple[str, ...]
    at_limits: int
    moved: tuple[tuple[str, ...], tuple[str, ...]]


@dataclass(frozen=True, slots=True)
class Row:
    """Result of the sweeps of one kind: steps, of those beyond 98 % of reach, largest changes."""

    kind: str
    steps: int
    beyond: int
    met: int
    median_deg: float
    largest_deg: float
    largest_beyond_deg: float
    jumps: int


def kinds(target: WorldPoint) -> dict[str, list[Constraint]]:
    """Return the constraints of the strong hand, by name."""
    strong = Side.STRONG
    return {
        "fingertip": [Place(Site("I_TIP", strong), target)],
        "palm": [Place(Site("PA", strong), target)],
        "palm, facing": [
            Place(Site("PA", strong), target),
            Orient(BoneAxis.NRM, Bone("palm", strong), Relation.ALONG, FORWARD),
        ],
    }


def stretched_m(rig: Rig, site: str) -> float:
    """Return the distance from the shoulder to a site of the hand with all joints straight."""
    frames = rig.chain.frames(np.clip(0.0 * rig.coordinates.idle, *_limits(rig)))
    found = rig.sites[site]
    at = frames.positions[found.node] + frames.rotations[found.node] @ found.position
    return float(np.linalg.norm(at - frames.positions[rig.bones["arm_R"].origin_node]))


def _limits(rig: Rig) -> tuple[Array, Array]:
    return rig.coordinates.lower, rig.coordinates.upper


def line(rig: Rig, sweep: int) -> Iterator[Array]:
    """Yield the targets of a sweep (3,), a millimetre apart."""
    rng = np.random.default_rng((SEED, sweep))
    low, high = rig.landmarks.shoulder_middle + SPACE_M
    while True:
        start, other = low + rng.random((2, 3)) * (high - low)
        way = (other - start) / np.linalg.norm(other - start)
        end = start + LENGTH_M * way
        if np.all((end > low) & (end < high)):
            break
    for k in range(int(LENGTH_M / STEP_M) + 1):
        yield start + k * STEP_M * way


def swept(rig: Rig, kind: str, sweep: int) -> Iterator[tuple[float, SolveReport]]:
    """Yield how far out a target is, as a share of reach, and its solution."""
    idle = rig.coordinates.idle
    frames = rig.chain.frames(idle)
    shoulder = frames.positions[rig.bones["arm_R"].origin_node]
    reach = stretched_m(rig, "I_TIP_R" if kind == "fingertip" else "PA_R")
    wide = SolveOptions()
    near = replace(wide, far=False, patience=0, inertia=INERTIA)
    start, options = idle, wide
    for target in line(rig, sweep):
        asked = kinds(WorldPoint(*target.tolist()))[kind]
        tasks = [Task(c, rank=i) for i, c in enumerate(asked)]
        report = solve(
            rig, tasks, dominant=Side.RIGHT, start=start, reference=idle, options=options
        )
        start, options = report.coordinates, near
        yield float(np.linalg.norm(target - shoulder)) / reach, report


def measure(rig: Rig, kind: str, sweeps: int) -> tuple[Row, list[Jump]]:
    """Run the sweeps of a kind."""
    jumps: list[Jump] = []
    changes: dict[bool, list[float]] = {True: [], False: []}
    met = 0
    for sweep in range(sweeps):
        last: SolveReport | None = None
        for step, (reach, report) in enumerate(swept(rig, kind, sweep)):
            met += report.met
            if last is not None:
                change = np.degrees(np.abs(report.coordinates - last.coordinates))
                v, inside = int(change.argmax()), reach < WITHIN
                changes[inside].append(float(change[v]))
                if change[v] > ALLOWED_DEG[inside]:
                    jumps.append(
                        Jump(
                            kind,
                            sweep,
                            step,
                            round(reach, 3),
                            rig.coordinates.names[v],
                            round(float(change[v]), 2),
                            missed(last, report),
                            at_limits(rig, report),
                            (last.problems[0].moved, report.problems[0].moved),
                        )
                    )
            last = report
    every = changes[True] + changes[False]
    row = Row(
        kind,
        len(every),
        len(changes[False]),
        met,
        round(float(np.median(every)), 3),
        round(max(changes[True], default=0.0), 2),
        round(max(changes[False], default=0.0), 2),
        len(jumps),
    )
    return row, jumps


def missed(*reports: SolveReport) -> tuple[str, ...]:
    """Return what is out of tolerance in any of some reports."""
    kinds = [c.kind for report in reports for c in report.constraints if not c.met]
    return tuple(dict.fromkeys(kinds))


def at_limits(rig: Rig, report: SolveReport) -> int:
    """Count the coordinates, without fingers, that constraints may move and that are at a limit."""
    limits, q = rig.coordinates, report.coordinates
    at = np.minimum(q - limits.lower, limits.upper - q) < 1e-9
    hand = anatomy(rig.chain, limits).of(Part.HAND)
    return int(sum(at[v] for v in report.reached - hand))


def explained(jump: Jump) -> str:
    """Say why a posture changes so much, as far as it can be seen from outside."""
    before, after = jump.moved
    taken = [part for part in after if part not in before]
    left = [part for part in before if part not in after]
    why = [f"missed: {' and '.join(jump.missed)}"] if jump.missed else []
    why += [f"takes {' and '.join(taken)}"] if taken else []
    why += [f"leaves {' and '.join(left)}"] if left else []
    why += [f"{jump.at_limits} coordinates at their limits"] if jump.at_limits else []
    return "; ".join(why)


def main(given: Sequence[str] | None = None) -> int:
    """Print a row per kind and every jump. Returns: 1 if there is a jump."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sweeps", type=int, default=12)
    parser.add_argument("-o", "--output", type=Path, help="rows and jumps, as JSON")
    arguments = parser.parse_args(given)
    rig = load_rig()
    found = [measure(rig, kind, arguments.sweeps) for kind in kinds(WorldPoint(0.0, 0.0, 0.0))]
    print(
        f"{'':<16}{'steps':>7}{'beyond':>8}{'met':>7}{'median':>9}{'inside':>9}{'beyond':>9}  jumps"
    )
    for row, _ in found:
        print(
            f"{row.kind:<16}{row.steps:>7}{row.beyond:>8}{row.met:>7}{row.median_deg:>8.2f}°"
            f"{row.largest_deg:>8.2f}°{row.largest_beyond_deg:>8.2f}°{row.jumps:>7}"
        )
    jumps = [jump for _, some in found for jump in some]
    for j in jumps:
        print(
            f"  {j.kind}, sweep {j.sweep}, step {j.step}, at {j.reach:.3f} of reach: "
            f"{j.coordinate} by {j.change_deg}°; {explained(j)}"
        )
    if arguments.output:
        content = {"rows": [asdict(r) for r, _ in found], "jumps": [asdict(j) for j in jumps]}
        arguments.output.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    return int(bool(jumps))


if __name__ == "__main__":
    sys.exit(main())
