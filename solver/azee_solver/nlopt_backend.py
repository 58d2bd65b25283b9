"""NLopt, behind two names: the only module that imports it.

`minimise` takes any Python objective. `Compiled` hands NLopt's C interface, which its wheel
exports, the address of compiled code: no Python runs between evaluations, which saves more time
than most objectives take, and every number is the same. Where a wheel does not export it the same
code is called through Python.

NLopt's own verdict says nothing about constraints met, so nothing of it is handed on: callers
measure. What is guarded here: a start outside the bounds and a NaN both end in an exception
without a message, an optimum may lie outside the bounds by a rounding error, and a solver that
gives up loses the best point it had seen.
"""

from __future__ import annotations

import ctypes
import math
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from weakref import ref

import nlopt
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ALGORITHMS = (nlopt.LD_LBFGS, nlopt.LD_VAR2, nlopt.LD_TNEWTON_PRECOND_RESTART)
"""Tried in this order until one gets anywhere (Nocedal 1980; Luksan's codes, as in NLopt)."""

MEMORY = 8
"""Steps that the quasi-Newton methods remember. NLopt's own choice, hundreds, costs more time than
the objective and saves hardly any evaluations."""

GIVES_UP = (
    RuntimeError,
    ValueError,
    nlopt.RoundoffLimited,
    nlopt.ForcedStop,
    getattr(nlopt, "exception", RuntimeError),
)
"""What NLopt raises when a descent ends early. Newer wheels have exceptions of their own, whose
base is none of Python's."""

UNDEFINED = 1e300
"""Stands for NaN, so that a line search backs off."""


@dataclass(frozen=True, slots=True, eq=False)
class Minimum:
    """A point inside the bounds, and the objective there."""

    x: Array
    value: float


def minimise(
    objective: Callable[[Array, Array], float],
    start: Array,
    lower: Array,
    upper: Array,
    *,
    max_evaluations: int,
    tolerance: float,
) -> Minimum:
    """Return the lowest point that a descent from `start` comes by.

    Args: objective: value at x; writes its gradient into the second argument unless that is
        empty. lower, upper: bounds, (n,). tolerance: relative change of the objective that ends
        the descent.
    """
    first = np.clip(start, lower, upper)
    best = _Best(objective, first)
    origin = best.value
    for algorithm in ALGORITHMS:
        optimiser = nlopt.opt(algorithm, len(first))
        optimiser.set_lower_bounds(lower)
        optimiser.set_upper_bounds(upper)
        best.stop = optimiser.force_stop
        optimiser.set_min_objective(best)
        optimiser.set_ftol_rel(tolerance)
        optimiser.set_maxeval(max_evaluations)
        optimiser.set_vector_storage(MEMORY)
        try:
            optimiser.optimize(first)
            gave_up = False
        except GIVES_UP:
            if best.failure is not None:
                raise best.failure from None
            gave_up = best.value >= origin
        if not gave_up:
            break
    return Minimum(np.clip(best.x, lower, upper), best.value)


class _Best:
    """The objective, remembering the lowest point it was asked for, and what it raised.

    An exception, such as that of Ctrl-C, ends the descent by `stop`. It is not raised into NLopt,
    whose interface goes on for some evaluations with the exception pending: whatever runs
    meanwhile, a look for garbage too, fails then. One that comes outside `_evaluated` still is.
    """

    def __init__(self, objective: Callable[[Array, Array], float], first: Array) -> None:
        self.objective = objective
        self.x = first.copy()
        self.value = math.inf
        self.failure: BaseException | None = None
        self.stop: Callable[[], None] = lambda: None
        self.value = self._evaluated(first, np.empty(len(first)))

    def __call__(self, x: Array, gradient: Array) -> float:
        if self.failure is None:
            try:
                return self._evaluated(x, gradient)
            except BaseException as failure:
                self.failure = failure
        self.stop()
        gradient[:] = 0.0
        return UNDEFINED

    def _evaluated(self, x: Array, gradient: Array) -> float:
        value = self.objective(x, gradient)
        if not math.isfinite(value):
            gradient[:] = 0.0
            return UNDEFINED
        if value < self.value:
            self.value = value
            self.x[:] = x
        return value


# Through C ------------------------------------------------------------------------------------

_POINTER = ctypes.c_void_p
_SIGNATURES = {
    "nlopt_create": (_POINTER, (ctypes.c_int, ctypes.c_uint)),
    "nlopt_destroy": (None, (_POINTER,)),
    "nlopt_set_lower_bounds": (ctypes.c_int, (_POINTER, _POINTER)),
    "nlopt_set_upper_bounds": (ctypes.c_int, (_POINTER, _POINTER)),
    "nlopt_set_min_objective": (ctypes.c_int, (_POINTER, _POINTER, _POINTER)),
    "nlopt_set_ftol_rel": (ctypes.c_int, (_POINTER, ctypes.c_double)),
    "nlopt_set_maxeval": (ctypes.c_int, (_POINTER, ctypes.c_int)),
    "nlopt_set_vector_storage": (ctypes.c_int, (_POINTER, ctypes.c_uint)),
    "nlopt_optimize": (ctypes.c_int, (_POINTER, _POINTER, _POINTER)),
}
"""Result and arguments of the functions that are used; see NLopt's C reference."""

OUT_OF_MEMORY = -3


@lru_cache(maxsize=1)
def c_interface() -> ctypes.CDLL | None:
    """Return NLopt's C functions as its Python wheel exports them, or none if it does not."""
    try:
        library = ctypes.CDLL(nlopt.nlopt._nlopt.__file__)
        for name, (result, arguments) in _SIGNATURES.items():
            function = getattr(library, name)
            function.restype, function.argtypes = result, arguments
    except (AttributeError, OSError):
        return None
    return library


class _Owned(ref["Compiled"]):
    """NLopt's objects of one `Compiled`, by algorithm, for when it is gone.

    They are not destroyed in its `__del__`: Python drops what is raised there, and so would lose a
    Ctrl-C. What this calls instead, to append it to `_LET_GO`, is C, during which none is raised.
    """

    def __init__(self, owner: Compiled, callback: Callable[[_Owned], object]) -> None:
        super().__init__(owner, callback)  # type: ignore[call-arg]  # takes both, says typeshed
        self.optimisers: dict[int, int] = {}
        _OWNED.add(self)


_OWNED: set[_Owned] = set()
"""All, as only one that is alive itself hears of its owner's end."""
_LET_GO: deque[_Owned] = deque()
"""Those whose owner is gone."""


def _destroy_unowned(library: ctypes.CDLL) -> None:
    """Destroy NLopt's objects of all that are gone."""
    while _LET_GO:
        with suppress(IndexError):  # another thread was faster
            owned = _LET_GO.popleft()
            _OWNED.discard(owned)
            while owned.optimisers:
                _, optimiser = owned.optimisers.popitem()
                library.nlopt_destroy(optimiser)


class Compiled:
    """Compiled code that NLopt can call, the problem it works on, and NLopt's objects for both.

    Making an optimiser takes as long as some evaluations, so each is made once and kept for all
    descents on the problem: the first algorithm's at once, others if ever it gives up.
    """

    def __init__(self, function: int, block: int, lower: Array, upper: Array, best: Array) -> None:
        """Keep what stays the same.

        Args: function: address of an `nlopt_func`. block: address that it is handed. lower, upper:
            bounds, (n,). best: (1 + n,) where the function keeps the lowest value so far and its
            point.
        """
        self.function, self.block = function, block
        self.lower, self.upper, self.best = lower, upper, best
        self._x = np.empty(len(lower))
        self._at, self._value = address(self._x), ctypes.c_double()
        self._found = ctypes.byref(self._value)
        self._optimisers = _Owned(self, _LET_GO.append).optimisers
        self._ends: dict[int, tuple[float, int]] = {}
        library = c_interface()
        if library is not None:
            _destroy_unowned(library)
            self._optimiser(library, ALGORITHMS[0])

    def _optimiser(self, library: ctypes.CDLL, algorithm: int) -> int:
        """Return NLopt's object for an algorithm."""
        optimiser = self._optimisers.get(algorithm)
        if optimiser is None:
            optimiser = library.nlopt_create(algorithm, len(self.lower))
            if not optimiser:
                raise MemoryError("NLopt")
            self._optimisers[algorithm] = optimiser
            library.nlopt_set_lower_bounds(optimiser, address(self.lower))
            library.nlopt_set_upper_bounds(optimiser, address(self.upper))
            library.nlopt_set_min_objective(optimiser, self.function, self.block)
            library.nlopt_set_vector_storage(optimiser, MEMORY)
        return optimiser

    def minimise(self, start: Array, *, max_evaluations: int, tolerance: float) -> Minimum | None:
        """Do what the function `minimise` does; none where NLopt's C cannot be reached.

        The same numbers come of both.
        """
        library, best = c_interface(), self.best
        if library is None:
            return None
        first = start.clip(self.lower, self.upper)
        best[0], best[1:] = math.inf, first
        for algorithm in ALGORITHMS:
            optimiser = self._optimiser(library, algorithm)
            if self._ends.get(algorithm) != (tolerance, max_evaluations):
                self._ends[algorithm] = tolerance, max_evaluations
                library.nlopt_set_ftol_rel(optimiser, tolerance)
                library.nlopt_set_maxeval(optimiser, max_evaluations)
            self._x[:] = first
            result = library.nlopt_optimize(optimiser, self._at, self._found)
            if result == OUT_OF_MEMORY:
                raise MemoryError("NLopt")
            if result > 0 or best[1:].tobytes() != first.tobytes():
                break
        return Minimum(best[1:].clip(self.lower, self.upper), float(best[0]))


def address(array: NDArray[np.float64] | NDArray[np.int64]) -> int:
    """Address of an array's first number."""
    return int(array.__array_interface__["data"][0])
