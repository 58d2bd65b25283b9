"""Joint coordinates: one number per anatomical degree of freedom, with its limits."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from azee_rig.skeleton import frozen


@dataclass(frozen=True, eq=False)
class Coordinates:
    """The coordinates of a rig, radians, counted from the zero pose.

    names: (V,), such as `f_arm_R.pronation`, `index_L_1.flexion`, `back_1.axial`.
    lower, upper: (V,) limits. idle: (V,) the idle posture. bind: (V,) the mesh's own posture.
    stiffness: (V,) weights of the posture cost (trunk 6, clavicle 3, wrist 1.5, others 1).
    """

    names: tuple[str, ...]
    lower: NDArray[np.float64]
    upper: NDArray[np.float64]
    idle: NDArray[np.float64]
    bind: NDArray[np.float64]
    stiffness: NDArray[np.float64]

    def __post_init__(self) -> None:
        for field in ("lower", "upper", "idle", "bind", "stiffness"):
            array = frozen(getattr(self, field), np.float64)
            if array.shape != (len(self.names),):
                raise ValueError(f"{field} does not have one value per coordinate")
            object.__setattr__(self, field, array)
        if np.any(self.lower >= self.upper):
            raise ValueError("a lower limit is not below its upper limit")

    @cached_property
    def index(self) -> dict[str, int]:
        """Index of each coordinate by name."""
        return {name: i for i, name in enumerate(self.names)}

    def __len__(self) -> int:
        return len(self.names)
