"""Methods that run in an environment of their own, which is made on first use.

A problem goes out as JSON and a posture comes back. The JSON has the chain's arrays as in
`azee_rig.chain`, and the ordered IK problems. Each problem has the coordinates it may move and its
constraints: point to point, axis along or across axis, in the frames of nodes (−1 is the world).
"""

from __future__ import annotations

import json
import subprocess
import sys
import venv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from azee_rig.rig import Rig
from azee_solver.anatomy import anatomy
from azee_solver.binding import Binding
from azee_solver.constraint import Place
from azee_solver.geometry import Side
from azee_solver.problems import ProblemBuilder, Reach
from benchmarks.ik.levenberg import Flat, as_json
from benchmarks.ik.methods import Answer
from benchmarks.ik.problems import TIGHT, Problem

OUT = Path(__file__).parents[2] / "out"
HERE = Path(__file__).parent
READY = ".ready"


class NotThere(Exception):  # noqa: N818 - it is no fault
    """An environment could not be made; the message says why in a line."""


@dataclass(frozen=True, slots=True)
class Environment:
    """A method in an environment of its own.

    package: the package that is installed there, with its exact version.
    """

    name: str
    package: str
    script: str
    ordered: bool

    @property
    def folder(self) -> Path:
        """Where the environment lies; it can be deleted at any time."""
        return OUT / f"env-{self.package.split('==')[0]}"

    @property
    def python(self) -> Path:
        """Its interpreter."""
        windows = sys.platform == "win32"
        return self.folder / ("Scripts/python.exe" if windows else "bin/python")

    @property
    def is_ready(self) -> bool:
        """Whether the environment exists, with the right version of the package."""
        ready = self.folder / READY
        return ready.exists() and ready.read_text(encoding="utf-8") == self.package

    def prepare(self) -> None:
        """Make the environment unless it exists. Raises: NotThere: it cannot be made."""
        if self.is_ready:
            return
        venv.create(self.folder, clear=True, with_pip=True)
        command = [str(self.python), "-m", "pip", "install", "--quiet", self.package, "numpy"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            last = (done.stderr.strip().splitlines() or ["pip gave no reason"])[-1]
            raise NotThere(f"{self.package} cannot be installed: {last}")
        (self.folder / READY).write_text(self.package, encoding="utf-8")

    def solve(self, rig: Rig, problems: Sequence[Problem], work: Path) -> tuple[str, list[Answer]]:
        """Return which version answered, and its answers. Raises: NotThere: it has failed."""
        asked, answered = work / "problems.json", work / "answers.json"
        task = {"chain": chain_json(rig), "problems": [self._json(rig, p) for p in problems]}
        asked.write_text(json.dumps(task), encoding="utf-8")
        done = subprocess.run(
            [str(self.python), str(HERE / self.script), str(asked), str(answered)],
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode:
            last = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
            raise NotThere(f"{self.name} ended with an error: {last}")
        document = json.loads(answered.read_text(encoding="utf-8"))
        answers = [
            Answer(np.array(a["q"]), a["seconds"], a["evaluations"], tuple(a["rounds"]))
            for a in document["answers"]
        ]
        return document["version"], answers

    def _json(self, rig: Rig, problem: Problem) -> dict[str, object]:
        steps = ordered_steps(rig, problem) if self.ordered else [
            (frozenset(problem.free), list(range(len(problem.tasks))))
        ]  # fmt: skip
        constraints = problem.constraints
        return {
            "kind": problem.kind,
            "steps": [
                {
                    "free": sorted(free),
                    "constraints": as_json(
                        Flat(rig, [constraints[i] for i in indices], sorted(free), TIGHT)
                    ),
                }
                for free, indices in steps
            ],
        }


def ordered_steps(rig: Rig, problem: Problem) -> list[tuple[frozenset[int], list[int]]]:
    """Return the paper's ordered IK problems: the coordinates of each, and its constraints.

    A chain starts where that of an earlier placement ends. If there is only one problem, it may
    move all coordinates that are known to suffice.
    """
    binding = Binding(rig, Side.RIGHT)
    built = ProblemBuilder(problem.tasks, binding, anatomy(rig.chain, rig.coordinates)).build()
    if len(built) == 1:
        return [(frozenset(problem.free), list(built[0].tasks))]
    placed: frozenset[int] = frozenset()
    steps = []
    for ordered in built:
        own = ordered.steps[Reach.OWN]
        steps.append((own - placed or own, list(ordered.tasks)))
        if any(isinstance(problem.constraints[i], Place) for i in ordered.tasks):
            placed |= own
    return steps


def chain_json(rig: Rig) -> dict[str, object]:
    """The chain and its limits."""
    chain, limits = rig.chain, rig.coordinates
    return {
        "names": [*chain.names],
        **{
            name: getattr(chain, name).tolist()
            for name in (
                "parents", "offsets", "zero", "dof_start", "dof_axis", "dof_scale",
                "dof_coordinate",
            )
        },
        **{name: getattr(limits, name).tolist() for name in ("lower", "upper", "idle")},
    }  # fmt: skip


BLENDER = Environment("Blender iTaSC", "bpy==5.0.1", "blender_itasc.py", ordered=True)
PINOCCHIO = Environment("pinocchio DLS", "pin==4.1.0", "pinocchio_dls.py", ordered=False)
