"""Values out of JSON that somebody else may have written or damaged, each as what it must be.

Every function raises ValueError with the value's place in the file.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Shape = tuple[int | None, ...]
"""Lengths of an array's axes; None is any length."""
LARGEST = 1e6
"""No length, angle or weight of a body is larger, in metres and radians."""


def mapping(value: object, place: str) -> Mapping[str, Any]:
    """Return an object."""
    if not isinstance(value, dict):
        raise ValueError(f"`{place}` is not an object")
    return value


def rows(value: object, place: str) -> Sequence[Mapping[str, Any]]:
    """Return a list of objects."""
    if not isinstance(value, list) or not all(isinstance(row, dict) for row in value):
        raise ValueError(f"`{place}` is not a list of objects")
    return value


def text(value: object, place: str) -> str:
    """Return a text that can be written again: no half of a surrogate pair."""
    if not isinstance(value, str):
        raise ValueError(f"`{place}` has {shown(value)} where a text is wanted")
    try:
        value.encode()
    except UnicodeEncodeError:
        raise ValueError(f"`{place}` has a text that is no Unicode: {value!a:.60}") from None
    return value


def names(value: object, place: str) -> tuple[str, ...]:
    """Return texts, no two of which are the same."""
    if not isinstance(value, list):
        raise ValueError(f"`{place}` is not a list of names")
    found = tuple(text(name, place) for name in value)
    if len(set(found)) < len(found):
        twice = next(name for i, name in enumerate(found) if name in found[:i])
        raise ValueError(f"`{place}` has `{twice}` twice")
    return found


def number(value: object, place: str) -> float:
    """Return a finite number."""
    return float(numbers(value, (), place))


def whole(value: object, place: str) -> int:
    """Return a whole number."""
    return int(wholes(value, (), place))


def numbers(value: object, shape: Shape, place: str) -> NDArray[np.float64]:
    """Return finite numbers in an array of a shape."""
    array = _array(value, "if", shape, place, "numbers")
    if not np.isfinite(array).all():
        raise ValueError(f"`{place}` has a number that is infinite or none")
    if np.abs(array).max(initial=0) > LARGEST:
        raise ValueError(f"`{place}` has a number that no body has, {np.abs(array).max():.3g}")
    return array.astype(np.float64)


def wholes(value: object, shape: Shape, place: str) -> NDArray[np.int64]:
    """Return whole numbers in an array of a shape."""
    return _array(value, "i", shape, place, "whole numbers").astype(np.int64)


def _array(value: object, kinds: str, shape: Shape, place: str, what: str) -> NDArray[Any]:
    try:
        array = np.array(value)
    except (ValueError, OverflowError, RecursionError):
        array = np.array(None)
    if not array.size and array.ndim and len(shape) > 1 and shape[0] is None:
        array = np.zeros([length or 0 for length in shape], dtype=np.int64)
    fits = array.ndim == len(shape) and all(
        want is None or have == want for have, want in zip(array.shape, shape, strict=True)
    )
    empty = not array.size and array.dtype.kind == "f"
    if fits and (array.dtype.kind in kinds or empty):
        return array
    if not shape:
        raise ValueError(f"`{place}` has {shown(value)} where a number is wanted")
    lengths = " × ".join("n" if length is None else str(length) for length in shape)
    raise ValueError(f"`{place}` is not an array of {lengths} {what}")


def shown(value: object) -> str:
    """Return a value as it may stand in a message: short, and in ASCII."""
    if isinstance(value, dict | list):
        return "a list" if isinstance(value, list) else "an object"
    if isinstance(value, int) and not isinstance(value, bool) and abs(value) > 10**30:
        return "a number of more than thirty digits"
    told = ascii(value)
    return told if len(told) <= 40 else f"{told[:37]}…"
