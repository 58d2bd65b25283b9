"""How often a surface winds around points, and how far its triangles are: compiled.

The generalised winding number (Jacobson et al. 2013) needs no closed surface: a trunk cut open at
neck and sleeves still tells inside from outside.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from azee_rig.machine_code import Kernel

Array = NDArray[np.float64]

_WIND, _MEASURE = (
    Kernel("azee_solver.surfaces", name, "azee_rig.pointers") for name in ("wind", "measure")
)


def winding_numbers(points: Array, triangles: Array) -> Array:
    """Return the winding number of a surface about points, (n,); triangles: (F, 3, 3)."""
    out = np.zeros(len(points))
    _WIND(len(points), len(triangles), _rows(points), _rows(triangles), out)
    return out


def distances(points: Array, triangles: Array) -> Array:
    """Return the distance of points (n, 3) to the nearest of some triangles (F, 3, 3), (n,)."""
    out = np.empty(len(points))
    _MEASURE(len(points), len(triangles), _rows(points), _rows(triangles), out)
    return out


def _rows(array: Array) -> Array:
    return np.ascontiguousarray(array, dtype=np.float64)
