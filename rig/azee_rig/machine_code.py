"""Compiled loops, stored on disk as machine code and loaded without numba.

numba compiles them once per machine. Importing numba and loading its cache takes longer than
solving a sentence. So on Linux the machine code is stored here: an object file made from the
compiled function's LLVM code, which llvmlite links in a few milliseconds. On other systems, and if
anything of this fails, numba does it, more slowly and with the same results.

A stored file is valid for the sources that it was made from, in all their files, for one version of
LLVM and one processor. It is written beside its place and renamed, and its checksum is verified
when it is read.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
import re
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

KEEPS = sys.platform == "linux" and struct.calcsize("P") == 8
"""Whether machine code is stored here. If not, numba stores its own."""

SUM_BYTES = 32
LIBRARY = frozenset(
    {"abort", "atan2", "cos", "memcpy", "memmove", "memset", "sin", "sincos", "sqrt"}
)
"""Functions of C that kernels may call."""
TRAPS = frozenset(
    {
        "NRT_Free",
        "NRT_MemInfo_call_dtor",
        "numba_do_raise",
        "numba_gil_ensure",
        "numba_gil_release",
        "numba_runtime_build_excinfo_struct",
        "numba_unpickle",
    }
)
"""Functions of numba that every compiled function names for raising errors or freeing memory."""

_DECLARED = re.compile(r'^declare (.*?@"?([\w.$]+)"?\(.*)$', re.MULTILINE)
_EXTERNAL = re.compile(
    r"^(@\S+ = )external (?:local_unnamed_addr )?(global|constant) ([^,\n]+)", re.M
)


class Unkept(Exception):  # noqa: N818 - it is no fault
    """Machine code can neither be stored nor loaded here; numba can do it."""


_KERNELS: list[Kernel] = []
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
    missing = sum(not other.is_on_disk() for other in _KERNELS)
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
        _KERNELS.append(self)

    @cached_property
    def address(self) -> int:
        """Its address in memory."""
        if KEEPS:
            with suppress(Unkept):
                return _linked(self.name, _symbol(self.name), self._kept())
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

    def _kept(self) -> bytes:
        """Return machine code from disk, after making it if necessary. Raises: Unkept."""
        file, folders = self._file(), list(_folders(self._files()[0]))
        for folder in folders:
            with suppress(OSError):
                data = (folder / file).read_bytes()
                if hashlib.sha256(data[SUM_BYTES:]).digest() == data[:SUM_BYTES]:
                    return data[SUM_BYTES:]
        _tell_of(self)
        code = _machine_code(self._compiled().inspect_llvm(), _symbol(self.name))
        for folder in folders:
            with suppress(OSError):
                _store(folder, file, hashlib.sha256(code).digest() + code)
                break
        return code

    def _file(self) -> str:
        return f"{self.module}.{self.name}-{_machine()}-{self._digest()}.o"

    def is_on_disk(self) -> bool:
        """Whether its machine code was stored. Raises: Unkept."""
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

    def _digest(self) -> str:
        digest = hashlib.sha256()
        for file in self._files():
            digest.update(file.read_bytes())
        return digest.hexdigest()[:16]


_EIGHT_BYTES = frozenset((np.dtype(np.float64), np.dtype(np.int64)))


def address(array: NDArray[Any]) -> int:
    """Return where an array lies in memory, for a kernel; whoever keeps it keeps the array, too.

    Raises: ValueError: its numbers are not of eight bytes, or not row by row.
    """
    if not array.flags.c_contiguous or array.dtype not in _EIGHT_BYTES:
        raise ValueError("kernels take eight-byte numbers, row by row")
    found: int = array.__array_interface__["data"][0]
    return found


def _symbol(name: str) -> str:
    """Return the name of a kernel in its object file."""
    return f"azee_{name}"


@lru_cache(maxsize=1)
def _machine() -> str:
    """Return processor and version of LLVM, as a short name."""
    llvm = _llvm()
    features = llvm.get_host_cpu_features().flatten()
    told = (llvm.get_host_cpu_name(), features, *map(str, llvm.llvm_version_info))
    return hashlib.sha256(" ".join(told).encode()).hexdigest()[:12]


@lru_cache(maxsize=1)
def _llvm() -> Any:
    """Return llvmlite's binding, initialised. Raises: Unkept."""
    try:
        import llvmlite.binding as llvm

        with suppress(RuntimeError):  # newer versions do it themselves, and refuse
            llvm.initialize()
        llvm.initialize_native_target()
        llvm.initialize_native_asmprinter()
    except (ImportError, OSError, RuntimeError) as error:
        raise Unkept(str(error)) from error
    return llvm


def _target_machine() -> Any:
    llvm = _llvm()
    return llvm.Target.from_default_triple().create_target_machine(
        cpu=llvm.get_host_cpu_name(),
        features=llvm.get_host_cpu_features().flatten(),
        opt=3,
        codemodel="jitdefault",
        jit=True,
    )


def _machine_code(source: str, symbol: str) -> bytes:
    """Return object code of a compiled function, which may call only C. Raises: Unkept."""
    llvm = _llvm()
    try:
        module = llvm.parse_assembly(_closed(source))
        entries = [f for f in module.functions if f.name.startswith("cfunc.")]
        if len(entries) != 1:
            raise Unkept("no single entry")
        entries[0].name = symbol
        module.verify()
        code = bytes(_target_machine().emit_object(module))
    except RuntimeError as error:
        raise Unkept(str(error)) from error
    foreign = _undefined(code) - LIBRARY
    if foreign:
        raise Unkept(f"calls {', '.join(sorted(foreign))}")
    return code


def _closed(source: str) -> str:
    """Remove the names of numba's and Python's functions from LLVM code.

    numba names functions for errors and for freeing memory. Our kernels never call them; if one
    did, the process would end. Other names stay, and are checked later.
    """

    def defined(found: re.Match[str]) -> str:
        whole, name = found[1], found[2]
        if name not in TRAPS and not name.startswith(("Py", "_Py")):
            return found[0]
        return f"define internal {whole} {{\n  call void @abort()\n  unreachable\n}}"

    closed = _DECLARED.sub(defined, source)
    closed = _EXTERNAL.sub(r"\1internal \2 \3 zeroinitializer", closed)
    return closed if "declare void @abort()" in closed else f"{closed}\ndeclare void @abort()\n"


def _undefined(code: bytes) -> frozenset[str]:
    """Return names that an object file (ELF, 64 bits) leaves undefined. Raises: Unkept."""
    try:
        if code[:6] != b"\x7fELF\x02\x01":
            raise Unkept("no ELF")
        (table,) = struct.unpack_from("<Q", code, 0x28)
        size, count = struct.unpack_from("<HH", code, 0x3A)
        sections = [struct.unpack_from("<IIQQQQIIQQ", code, table + n * size) for n in range(count)]
        names = set()
        for kind, at, length, link in ((s[1], s[4], s[5], s[6]) for s in sections):
            if kind != 2:  # not a symbol table
                continue
            for entry in range(at, at + length, 24):
                name, _, _, section = struct.unpack_from("<IBBH", code, entry)
                if section == 0 and name:
                    start = sections[link][4] + name
                    names.add(code[start : code.index(0, start)].decode())
        return frozenset(names)
    except (struct.error, IndexError, ValueError) as error:
        raise Unkept(str(error)) from error


_engines: list[Any] = []
"""Keeps linked code in memory."""


def _linked(name: str, symbol: str, code: bytes) -> int:
    """Link machine code into this process; return the address of its entry. Raises: Unkept."""
    llvm = _llvm()
    try:
        engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _target_machine())
        engine.add_object_file(llvm.ObjectFileRef.from_data(code))
        engine.finalize_object()
        address = engine.get_function_address(symbol)
    except RuntimeError as error:
        raise Unkept(str(error)) from error
    if not address:
        raise Unkept(f"{name} is not in its machine code")
    _engines.append(engine)
    return int(address)


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
