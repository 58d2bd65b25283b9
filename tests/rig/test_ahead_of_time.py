"""Object code that came with a wheel: taken where all of it is right, else ignored."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from programs import Python

from azee_rig import ahead_of_time, machine_code
from azee_rig.machine_code import Kernel
from azee_rig.object_code import Target, host

NAME, SOURCES, CODE = "part.kernel", "ab" * 32, bytes(range(256)) * 8
THIS = Target("x86_64-unknown-linux-gnu", "x86-64-v3", frozenset({"avx2", "sse4.2"}))


def put(folder: Path, target: Target, code: bytes = CODE) -> None:
    ahead_of_time.write(folder, target, {NAME: (SOURCES, code)}, {"numba": "0"})


def found(sources: str = SOURCES) -> bytes | None:
    ahead_of_time._manifest.cache_clear()
    return ahead_of_time.brought(NAME, sources)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of object code for THIS, on a machine that has one feature more."""
    monkeypatch.setattr(ahead_of_time, "FOLDER", tmp_path)
    has = replace(THIS, cpu="znver3", features=THIS.features | {"sha"})
    monkeypatch.setattr(ahead_of_time, "host", lambda: has)
    put(tmp_path, THIS)
    return tmp_path


@pytest.mark.usefixtures("folder")
def test_code_is_found_by_name_and_sources() -> None:
    assert found() == CODE
    assert found("cd" * 32) is None
    assert ahead_of_time.brought("part.other", SOURCES) is None


@pytest.mark.parametrize(
    ("triple", "features", "runs"),
    [
        ("x86_64-unknown-linux-gnu", {"avx2", "sse4.2"}, True),
        ("x86_64-conda-linux-gnu", {"avx2", "sse4.2", "avx512f"}, True),
        ("x86_64-unknown-linux-gnu", {"sse4.2"}, False),
        ("x86_64-unknown-linux-musl", {"avx2", "sse4.2"}, False),
        ("x86_64-apple-darwin", {"avx2", "sse4.2"}, False),
        ("aarch64-unknown-linux-gnu", {"avx2", "sse4.2"}, False),
    ],
)
def test_it_must_be_for_this_system_and_processor(
    folder: Path, triple: str, features: set[str], runs: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    machine = Target(triple, "any", frozenset(features))
    monkeypatch.setattr(ahead_of_time, "host", lambda: machine)
    assert found() == (CODE if runs else None)


def test_one_wrong_byte_of_the_code_is_noticed(folder: Path) -> None:
    file = folder / ahead_of_time.file_name(NAME)
    for place in (0, 1000, len(CODE) - 1):
        damaged = bytearray(CODE)
        damaged[place] ^= 1
        file.write_bytes(damaged)
        assert found() is None
    for cut in (CODE[:-1], CODE + b"\0", b""):
        file.write_bytes(cut)
        assert found() is None
    file.unlink()
    assert found() is None


def test_a_changed_manifest_is_noticed(folder: Path) -> None:
    """A feature that is taken out of it must not let code run that uses that feature."""
    file = folder / ahead_of_time.MANIFEST
    whole = json.loads(file.read_bytes())
    assert found() == CODE
    for key, value in (
        ("features", ["sse4.2"]),
        ("cpu", "x86-64"),
        ("triple", "x86_64-a-linux-gnu"),
    ):
        changed = {**whole, "target": {**whole["target"], key: value}}
        file.write_text(json.dumps(changed), encoding="utf-8")
        assert found() is None
    kernels = {NAME: {**whole["kernels"][NAME], "sources": "cd" * 32}}
    file.write_text(json.dumps({**whole, "kernels": kernels}), encoding="utf-8")
    assert found("cd" * 32) is None


@pytest.mark.parametrize(
    "text",
    [
        *(
            "",
            "{",
            "[]",
            "null",
            "{}",
            '{"format": 2}',
            '{"format": 1}',
            '{"format": 1, "target": 3}',
        ),
        '{"format": 1, "target": {"triple": "", "cpu": "", "features": 7}, "kernels": {}}',
        '{"format": 1, "target": {"triple": "", "cpu": "", "features": []}, "kernels": [1]}',
        "\udcff",
    ],
)
def test_a_manifest_that_is_none_is_as_if_it_were_not_there(folder: Path, text: str) -> None:
    (folder / ahead_of_time.MANIFEST).write_bytes(text.encode("utf-8", "surrogateescape"))
    assert found() is None


RUN = """
import sys
from pathlib import Path
import numpy as np
from azee_rig import ahead_of_time, machine_code
from azee_rig.machine_code import Kernel
sys.path.insert(0, sys.argv[1])
ahead_of_time.FOLDER = Path(sys.argv[2])
kernel, out = Kernel("tripled", "triple", "azee_rig.pointers"), np.empty(3)
if sys.argv[3:]:
    from azee_rig.object_code import host, object_code
    made = {kernel.full_name: (kernel.digest, object_code(kernel.llvm(), kernel.symbol))}
    ahead_of_time.write(ahead_of_time.FOLDER, host(), made, {})
else:
    kernel(3, np.arange(3.0), out)
    print("numba" in sys.modules, out.tolist(), kernel.is_on_disk())
"""
SOURCE = '''
"""A kernel for tests."""
from numba import cfunc

from azee_rig.pointers import WORDS, carray, reals


@cfunc(WORDS, error_model="numpy")
def triple(words):
    w = carray(words, (3,))
    x, out = reals(w[1], (w[0],)), reals(w[2], (w[0],))
    for i in range(w[0]):
        out[i] = 3.0 * x[i]
'''


@pytest.mark.slow
@pytest.mark.skipif(not machine_code.KEEPS, reason="numba keeps its own code here")
def test_it_runs_without_numba_and_is_compiled_where_it_is_wrong(
    python: Python, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    source, folder = tmp_path / "tripled.py", tmp_path / "compiled"
    source.write_text(SOURCE, encoding="utf-8")
    folder.mkdir()
    arguments = ("-c", RUN, str(tmp_path), str(folder))
    python(*arguments, "write", expect=0)
    brought = python(*arguments, expect=0)
    assert (brought.stdout.strip(), brought.stderr) == ("False [0.0, 3.0, 6.0] True", "")
    assert not (tmp_path / "cache").exists()
    (file,) = folder.glob("*.o")
    file.write_bytes(b"\xcc" * 4096)  # stops a process that runs it
    compiled = python(*arguments, expect=0)
    assert (compiled.stdout.strip(), compiled.stderr) == ("True [0.0, 3.0, 6.0] True", "")


@pytest.mark.skipif(not machine_code.KEEPS, reason="numba keeps its own code here")
def test_a_kernel_that_was_brought_is_linked_as_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Even where none is stored: nothing is compiled, and nobody is told of compiling."""
    names = ("azee_rig.skin_kernel", "unit_turns", "azee_rig.pointers")
    code, kernel = Kernel(*names)._kept(), Kernel(*names)
    monkeypatch.setattr(ahead_of_time, "FOLDER", tmp_path)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setattr(Kernel, "llvm", lambda _: pytest.fail("it was compiled"))
    ahead_of_time._manifest.cache_clear()
    assert not kernel.is_on_disk()
    ahead_of_time.write(tmp_path, host(), {kernel.full_name: (kernel.digest, code)}, {})
    ahead_of_time._manifest.cache_clear()
    assert kernel.is_on_disk()
    assert kernel._kept() == code
    assert kernel.address
    ahead_of_time._manifest.cache_clear()


def test_host_tells_what_this_processor_has() -> None:
    assert host().runs_on(host())
    assert not replace(host(), features=host().features | {"none such"}).runs_on(host())
    assert host().features
