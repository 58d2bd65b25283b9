"""Object code of compiled functions: made from their LLVM code, checked, linked into the process.

llvmlite does both in milliseconds once the code is there, without numba. Object code may call
nothing but functions of C.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

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


@dataclass(frozen=True, slots=True)
class Target:
    """What object code runs on.

    triple: of LLVM, as `x86_64-unknown-linux-gnu`. cpu: one of LLVM's names. features: which of
    LLVM's features of processors the code may use.
    """

    triple: str
    cpu: str
    features: frozenset[str]

    def runs_on(self, host: Target) -> bool:
        """Whether a machine has the system and all features. The triple's vendor tells nothing."""
        return _system(self.triple) == _system(host.triple) and self.features <= host.features


def _system(triple: str) -> tuple[str, ...]:
    architecture, _, *rest = triple.split("-")
    return architecture, *rest


@lru_cache(maxsize=1)
def host() -> Target:
    """Return this machine. Raises: Unkept."""
    llvm = binding()
    found: Mapping[str, bool] = llvm.get_host_cpu_features()
    features = frozenset(name for name, has in found.items() if has)
    return Target(llvm.get_process_triple(), llvm.get_host_cpu_name(), features)


@lru_cache(maxsize=1)
def binding() -> Any:
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


def _target_machine(target: Target | None = None) -> Any:
    """Return LLVM's generator of code for a target, or for this processor with all it has.

    The name of a processor implies its features.
    """
    llvm = binding()
    return llvm.Target.from_default_triple().create_target_machine(
        cpu=target.cpu if target else llvm.get_host_cpu_name(),
        features="" if target else llvm.get_host_cpu_features().flatten(),
        opt=3,
        codemodel="jitdefault",
        jit=True,
    )


def object_code(source: str, symbol: str, target: Target | None = None) -> bytes:
    """Return object code of a compiled function, which may call only C.

    Args: source: LLVM code, made by numba for the same target. symbol: the name of its entry.
    target: this machine if there is none.
    Raises: Unkept.
    """
    llvm = binding()
    try:
        module = llvm.parse_assembly(_closed(source))
        entries = [f for f in module.functions if f.name.startswith("cfunc.")]
        if len(entries) != 1:
            raise Unkept("no single entry")
        entries[0].name = symbol
        module.verify()
        code = bytes(_target_machine(target).emit_object(module))
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


def linked(name: str, symbol: str, code: bytes) -> int:
    """Link machine code into this process; return the address of its entry. Raises: Unkept."""
    llvm = binding()
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
