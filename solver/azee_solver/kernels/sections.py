"""Sections of a block as arrays: nothing is copied, nothing can fail."""

from __future__ import annotations

import numpy as np
from numba import njit
from numba.extending import intrinsic

from azee_rig.pointers import INNER, carray, types


@njit(
    [
        words(words, types.int64[::1], types.int64)
        for words in (types.int64[::1], types.float64[::1])
    ],
    **INNER,
)
def part(array, ints, section):
    """Return a section as a flat array."""
    return array[ints[section] : ints[section + 1]]


@intrinsic
def _word(context, array, index):
    """Address of a word of a block."""

    def code(context, builder, signature, arguments):
        found = context.make_array(signature.args[0])(context, builder, arguments[0])
        return builder.gep(found.data, [arguments[1]])

    return types.CPointer(array.dtype)(array, types.int64), code


@njit(**INNER)
def matrix(array, ints, section, rows, columns):
    """Return a section as rows and columns; quicker than to reshape it, which may fail."""
    return carray(_word(array, ints[section]), (rows, columns))  # type: ignore[call-arg]


@njit(**INNER)
def stack(array, ints, section, count, rows, columns):
    """Return a section as so many matrices."""
    place = ints[section]
    return carray(_word(array, place), (count, rows, columns))  # type: ignore[call-arg]


@njit(**INNER)
def along(start, stop):
    """Range of indices that are known not to be negative: LLVM makes vectors of such loops."""
    return range(np.uint64(start), np.uint64(stop))
