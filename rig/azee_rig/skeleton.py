"""The body's own joints, as exported: names, parents and rest offsets."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Number = TypeVar("Number", bound=np.generic)


def frozen(array: ArrayLike, dtype: type[Number]) -> NDArray[Number]:
    """Return a read-only copy of an array; an array that nobody can write to is its own copy."""
    if isinstance(array, np.ndarray) and _is_frozen(array, dtype):
        return array
    copy = np.array(array, dtype=dtype)
    copy.setflags(write=False)
    return copy


def _is_frozen(array: NDArray[Any], dtype: type[np.generic]) -> bool:
    """Whether an array is read-only and no view of one that is not."""
    return array.dtype == dtype and array.base is None and not array.flags.writeable


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Joints of a body in the rest pose, in which every joint's axes are the world's.

    names: (J,), parents before children.
    parents: (J,) index of the parent, −1 for the root.
    offsets: (J, 3) metres, from the parent's origin; the root's from the world's.
    """

    names: tuple[str, ...]
    parents: NDArray[np.int64]
    offsets: NDArray[np.float64]

    def __post_init__(self) -> None:
        object.__setattr__(self, "parents", frozen(self.parents, np.int64))
        object.__setattr__(self, "offsets", frozen(self.offsets, np.float64))
        if not len(self.names) == len(self.parents) == len(self.offsets):
            raise ValueError("names, parents and offsets differ in length")
        if any(p >= i for i, p in enumerate(self.parents)):
            raise ValueError("a joint stands before its parent")

    @property
    def rest_positions(self) -> NDArray[np.float64]:
        """World positions of the joints in the rest pose, (J, 3), metres."""
        out = np.array(self.offsets)
        for j, p in enumerate(self.parents):
            if p >= 0:
                out[j] += out[p]
        return out


@dataclass(frozen=True, eq=False)
class Pose:
    """One or many postures of a skeleton.

    root_translation: (…, 3) metres, added to the root's rest offset.
    rotations: (…, J, 4) unit quaternions wxyz, each joint relative to its parent.
    """

    root_translation: NDArray[np.float64]
    rotations: NDArray[np.float64]
