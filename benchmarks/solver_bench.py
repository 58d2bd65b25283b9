"""Compares the solver with other methods on the same problems: `python benchmarks/run.py solver`.

On two bodies, the signer and its bare armature, every method gets the same problems, drawn with
fixed seeds. Whole signs and sentences follow, then how time grows, and what a process costs before
it can solve. Ratios compare medians within one run; on a busy machine only ratios mean much.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path
from typing import Any

from rich.console import Console

from azee_rig.load import load_rig
from azee_rig.rig import Rig
from benchmarks.ik import tables
from benchmarks.ik.armature import bare_armature, pinned
from benchmarks.ik.comparison import Row, compared
from benchmarks.ik.elsewhere import BLENDER, PINOCCHIO, Environment, NotThere
from benchmarks.ik.goals import Goal, goals_of
from benchmarks.ik.methods import METHODS, Answer
from benchmarks.ik.page import put_on_page
from benchmarks.ik.problems import Maker, Problem
from benchmarks.ik.scaling import by_joints, by_moments, by_problems
from benchmarks.ik.signs import EXAMPLES, example_tree, examples, figure_5, signs

TREE = EXAMPLES / "tree" / "tree.azee"
WIDTH = 130
"""Width of a table where there is no terminal."""
PACKAGES = ("azee", "nlopt", "numba", "numpy", "scipy")


@dataclass
class Findings:
    """What a run has found so far."""

    classes: list[list[Row]] = field(default_factory=list)
    signs: list[dict[str, Any]] = field(default_factory=list)
    figure_5: list[dict[str, Any]] = field(default_factory=list)
    scaling: dict[str, list[dict[str, Any]]] = field(default_factory=dict)
    process: dict[str, float] = field(default_factory=dict)
    goals: list[Goal] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)
    versions: dict[str, str] = field(default_factory=dict)

    def as_json(self, count: int) -> dict[str, object]:
        return {
            "machine": {
                "processor": platform.processor() or platform.machine(),
                "cores": os.cpu_count(),
                "system": platform.platform(),
                "python": platform.python_version(),
                "load": os.getloadavg()[0] if hasattr(os, "getloadavg") else None,
            },
            "versions": self.versions,
            "problems_per_class": count,
            "comparison": [row.as_json() for rows in self.classes for row in rows],
            "signs": self.signs,
            "figure_5": self.figure_5,
            "scaling": self.scaling,
            "process": self.process,
            "goals": [goal.as_json() for goal in self.goals],
            "skipped": self.skipped,
        }


def main(arguments: Sequence[str] | None = None) -> None:
    """Run all of it, print tables as they come, and write the JSON."""
    parser = argparse.ArgumentParser(prog="run.py solver", description=__doc__)
    parser.add_argument("--json", type=Path, metavar="OUT", help="write all figures there")
    parser.add_argument("--page", type=Path, metavar="OUT.md", help="put the results on this page")
    parser.add_argument("--count", type=int, default=200, help="problems per class")
    parser.add_argument("--body", choices=("armature", "signer"), help="compare on this one alone")
    parser.add_argument("--only", choices=("comparison", "signs", "scaling", "process"))
    parser.add_argument(
        "--prepare",
        action="store_true",
        help="install Blender and pinocchio in environments of their own below out/, 1 GB",
    )
    parser.add_argument("--inside", action="store_true", help="leave those two out")
    given = parser.parse_args(arguments)
    console = Console(width=max(Console().width, WIDTH))
    found = Findings(versions={name: version(name) for name in PACKAGES})
    parts: dict[str, Callable[[], None]] = {
        "comparison": lambda: compare(
            found,
            console,
            given.count,
            given.body,
            () if given.inside else _prepared(found, given.prepare),
        ),
        "signs": lambda: read_signs(found, console),
        "scaling": lambda: scale(found, console, max(5, given.count // 10)),
        "process": lambda: processes(found, console),
    }
    for name, part in parts.items():
        if given.only in (None, name):
            part()
    console.print(tables.goals(found.goals))
    for line in found.skipped:
        console.print(f"skipped: {line}")
    document = found.as_json(given.count)
    if given.json:
        given.json.write_text(f"{json.dumps(document, indent=1)}\n", encoding="utf-8")
    if given.page:
        put_on_page(document, given.page)


def _prepared(found: Findings, prepare: bool) -> Sequence[Environment]:
    """Return the environments that exist, after making them if wanted; note why others do not."""
    there = []
    for environment in (BLENDER, PINOCCHIO):
        try:
            if prepare:
                environment.prepare()
        except NotThere as reason:
            found.skipped.append(str(reason))
            continue
        if environment.is_ready:
            there.append(environment)
        else:
            found.skipped.append(f"{environment.name} is not installed: `make bench-blender`")
    return there


def compare(
    found: Findings,
    console: Console,
    count: int,
    only: str | None,
    environments: Sequence[Environment],
) -> None:
    """Compare all methods on the bare armature and, those that can, on the signer."""
    signer = pinned(load_rig())
    with tempfile.TemporaryDirectory() as folder:
        other = {e.name: _caller(e, found, Path(folder)) for e in environments}
        bodies = {"armature": (bare_armature(signer), other), "signer": (signer, {})}
        for body, (rig, apart) in bodies.items():
            if only not in (None, body):
                continue
            kinds = list(Maker(rig).classes())
            for rows in compared(body, rig, kinds, count, METHODS, apart):
                found.classes.append(rows)
                console.print(tables.comparison(rows))
    found.goals += goals_of(found.classes)


def _caller(
    environment: Environment, found: Findings, work: Path
) -> Callable[[Rig, Sequence[Problem]], Sequence[Answer]]:
    def solve(rig: Rig, problems: Sequence[Problem]) -> Sequence[Answer]:
        found.versions[environment.name], answers = environment.solve(rig, problems, work)
        return answers

    return solve


def read_signs(found: Findings, console: Console) -> None:
    """Solve all examples."""
    found.signs += signs(load_rig(), examples())
    console.print(tables.signs(found.signs))
    found.figure_5 += figure_5(load_rig(), TREE)
    console.print(tables.figure_5(found.figure_5))
    for thumb, what in ((True, "tree"), (False, "tree without its impossible thumb")):
        full, apart = example_tree(
            load_rig(),
            TREE,
            runs=15,
            methods=("ours, everything on", "ours, no collision"),
            thumb=thumb,
        )
        found.goals += [
            Goal(f"{what}, full body, all on", 1000 * full, "ms", at_most=15),
            Goal(f"{what}, full body: collision on / off", full / apart, "×", at_most=3),
        ]


def scale(found: Findings, console: Console, repeats: int) -> None:
    """Measure how time grows."""
    rig = pinned(load_rig())
    found.scaling = {
        "problems in a moment": list(by_problems(rig, repeats)),
        "moments": list(by_moments(rig)),
        "coordinates in a chain": list(by_joints(rig, repeats)),
    }
    console.print(tables.scaling(found.scaling))


def processes(found: Findings, console: Console) -> None:
    """Measure what a process costs: compiling once on a machine, everything else each time."""
    code = (
        "import sys, time, nlopt, numpy; sys.modules['scipy'] = None; t = time.perf_counter(); "
        "import azee_solver.program; print(time.perf_counter() - t)"
    )
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | {
            "NUMBA_CACHE_DIR": str(Path(folder) / "cache"),
            "PYTHONPATH": os.pathsep.join(p for p in sys.path if p),
        }
        for what in ("compiling the kernels, once", "loading the compiled kernels"):
            done = subprocess.run(
                [sys.executable, "-c", code],
                env=environment,
                capture_output=True,
                text=True,
                check=True,
            )
            found.process[what] = float(done.stdout)
        out = Path(folder) / "tree.glb"
        command = [sys.executable, "-m", "azee", "compile", str(TREE), "-o", str(out), "--quiet"]
        # Warm means that modules are compiled, as where azee is installed and has run before.
        warm = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
        warm["PYTHONPYCACHEPREFIX"] = str(Path(folder) / "bytecode")
        whole = []
        for _ in range(6):
            began = time.perf_counter()
            subprocess.run(command, env=warm, check=True, capture_output=True)
            whole.append(time.perf_counter() - began)
        found.process["azee compile tree, whole process, warm"] = statistics.median(whole[1:])
        done = subprocess.run(
            [*command, "--profile", "--format", "json"],
            env=warm,
            check=True,
            capture_output=True,
            text=True,
        )
        for stage in json.loads(done.stdout)["profile"]["stages"]:
            if stage["within"] is None and stage["name"] != "the report":  # only `json` asks for it
                found.process[f"  {stage['name']}"] = stage["seconds"]
    console.print(tables.processes(found.process))
    found.goals.append(
        Goal(
            "azee compile tree, whole process, warm",
            found.process["azee compile tree, whole process, warm"],
            "s",
            at_most=1.2,
        )
    )
