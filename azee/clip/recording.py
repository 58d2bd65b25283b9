"""Motion as it was recorded: rotations of the joints of whatever skeleton it came on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.clip.finite import check_numbers, check_times
from azee_rig.rotation import to_matrices
from azee_rig.skeleton import Skeleton, frozen

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Recording:
    """Motion of a skeleton that need not be a rig's.

    skeleton: its rest posture, metres. Axes are the file's own: nothing says which way is up.
    tips: per last joint where its bone ends, (3,) metres from the joint at rest.
    times: (T,) seconds, increasing from 0. rotations: (T, J, 4) unit quaternions wxyz, each
    relative to the parent. translations: (T, J, 3) metres from the parent's origin, in the
    parent's axes: the skeleton's offsets, but for joints that also slide, such as the root.
    notes: what had to be guessed or put right while reading, for the user.

    Raises: ValueError: the arrays do not fit the skeleton, hold what is no number, or put a joint
        farther away than anything is.
    """

    skeleton: Skeleton
    tips: Mapping[int, Floats]
    times: Floats
    rotations: Floats
    translations: Floats
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        shape = (len(self.times), len(self.skeleton.names))
        if self.rotations.shape != (*shape, 4) or self.translations.shape != (*shape, 3):
            raise ValueError("times, rotations and translations do not fit the skeleton")
        check_times(self.times)
        check_numbers("rotations", self.rotations)
        check_numbers("lengths", self.translations)
        check_numbers("lengths", self.skeleton.offsets)
        check_numbers("lengths", list(self.tips.values()))
        for name in ("times", "rotations", "translations"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.float64))

    def frames(self) -> tuple[Floats, Floats]:
        """World positions (T, J, 3), metres, and rotations (T, J, 3, 3) of all joints."""
        local = to_matrices(self.rotations)
        world = np.empty_like(local)
        places = np.empty(self.translations.shape)
        for j, parent in enumerate(self.skeleton.parents):
            if parent < 0:
                world[:, j], places[:, j] = local[:, j], self.translations[:, j]
                continue
            above = world[:, parent]
            world[:, j] = above @ local[:, j]
            places[:, j] = places[:, parent] + (above @ self.translations[:, j, :, None])[..., 0]
        return places, world
