"""Arrays at addresses, for kernels that take words: nothing is copied, nothing can fail."""

from __future__ import annotations

from typing import Any

import numba
from llvmlite import ir
from numba import njit
from numba.extending import intrinsic

carray: Any = getattr(numba, "carray")  # noqa: B009 - its stubs hide the name
types: Any = numba.types
WORDS = types.void(types.CPointer(types.int64))
"""Signature of a kernel that takes words: numbers, and addresses of arrays."""


INNER: dict[str, Any] = {
    "error_model": "numpy",
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
}
"""Options of functions that only compiled ones call: wrappers take a sixth of compiling."""


@intrinsic
def reals_at(context, address):
    """Return real numbers at an address."""

    def code(context, builder, signature, arguments):
        return builder.inttoptr(arguments[0], ir.DoubleType().as_pointer())

    return types.CPointer(types.float64)(types.int64), code


@intrinsic
def integers_at(context, address):
    """Return integers at an address."""

    def code(context, builder, signature, arguments):
        return builder.inttoptr(arguments[0], ir.IntType(64).as_pointer())

    return types.CPointer(types.int64)(types.int64), code


@njit(**INNER)
def reals(address, shape):
    """Return an array of reals of some shape."""
    return carray(reals_at(address), shape)  # type: ignore[call-arg]


@njit(**INNER)
def integers(address, shape):
    """Return an array of integers of some shape."""
    return carray(integers_at(address), shape)  # type: ignore[call-arg]
