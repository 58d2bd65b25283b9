"""Measures the first compilation after installing: `benchmarks/run.py first-run`.

Builds the wheel for this platform, installs it with its dependencies into a new environment, and
compiles a sentence there: with the kernels that the wheel brought, and without them, as a pure
wheel does. Both movements are compared byte by byte. `--wheel FILE` takes a wheel that is built.
On a busy machine only processor time means much.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import venv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
SENTENCE = ROOT / "examples" / "person-aged-52" / "person-aged-52.azee"
GOAL_S = 3.0
SCRIPT = """
import json, sys, time
from azee_rig.machine_code import Kernel, told_of_compiling
spent, compiled, inner = [0.0, 0.0], [], Kernel.address.func
def timed(kernel):
    began, used = time.perf_counter(), time.process_time()
    try:
        return inner(kernel)
    finally:
        spent[0] += time.perf_counter() - began
        spent[1] += time.process_time() - used
Kernel.address.func = timed
from azee.cli.main import run
with told_of_compiling(lambda number, total: compiled.append(number)):
    code = run(sys.argv[1:])
print(json.dumps({"kernels": spent, "compiled": len(compiled)}))
sys.exit(code)
"""
"""Runs the command, and tells the time until every kernel was ready, by the clock and in processor
time, and how many were compiled."""


@dataclass(frozen=True)
class First:
    """A run of the command in a new process; seconds by the clock and in processor time."""

    whole_s: tuple[float, float]
    kernels_s: tuple[float, float]
    compiled: int


def built(folder: Path) -> Path:
    """Return a new wheel for this platform."""
    command = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir"]
    environment = os.environ | {"HATCH_BUILD_HOOK_ENABLE_CUSTOM": "true"}
    subprocess.run(
        [*command, str(folder), str(ROOT)], check=True, env=environment, stdout=subprocess.DEVNULL
    )
    (wheel,) = folder.glob("*.whl")
    return wheel


def installed(wheel: Path, folder: Path) -> Path:
    """Return the Python of a new environment with the wheel and what it needs."""
    venv.create(folder, with_pip=True)
    python = folder / ("Scripts" if os.name == "nt" else "bin") / "python"
    pip = [str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    subprocess.run([*pip, "-c", str(ROOT / "constraints.txt"), str(wheel)], check=True)
    return python


def first(python: Path, written: Path) -> First:
    """Compile the sentence in a process of its own, outside the checkout."""
    environment = {
        k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "NUMBA_CACHE_DIR")
    }
    spent, began = os.times(), time.perf_counter()
    done = subprocess.run(
        [python, "-c", SCRIPT, "compile", "--quiet", SENTENCE, "-o", written],
        check=True,
        env=environment,
        cwd=written.parent,
        stdout=subprocess.PIPE,
    )
    clock, now = time.perf_counter() - began, os.times()
    used = now.children_user + now.children_system - spent.children_user - spent.children_system
    told = json.loads(done.stdout)
    return First((clock, used), tuple(told["kernels"]), told["compiled"])


def line(what: str, run: First) -> str:
    """Return a line of the table."""
    times = "".join(f"{seconds:>10.2f} s" for seconds in (*run.whole_s, *run.kernels_s))
    return f"{what:<36}{times}{run.compiled:>12}"


def main(arguments: Sequence[str] = ()) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--wheel", type=Path)
    wheel = parser.parse_args(arguments).wheel
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        python = installed(wheel or built(folder), folder / "environment")
        (package,) = (folder / "environment").rglob("azee_rig")
        brought = first(python, folder / "brought.glb")
        again = first(python, folder / "again.glb")
        shutil.rmtree(package / "compiled")
        compiled = first(python, folder / "compiled.glb")
        made = {(folder / f"{name}.glb").read_bytes() for name in ("brought", "again", "compiled")}
    heads = ("clock", "processor", "kernels", "processor", "compiled")
    print(f"{SENTENCE.stem:<36}{''.join(f'{head:>12}' for head in heads)}")
    print(line("first run, kernels from the wheel", brought))
    print(line("second run, kernels from the wheel", again))
    print(line("first run without them", compiled))
    print(f"the same bytes: {'yes' if len(made) == 1 else 'no'}; goal: {GOAL_S:g} s by the clock")


if __name__ == "__main__":
    main(sys.argv[1:])
