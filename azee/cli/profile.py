"""Where the time of a command goes, from the start of its process: `--profile`."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from azee.quality.motion_report import MotionReport
    from azee_solver.solve_report import ProblemReport

STARTED = "Python and the command"
SOLVER_STEPS = (
    ("nlopt", "importing nlopt"),
    ("azee_solver.program", "loading the kernels"),
    ("azee.animation", "importing solver and motion"),
)
"""What solving needs, in the order of import: a module, and what loading it is called."""


@dataclass(frozen=True, slots=True)
class Stage:
    """A part of the run. within: the stage that it is a part of, if any."""

    name: str
    seconds: float
    within: str | None = None


class Profile:
    """A stop watch that is always on: it costs microseconds."""

    def __init__(self) -> None:
        self._began = time.perf_counter()
        self._before = process_age_s()
        self.stages = [Stage(STARTED, self._before)]

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Count what happens meanwhile as a stage."""
        began = time.perf_counter()
        try:
            yield
        finally:
            self.stages.append(Stage(name, time.perf_counter() - began))

    def load(self, module: str, name: str) -> None:
        """Import a module, as a stage."""
        with self.stage(name):
            import_module(module)

    def load_solver(self) -> None:
        """Import what solving needs, a stage for each part."""
        with _without_scipy():
            for module, name in SOLVER_STEPS:
                self.load(module, name)

    def split(self, report: MotionReport) -> None:
        """Divide the last stage, which made a movement, into solving and the rest."""
        whole = self.stages.pop()
        solving = [
            Stage(f"{float(posture.time):g} s: {name}", seconds, "solving")
            for posture in report.postures
            if not posture.reused
            for name, seconds in _groups(posture.report.problems)
        ]
        rest = whole.seconds - report.solve_s - report.explain_s
        self.stages += [
            Stage("solving", report.solve_s),
            *solving,
            Stage("why constraints miss", report.explain_s),
            Stage("movement between postures", rest),
        ]

    @property
    def total_s(self) -> float:
        """Time since the process started."""
        return self._before + time.perf_counter() - self._began

    def all_stages(self) -> Sequence[Stage]:
        """Return the stages and, at the end, what none of them counted."""
        counted = sum(stage.seconds for stage in self.stages if stage.within is None)
        return [*self.stages, Stage("the rest", max(0.0, self.total_s - counted))]

    def show(self) -> None:
        """Print a table on standard error."""
        total = self.total_s
        lines = [_line(stage, total) for stage in self.all_stages()]
        lines.append(_line(Stage("whole process so far", total), total))
        click.echo("\n".join(lines), err=True)

    def as_json(self) -> dict[str, object]:
        """Return it as docs/formats.md describes it."""
        stages = [
            {"name": stage.name, "seconds": stage.seconds, "within": stage.within}
            for stage in self.all_stages()
        ]
        return {"total_s": self.total_s, "stages": stages}


@contextmanager
def _without_scipy() -> Iterator[None]:
    """Hide scipy from numba, which looks for a BLAS in it that no kernel of ours calls.

    Importing it takes a tenth of the whole command. Only a command does this: in its own process
    no other compiled code can miss linear algebra.
    """
    if "scipy" in sys.modules:
        yield
        return
    sys.modules["scipy"] = None  # type: ignore[assignment]
    try:
        yield
    finally:
        del sys.modules["scipy"]


def _groups(problems: Sequence[ProblemReport]) -> Iterator[tuple[str, float]]:
    """Names of problems that were solved together, and how long that took."""
    merged: dict[str, int] = {}
    for problem in problems:
        if problem.merged_into is not None:
            merged[problem.merged_into] = merged.get(problem.merged_into, 0) + 1
    for problem in problems:
        if problem.merged_into is None:
            others = merged.get(problem.name, 0)
            yield problem.name + (f" and {others} more" if others else ""), problem.solve_s


def _line(stage: Stage, total: float) -> str:
    indent = "    " if stage.within else "  "
    share = "" if stage.within else f"{100 * stage.seconds / total:5.0f} %"
    name = indent + (stage.name if len(stage.name) <= 60 else stage.name[:59] + "…")
    return f"{name:<66}{1000 * stage.seconds:9.1f} ms{share}"


def process_age_s() -> float:
    """Time since this process was started; its time on the processor where that is not known."""
    try:
        after_name = Path("/proc/self/stat").read_text(encoding="ascii").rpartition(")")[2]
        ticks = int(after_name.split()[19])  # field 22, starttime, of proc(5)
        started = ticks / os.sysconf("SC_CLK_TCK")
        return max(0.0, time.clock_gettime(time.CLOCK_BOOTTIME) - started)
    except (AttributeError, OSError, ValueError, IndexError):
        return time.process_time()
