"""Solves the examples, signs and sentences on one time line, by our and the published solver."""

from __future__ import annotations

import statistics
from collections.abc import Iterator, Sequence
from pathlib import Path

from azee.compilation import Method, perform, score_of
from azee.lang.program import load
from azee_grammar.files import read_source
from azee_rig.rig import Rig
from azee_solver.constraint import Constraint, Orient, Place
from benchmarks.ik.clock import Clock
from benchmarks.ik.methods import METHODS
from benchmarks.ik.problems import Problem

EXAMPLES = Path(__file__).parents[2] / "examples"
SOLVERS: tuple[Method, ...] = ("grouped", "two-level")


def examples() -> list[Path]:
    """Sources that ship, one of each folder, in the order of their names."""
    return sorted(path for path in EXAMPLES.glob("*/*.azee") if path.stem == path.parent.name)


def example_tree(
    rig: Rig, source: Path, runs: int, *, methods: Sequence[str], thumb: bool = True
) -> list[float]:
    """Return how long methods take for the posture of the example, seconds.

    Args: thumb: include the published directions of the thumb, of which one is impossible.
    """
    score = score_of(load(read_source(source)), None, None)
    tasks = perform(score, rig, mode="flat").report.postures[0].ik_tasks
    if not thumb:
        tasks = tuple(d for d in tasks if not _is_of_thumb(d.constraint))
    asked = Problem("tree", 0, tasks, ())
    for name in methods:
        METHODS[name](rig, asked)
    return [
        statistics.median(METHODS[name](rig, asked).seconds for _ in range(runs))
        for name in methods
    ]


def _is_of_thumb(constraint: Constraint) -> bool:
    return isinstance(constraint, Orient) and constraint.bone.name == "thumb"


def figure_5(rig: Rig, source: Path) -> list[dict[str, object]]:
    """Return the figures of the paper's figure 5 for a posture: its IK problems and iterations."""
    score = score_of(load(read_source(source)), None, None)
    report = perform(score, rig, mode="flat", solver="two-level").report.postures[0].report
    return [
        {
            "problem": n,
            "name": problem.name,
            "places": sum(
                isinstance(report.constraints[i].task.constraint, Place)
                for i in problem.constraints
            ),
            "constraints": len(problem.constraints),
            "iterations": problem.iterations,
            "seconds": problem.solve_s,
        }
        for n, problem in enumerate(report.problems)
    ]


def signs(rig: Rig, sources: list[Path]) -> Iterator[dict[str, object]]:
    """Yield the time and the missed constraints of a text, per source and solver."""
    for source in sources:
        score = score_of(load(read_source(source)), None, None)
        for solver in SOLVERS:
            perform(score, rig, mode="flat", solver=solver)
            clock = Clock()
            report = perform(score, rig, mode="flat", solver=solver).report
            whole_s = clock.seconds()
            postures = [p for p in report.postures if not p.reused]
            problems = [q for p in postures for q in p.report.problems]
            rounds = [p.iterations for p in problems if p.iterations is not None]
            deepest = [o.depth_m for p in postures for o in p.report.penetration]
            yield {
                "text": source.stem,
                "solver": solver,
                "problems": len(problems),
                "key_postures": len(postures),
                "score_to_clip_s": whole_s,
                "evaluations": report.evaluations,
                "constraints": len(report.constraints),
                "unmet": sum(not c.met for c in report.constraints),
                "deepest_overlap_m": max(deepest, default=0.0),
                "rounds": rounds,
            }
