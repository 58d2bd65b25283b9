"""How long the way from letter to letter takes: a regression on the distance of their poses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from azee.spelling.timing.letter_poses import LetterPoses, rmsd
from azee.spelling.timing.published import FRAME_S


@dataclass(frozen=True, slots=True)
class Transitions:
    """Times of transitions as `offset_s + slope_s · RMSD` (Wheatland 2016, section 4.2.2).

    Either way takes the same time. mean_s: of letters whose poses are not known. double_s: of a
    letter after itself; None if these follow the regression too, as printed.
    """

    offset_s: float
    slope_s: float
    mean_s: float
    double_s: float | None = None

    def way_s(self, a: str, b: str, poses: LetterPoses) -> float:
        """Return the time from one letter to the next."""
        if a == b and self.double_s is not None:
            return self.double_s
        if a == b:
            return self.offset_s
        if a not in poses or b not in poses:
            return self.mean_s
        p, q = poses.of((a, b))
        return max(FRAME_S, self.offset_s + self.slope_s * rmsd(p, q))

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON values."""
        return {name: t if t is None else round(t, 6) for name, t in asdict(self).items()}

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Transitions:
        """Read what `to_json` wrote. Raises: KeyError, TypeError, ValueError."""
        double = data["double_s"]
        offset_s, slope_s, mean_s = (
            float(data[f"{name}_s"]) for name in ("offset", "slope", "mean")
        )
        return cls(offset_s, slope_s, mean_s, None if double is None else float(double))
