"""Compiles all kernels for a platform, for a wheel: `python packaging/kernels.py FOLDER`.

The code may use what `BASELINES` names of a processor, and no more: it does not depend on the
machine that builds. azee_rig.ahead_of_time has what is written, and how it is chosen. The folder
is made; it must be empty if there is one.
"""

from __future__ import annotations

import os
import platform
import sys
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from azee_rig.machine_code import Kernel

ROOT = Path(__file__).parents[1]
PACKAGES = {"azee_rig": ROOT / "rig", "azee_solver": ROOT / "solver"}
"""Those with kernels, and where they are imported from."""

X86_64_V3 = (
    *("sse3", "ssse3", "sse4.1", "sse4.2", "popcnt", "cx16", "sahf"),  # x86-64-v2
    *("avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe", "xsave"),
)
"""Features of the level x86-64-v3 of the System V ABI (processors since about 2013 to 2015)."""
BASELINES = {("linux", "x86_64"): ("x86-64-v3", X86_64_V3, "manylinux_2_17_x86_64")}
"""By system and machine: LLVM's name of the processor, its features, and the tag of the wheel.

The code calls functions of C by their names alone, and no version of glibc: the oldest tag that pip
knows by this form is right.
"""


class NoBaseline(Exception):  # noqa: N818 - it is told in a sentence
    """Kernels cannot be compiled ahead of time here."""


def baseline(system: str, machine: str) -> tuple[str, tuple[str, ...], str]:
    """Return what `BASELINES` has for a system and a machine. Raises: NoBaseline."""
    found = BASELINES.get((system, machine))
    if found is None:
        known = ", ".join(" ".join(pair) for pair in BASELINES)
        raise NoBaseline(f"kernels are compiled ahead of time only on: {known}")
    return found


def kernels() -> list[Kernel]:
    """Return all kernels that the packages name."""
    from azee_rig.machine_code import KERNELS

    for package, place in PACKAGES.items():
        for file in sorted((place / package).glob("*.py")):
            if "import Kernel" in file.read_text(encoding="utf-8"):
                import_module(f"{package}.{file.stem}")
    return sorted(KERNELS, key=lambda kernel: kernel.full_name)


def compile_into(folder: Path) -> None:
    """Compile all kernels for this platform's baseline. Raises: NoBaseline."""
    cpu, features, _ = baseline(sys.platform, platform.machine())
    # numba reads these when it is imported. The name of the processor implies its features.
    os.environ["NUMBA_CPU_NAME"], os.environ["NUMBA_CPU_FEATURES"] = cpu, ""
    sys.path[:0] = map(str, PACKAGES.values())
    from azee_rig import ahead_of_time
    from azee_rig.object_code import Target, host, object_code

    target = Target(host().triple, cpu, frozenset(features))
    missing = target.features - host().features
    if missing:  # numba links what it compiles
        raise NoBaseline(f"this processor has no {', '.join(sorted(missing))}")
    made = {
        kernel.full_name: (kernel.digest, object_code(kernel.llvm(), kernel.symbol, target))
        for kernel in kernels()
    }
    folder.mkdir(parents=True, exist_ok=True)
    versions = {name: version(name) for name in ("llvmlite", "numba")}
    ahead_of_time.write(folder, target, made, versions)


if __name__ == "__main__":
    try:
        compile_into(Path(sys.argv[1]))
    except NoBaseline as error:
        sys.exit(str(error))
