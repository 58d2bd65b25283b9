"""What became of a constraint: met, eased for comfort or missed; what meeting it would cost."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum


class Outcome(Enum):
    """What became of a constraint."""

    MET = "met"
    """Inside our tolerance: 1 mm, 0.5°."""
    EASED = "eased"
    """Inside the tolerance of Nunnari, Filhol and Heloir 2018 (1 cm, 5°), for comfort."""
    MISSED = "missed"


@dataclass(frozen=True, slots=True, order=True)
class Price:
    """What a posture costs beyond the comfortable.

    trunk_rad: angle by which the trunk leans, 0 if by no more than 5°. limits: coordinates of
    trunk, head and arms that are at their limits.
    """

    trunk_rad: float = 0.0
    limits: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return self.trunk_rad > 0.0 or bool(self.limits)

    def __str__(self) -> str:
        """Say it in a phrase, such as `24° of trunk, clav_L.elevation at its limit`."""
        parts = [f"{math.degrees(self.trunk_rad):.0f}° of trunk"] if self.trunk_rad else []
        if self.limits:
            its = "its limit" if len(self.limits) == 1 else "their limits"
            parts.append(f"{', '.join(self.limits)} at {its}")
        return ", ".join(parts)

    def as_json(self) -> dict[str, object]:
        """Return it as the report's JSON has it."""
        return {"trunk_rad": self.trunk_rad, "limits": [*self.limits]}


FREE = Price()


class Reason:
    """Why a constraint is missed, found when it is first asked for, as that takes solving.

    A pickle holds the words, not what they are found with.
    """

    def __init__(self, find: Callable[[], str]) -> None:
        """Take what finds the phrase."""
        self._find: Callable[[], str] | None = find
        self._text = ""
        self.spent_s = 0.0
        """Wall-clock time that finding it has taken so far."""

    @property
    def text(self) -> str:
        """The reason, in one phrase."""
        if self._find is not None:
            began = time.perf_counter()
            self._text = self._find()
            self._find = None
            self.spent_s = time.perf_counter() - began
        return self._text

    def __getstate__(self) -> dict[str, object]:
        """Return the words."""
        return {"_find": None, "_text": self.text, "spent_s": self.spent_s}


@dataclass(frozen=True, slots=True)
class Strain:
    """A price that a posture pays.

    subjects: the constraints that it is paid for, in AZee's notation.
    """

    price: Price
    subjects: tuple[str, ...]

    def __str__(self) -> str:
        """Say it in a phrase."""
        price, parts = self.price, []
        if price.trunk_rad:
            parts.append(f"the trunk leans {math.degrees(price.trunk_rad):.0f}°")
        if price.limits:
            parts.append(f"at the limits of {', '.join(price.limits)}")
        return ", ".join(parts) + (f" for {' and '.join(self.subjects)}" if self.subjects else "")

    def as_json(self) -> dict[str, object]:
        """Return it as the report's JSON has it."""
        return {**self.price.as_json(), "for": [*self.subjects]}
