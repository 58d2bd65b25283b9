"""Puts kernels compiled ahead of time into a wheel for one platform: `make platform-wheel`.

Hatch calls it only if HATCH_BUILD_HOOK_ENABLE_CUSTOM is set. Otherwise the wheel is pure, and
kernels are compiled on the first run.
"""

from __future__ import annotations

import platform
import runpy
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SCRIPT = Path(__file__).with_name("kernels.py")


class Kernels(BuildHookInterface[Any]):
    """Compiles kernels in a process of its own, for numba is told its target when it starts."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile the kernels and add them; an editable install has none."""
        if version == "editable":
            return
        script = runpy.run_path(str(SCRIPT))
        try:
            *_, tag = script["baseline"](sys.platform, platform.machine())
        except script["NoBaseline"] as error:
            self.app.abort(str(error))
        self._folder = Path(tempfile.mkdtemp())
        command = [sys.executable, str(SCRIPT), str(self._folder)]
        if subprocess.run(command, check=False).returncode:
            shutil.rmtree(self._folder)
            self.app.abort("The kernels could not be compiled")
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{tag}"
        build_data["force_include"][str(self._folder)] = "azee_rig/compiled"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Delete what was compiled; it is in the wheel."""
        if version != "editable":
            shutil.rmtree(self._folder)
