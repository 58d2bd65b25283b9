"""Collects what a notation does not allow, while it is read all the same."""

from __future__ import annotations

from math import isfinite

from lxml import etree

from azee.lexicon.model import NotationFault

SLOWEST, FASTEST = 0.1, 10.0


class FaultLog:
    """The faults of one sign, each once."""

    def __init__(self) -> None:
        self._faults: dict[NotationFault, None] = {}

    @property
    def faults(self) -> tuple[NotationFault, ...]:
        """What was found, in the order of the text."""
        return tuple(self._faults)

    def add(self, kind: str, detail: str, line: int | None = None) -> None:
        """Note a fault."""
        self._faults[NotationFault(kind, detail, line or 0)] = None

    def number(self, element: etree._Element, name: str) -> float:
        """Return a factor such as a speed, 1 unless said."""
        text = element.get(name)
        if text is None:
            return 1.0
        try:
            value = float(text)
        except ValueError:
            value = 0.0
        if not (isfinite(value) and SLOWEST <= value <= FASTEST):
            self.add("unknown-value", f'{name}="{text}" is no factor', element.sourceline)
            return 1.0
        return value
