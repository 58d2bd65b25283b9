"""Kernels kept on disk: made once, loaded without numba, made anew where anything is wrong."""

from __future__ import annotations

import ast
import json
import math
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from programs import Python

from azee_rig import machine_code, skin
from azee_rig.machine_code import Kernel
from azee_rig.object_code import Unkept
from azee_solver import kinematics, program, winding

pytestmark = pytest.mark.skipif(not machine_code.KEEPS, reason="numba keeps its own code here")

SOURCE = '''
"""A kernel for tests."""
import math

from numba import cfunc

from azee_rig.pointers import WORDS, carray, reals


@cfunc(WORDS, error_model="numpy")
def waves(words):
    w = carray(words, (3,))
    x, out = reals(w[1], (w[0],)), reals(w[2], (w[0],))
    for i in range(w[0]):
        out[i] = math.sin(x[i]) * SCALE + math.cos(2.0 * x[i])


@cfunc(WORDS, error_model="numpy")
def shaped(words):
    w = carray(words, (2,))
    reals(w[1], (6,)).reshape((2, 3))[1, 2] = w[0]
'''
RUN = """
import json, sys
import numpy as np
from azee_rig.machine_code import Kernel
from azee_solver import kinematics, program, winding
x = np.linspace(0.0, 3.0, 50)
out = np.empty(50)
Kernel("waved", "waves", "azee_rig.pointers")(50, x, out)
print(json.dumps({"numba": "numba" in sys.modules, "out": out.tolist()}))
"""


def expected(scale: float) -> list[float]:
    x = np.linspace(0.0, 3.0, 50)
    return [math.sin(v) * scale + math.cos(2 * v) for v in x.tolist()]


def write(folder: Path, scale: float) -> None:
    text = SOURCE.replace("SCALE", str(scale))
    (folder / "waved.py").write_text(text, encoding="utf-8")


@dataclass(frozen=True)
class Run:
    """What a process found."""

    numba: bool
    out: list[float]


def run(python: Python, folder: Path) -> Run:
    # The folder goes first on the path, for `waved`; its cache is beside it.
    code = f"import sys; sys.path.insert(0, {str(folder)!r})\n{RUN}"
    done = python("-c", code, expect=0)
    return Run(**json.loads(done.stdout))


def kept(folder: Path) -> list[Path]:
    return sorted((folder / "__pycache__").glob("waved.waves-*.o"))


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    folder = tmp_path / "code"
    folder.mkdir()
    write(folder, 3.0)
    return folder


@pytest.mark.slow
def test_it_is_made_once_and_loaded_without_numba(python: Python, place: Path) -> None:
    first = run(python, place)
    assert first.numba
    assert len(kept(place)) == 1
    again = run(python, place)
    assert not again.numba
    assert again.out == first.out
    np.testing.assert_allclose(again.out, expected(3.0), atol=1e-15)


TOLD = """
import json, sys
import numpy as np
from azee_rig.machine_code import Kernel, told_of_compiling
told = []
with told_of_compiling(lambda number, total: told.append([number, total])):
    Kernel("waved", "waves", "azee_rig.pointers")(3, np.zeros(3), np.empty(3))
print(json.dumps(told))
"""


@pytest.mark.slow
def test_it_is_told_of_only_when_it_is_made(python: Python, place: Path) -> None:
    code = f"import sys; sys.path.insert(0, {str(place)!r})\n{TOLD}"
    assert json.loads(python("-c", code, expect=0).stdout) == [[1, 1]]
    assert json.loads(python("-c", code, expect=0).stdout) == []


@pytest.mark.slow
def test_another_source_is_another_kernel_and_the_old_one_goes(python: Python, place: Path) -> None:
    run(python, place)
    (before,) = kept(place)
    write(place, 4.0)
    found = run(python, place)
    assert found.numba
    np.testing.assert_allclose(found.out, expected(4.0), atol=1e-15)
    (after,) = kept(place)
    assert after != before


@pytest.mark.slow
@pytest.mark.parametrize("damage", [b"", b"x" * 4000, None])
def test_a_damaged_file_is_made_anew(python: Python, place: Path, damage: bytes | None) -> None:
    run(python, place)
    (file,) = kept(place)
    good = file.read_bytes()
    file.write_bytes(good[:-100] if damage is None else damage)
    found = run(python, place)
    assert found.numba
    np.testing.assert_allclose(found.out, expected(3.0), atol=1e-15)
    assert file.read_bytes() == good


@pytest.mark.slow
def test_where_nothing_can_be_written_it_works_all_the_same(
    python: Python, place: Path, tmp_path: Path
) -> None:
    (place / "__pycache__").write_text("a file where a folder is wanted", encoding="utf-8")
    run(python, place)
    assert list((tmp_path / "home" / "azee").glob("waved.waves-*.o"))
    assert not run(python, place).numba
    shutil.rmtree(tmp_path / "home")
    (tmp_path / "home").write_text("another", encoding="utf-8")
    found = run(python, place)
    assert found.numba
    np.testing.assert_allclose(found.out, expected(3.0), atol=1e-15)


@pytest.mark.slow
def test_what_calls_more_than_c_is_left_to_numba(
    place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(str(place))
    kernel, out = Kernel("waved", "shaped", "azee_rig.pointers"), np.zeros(6)
    with pytest.raises(Unkept, match="reshape"):
        kernel._kept()
    kernel(7, out)
    assert out[5] == 7
    assert not list((place / "__pycache__").glob("waved.shaped-*.o"))
    del sys.modules["waved"]


def test_arrays_must_lie_row_by_row() -> None:
    kernel = Kernel("azee_rig.skin_kernel", "blended")
    for wrong in (np.zeros((3, 3)).T[:, :2], np.zeros(3, dtype=np.float32)):
        with pytest.raises(ValueError, match="row by row"):
            kernel(1, wrong)


@pytest.mark.long
def test_all_our_kernels_are_kept(python: Python) -> None:
    """Else each process would import numba: they name nothing that machine code cannot have."""
    script = """
import sys
import azee_solver.program, azee_solver.kinematics, azee_solver.winding, azee_rig.skin
from azee_rig.machine_code import Kernel
from azee_solver import kinematics, program, winding
modules = [m for n, m in sys.modules.items() if n.startswith("azee_")]
kernels = {id(k): k for m in modules for k in vars(m).values() if isinstance(k, Kernel)}
for kernel in kernels.values():
    kernel.address
print(len(kernels), "numba" in sys.modules)
"""
    python("-c", script, expect=0)
    assert python("-c", script, expect=0).stdout.split() == ["7", "False"]


@pytest.mark.parametrize(
    "kernel", [program._OBJECTIVE, kinematics._POSE, winding._WIND, skin._BLENDED]
)
def test_a_kernel_names_all_sources_that_go_into_it(kernel: Kernel) -> None:
    """A change in one that it does not name would go unnoticed."""
    named = {*kernel._sources, "azee_rig.machine_code"}
    assert kernel._files()
    for file in kernel._files():
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module and node.module[:4] == "azee":
                parts = node.module.split(".")
                packages = {".".join(parts[: n + 1]) for n in range(len(parts))}
                assert packages & named, f"{file.name} imports {node.module}"
