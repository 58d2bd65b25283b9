"""One replaced range of a text, which can be taken back."""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class TextChange:
    """`text[start:end]` becomes `insert`. Offsets count code points."""

    start: int
    end: int
    insert: str

    @classmethod
    def between(cls, old: str, new: str) -> TextChange:
        """Return the shortest single change that makes a text another one."""
        shorter = min(len(old), len(new))
        start = next((i for i in range(shorter) if old[i] != new[i]), shorter)
        most = shorter - start
        same = next((i for i in range(most) if old[-1 - i] != new[-1 - i]), most)
        return cls(start, len(old) - same, new[start : len(new) - same])

    def applied(self, text: str) -> str:
        """Return the text with the change."""
        return text[: self.start] + self.insert + text[self.end :]

    def inverse(self, text: str) -> TextChange:
        """Return the change that takes this one back, for the text before it."""
        return TextChange(self.start, self.start + len(self.insert), text[self.start : self.end])

    def as_json(self, text: str) -> dict[str, object]:
        """Return it as CodeMirror takes changes, for the text before it: in UTF-16 units."""
        units = CodeUnits(text)
        return {"from": units(self.start), "to": units(self.end), "insert": self.insert}


class CodeUnits:
    """Offsets of a text in UTF-16 code units, in which browsers and editors count."""

    def __init__(self, text: str) -> None:
        self._double = [i for i, c in enumerate(text) if c > "\uffff"]

    def __call__(self, offset: int) -> int:
        """Return the number of code units before an offset in code points."""
        return offset + bisect_left(self._double, offset)
