"""Compiled loops, stored on disk as machine code and loaded without numba.

numba compiles them once per machine. Importing numba and loading its cache takes longer than
solving a sentence. So on Linux the machine code is stored here: an object file made from the
compiled function's LLVM code, which llvmlite links in a few milliseconds. On other systems, and if
anything of this fails, numba does it, more slowly and with the same results. A wheel that was built
for a platform brings machine code along; see `azee_rig.ahead_of_time`.

A stored file is valid for the sources that it was made from, in all their files, for one version of
LLVM and one processor. It is written beside its place and renamed, and its checksum is verified
when it is read.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
import struct
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cached_property, lru_cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee_rig.ahead_of_time import brought
from azee_rig.object_code import Unkept, binding, linked, object_code

KEEPS = sys.platform == "linux" and struct.calcsize("P") == 8
"""Whether machine code is stored here. If not, numba stores its own."""

SUM_BYTES = 32

KERNELS: list[Kernel] = []
"""All that modules have named so far."""
_LISTENERS: list[Callable[[int, int], None]] = []
_COMPILED: list[str] = []


@contextmanager
def told_of_compiling(tell: Callable[[int, int], None]) -> Iterator[None]:
    """Tell of each kernel that is compiled, as it begins: which it is, from 1, and of how many.

    That happens on the first run after installing, and takes seconds.
    """
    _LISTENERS.append(tell)
    try:
        yield
    finally:
        _LISTENERS.remove(tell)


def _tell_of(kernel: Kernel) -> None:
    _COMPILED.append(kernel.name)
    missing = sum(not other.is_on_disk() for other in KERNELS)
    for tell in _LISTENERS:
        tell(len(_COMPILED), len(_COMPILED) - 1 + missing)


class Kernel:
    """A function that numba compiles, given by name, loaded on first use.

    It is a `cfunc` that takes one pointer, to words that are numbers or addresses of arrays, or one
    whose address another library calls.
    """

    def __init__(self, module: str, name: str, *sources: str) -> None:
        """Args: sources: modules or packages, beside its own, whose code is part of it."""
        self.module, self.name = module, name
        self._sources = (module, *sources)
        self.full_name = f"{module}.{name}"
        self.symbol = f"azee_{name}"
        """Its name in object code."""
        KERNELS.append(self)

    @cached_property
    def address(self) -> int:
        """Its address in memory."""
        if KEEPS:
            with suppress(Unkept):
                return linked(self.name, self.symbol, self._kept())
        return int(self._compiled().address)

    @cached_property
    def _function(self) -> Any:
        return ctypes.CFUNCTYPE(None, ctypes.c_void_p)(self.address)

    def __call__(self, *words: int | NDArray[Any]) -> None:
        """Call it with numbers and arrays, which must be contiguous in memory, row by row."""
        given = [word if isinstance(word, int) else address(word) for word in words]
        block = np.array(given, dtype=np.int64)
        self._function(block.ctypes.data)

    def _compiled(self) -> Any:
        return getattr(import_module(self.module), self.name)

    def llvm(self) -> str:
        """Compile it by numba; return its LLVM code."""
        return str(self._compiled().inspect_llvm())

    def _kept(self) -> bytes:
        """Return machine code from disk, after making it if necessary. Raises: Unkept."""
        code = brought(self.full_name, self.digest)
        if code is not None:
            return code
        file, folders = self._file(), list(_folders(self._files()[0]))
        for folder in folders:
            with suppress(OSError):
                data = (folder / file).read_bytes()
                if hashlib.sha256(data[SUM_BYTES:]).digest() == data[:SUM_BYTES]:
                    return data[SUM_BYTES:]
        _tell_of(self)
        code = object_code(self.llvm(), self.symbol)
        for folder in folders:
            with suppress(OSError):
                _store(folder, file, hashlib.sha256(code).digest() + code)
                break
        return code

    def _file(self) -> str:
        return f"{self.full_name}-{_machine()}-{self.digest[:16]}.o"

    def is_on_disk(self) -> bool:
        """Whether its machine code was stored, or came with the wheel. Raises: Unkept."""
        if brought(self.full_name, self.digest) is not None:
            return True
        file = self._file()
        return any((folder / file).is_file() for folder in _folders(self._files()[0]))

    def _files(self) -> list[Path]:
        """Return the sources that are part of it."""
        files: list[Path] = []
        for name in self._sources:
            spec = find_spec(name)
            if spec is None or spec.origin is None:
                raise Unkept(name)
            origin = Path(spec.origin)
            package = spec.submodule_search_locations is not None
            files += sorted(origin.parent.glob("*.py")) if package else [origin]
        return files

    @cached_property
    def digest(self) -> str:
        """SHA-256 of its sources, in hexadecimal digits. Raises: Unkept: one is not a file."""
        digest = hashlib.sha256()
        for file in self._files():
            digest.update(file.read_bytes())
        return digest.hexdigest()


_EIGHT_BYTES = frozenset((np.dtype(np.float64), np.dtype(np.int64)))


def address(array: NDArray[Any]) -> int:
    """Return where an array lies in memory, for a kernel; whoever keeps it keeps the array, too.

    Raises: ValueError: its numbers are not of eight bytes, or not row by row.
    """
    if not array.flags.c_contiguous or array.dtype not in _EIGHT_BYTES:
        raise ValueError("kernels take eight-byte numbers, row by row")
    found: int = array.__array_interface__["data"][0]
    return found


@lru_cache(maxsize=1)
def _machine() -> str:
    """Return processor and version of LLVM, as a short name."""
    llvm = binding()
    features = llvm.get_host_cpu_features().flatten()
    told = (llvm.get_host_cpu_name(), features, *map(str, llvm.llvm_version_info))
    return hashlib.sha256(" ".join(told).encode()).hexdigest()[:12]


def _folders(source: Path) -> Iterator[Path]:
    """Yield folders for machine code: beside the source, else in the user's cache."""
    named = os.environ.get("NUMBA_CACHE_DIR")
    if named:
        yield Path(named)
        return
    yield source.parent / "__pycache__"
    home = os.environ.get("XDG_CACHE_HOME")
    with suppress(RuntimeError):
        yield (Path(home) if home else Path.home() / ".cache") / "azee"


def _store(folder: Path, file: str, data: bytes) -> None:
    """Write a file completely or not at all; delete the files of this machine that it replaces."""
    folder.mkdir(parents=True, exist_ok=True)
    beside = folder / f"{file}.{os.getpid()}"
    try:
        beside.write_bytes(data)
        beside.replace(folder / file)
    finally:
        beside.unlink(missing_ok=True)
    stem = file.rsplit("-", 1)[0]
    for other in folder.glob(f"{stem}-*.o"):
        if other.name != file:
            with suppress(OSError):
                other.unlink()
