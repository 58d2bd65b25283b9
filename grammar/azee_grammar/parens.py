"""Finds where parentheses that are open at the end of a line are closed, if anywhere."""

from __future__ import annotations

import re

_LINE = re.compile(r"[^\r\n]*(?:\r\n|\r|\n|\Z)")
_PAREN = re.compile(r"""[()]|"[^"\r\n]*"|(?:(?<=\s)|^)\#.*""", re.MULTILINE)
_ITEM = re.compile(r"(?:def|use)(?=\s|\Z)")


class Closings:
    """Says whether parentheses that are open where a line begins are closed further down.

    A line that begins with `def` or `use` is never inside parentheses, so none is closed beyond it.
    A query is fast: the lowest balance of the text after each line is computed once.
    """

    def __init__(self, text: str) -> None:
        starts: list[int] = []
        balances: list[int] = []  # before each line: opened so far, less closed
        lowest: list[int] = []  # within each line, counted from the beginning of the text
        balance = at = 0
        while at < len(text):
            line = _LINE.match(text, at)
            assert line
            starts.append(at)
            balances.append(balance)
            low = balance
            for found in _PAREN.finditer(line.group()):
                balance += (found.group() == "(") - (found.group() == ")")
                low = min(low, balance)
            lowest.append(low)
            at = line.end()
        self._drop: dict[int, int] = {}
        low = balance
        for start, before, within in zip(
            reversed(starts), reversed(balances), reversed(lowest), strict=True
        ):
            low = min(low, within)
            if _ITEM.match(text, start):
                low = before
            self._drop[start] = before - low

    def closes(self, line_start: int, depth: int) -> bool:
        """Whether at least `depth` parentheses open before a line are closed from it on."""
        return self._drop.get(line_start, 0) >= depth
