"""The capsules of the stick body that must stay apart, for some constraints."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray
from stick_body import stick_body

from azee_solver.anatomy import anatomy
from azee_solver.binding import Binding
from azee_solver.collisions import Obstacles
from azee_solver.constraint import Constraint
from azee_solver.geometry import (
    Side,
)

Array = NDArray[np.float64]


RIG = stick_body()


BODY = anatomy(RIG.chain, RIG.coordinates)


def obstacles(*constraints: Constraint) -> Obstacles:
    return Obstacles(Binding(RIG, Side.RIGHT), BODY, constraints)


def pair(these: Obstacles, first: str, second: str) -> int:
    names = RIG.capsules.names
    wanted = {names.index(first), names.index(second)}
    return next(n for n, (i, j) in enumerate(these.pairs) if {int(i), int(j)} == wanted)


coordinate = st.floats(-1, 1).map(lambda x: round(x, 2))
