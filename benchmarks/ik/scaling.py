"""Measures how time grows with problems in a moment, with moments, with joints in a chain."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from azee_rig.rig import Rig
from azee_solver.geometry import Side
from azee_solver.solve import solve
from benchmarks.ik.clock import Clock
from benchmarks.ik.methods import FULL, METHODS, Answer
from benchmarks.ik.problems import Maker, Problem, problem

STEPS = (1, 2, 3, 5, 8, 11)
"""Numbers of problems of the tree, from its first on."""
MOMENTS = (1, 4, 14)
"""Numbers of trees one after the other: 11, 44 and 154 problems; the paper's sentence has 152."""


def by_problems(rig: Rig, repeats: int) -> Iterator[dict[str, object]]:
    """Yield the time of moments with more and more of the tree's problems, without collision."""
    maker = Maker(rig)
    trees = list(maker.problems("tree", repeats))
    for step in STEPS:
        # The weak hand, the strong elbow, arm and thumb, then one phalanx of a finger each.
        constraints = {1: 3, 2: 4}.get(step, 5 + step)
        seconds = []
        for tree in trees:
            part = Problem("", 0, tree.tasks[:constraints], tree.free)
            seconds.append(METHODS["ours, no collision"](rig, part).seconds)
        yield {"problems": step, "median_s": float(np.median(seconds))}


def by_moments(rig: Rig) -> Iterator[dict[str, object]]:
    """Yield the time of trees at one place after the other, each starting from the one before."""
    maker = Maker(rig)
    trees = list(maker.problems("tree", MOMENTS[-1]))
    idle = rig.coordinates.idle
    for count in MOMENTS:
        at, problems = np.array(idle), 0
        clock = Clock()
        for tree in trees[:count]:
            report = solve(
                rig, tree.tasks, dominant=Side.RIGHT, start=at, reference=idle, options=FULL
            )
            at, problems = report.coordinates, problems + len(report.problems)
        yield {"moments": count, "problems": problems, "seconds": clock.seconds()}


def by_joints(rig: Rig, repeats: int) -> Iterator[dict[str, object]]:
    """Yield the time of placing a finger tip with longer and longer chains, per method."""
    maker = Maker(rig)
    names = rig.coordinates.names
    chain: tuple[str, ...] = ()
    for bones in (("palm_R", "f_arm_R"), ("arm_R",), ("clav_R",), ("back_2",), ("back_1",)):
        chain += bones
        free = tuple(v for v, name in enumerate(names) if name.split(".")[0] in chain)
        rng = np.random.default_rng(len(free))
        problems: list[Problem] = []
        while len(problems) < repeats:
            q = maker.posture(rng, free)
            if q is not None:
                problems.append(problem([maker.at("I_TIP", Side.STRONG, q)], free, q))
        times = {}
        for name in ("ours, descents alone", "LM kernel", "scipy trf"):
            METHODS[name](rig, problems[0])
            answers: list[Answer] = [METHODS[name](rig, p) for p in problems]
            times[name] = float(np.median([answer.seconds for answer in answers]))
        yield {"coordinates": len(free), "median_s": times}
