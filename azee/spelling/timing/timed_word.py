"""A spelled word with its times, recorded or drawn, and the CSV that keeps many of them."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

COLUMNS = ("word", "spelling", "letter", "hold_ms", "transition_ms")


class TimesError(ValueError):
    """A file of times cannot be used; the message says where and why."""


@dataclass(frozen=True, slots=True)
class TimedWord:
    """How long each letter of a spelled word was held, and each way to the next letter took.

    word: in capitals. holds_s: one a letter. transitions_s: one fewer, from each letter to the
    next. spelling: 1 for the first time that the word was spelled in its text, 2 for the second.

    Raises: TimesError: the times do not fit the word, or are no times.
    """

    word: str
    holds_s: tuple[float, ...]
    transitions_s: tuple[float, ...]
    spelling: int = 1

    def __post_init__(self) -> None:
        if not self.word or self.word != self.word.upper():
            raise TimesError(f"`{self.word}` is no word in capitals")
        if (len(self.holds_s), len(self.transitions_s)) != (len(self.word), len(self.word) - 1):
            raise TimesError(
                f"`{self.word}` needs {len(self.word)} holds and {len(self.word) - 1} transitions"
            )
        if not all(math.isfinite(t) and t > 0 for t in (*self.holds_s, *self.transitions_s)):
            raise TimesError(f"`{self.word}` has a time that is not above 0")
        if self.spelling < 1:
            raise TimesError(f"spellings of `{self.word}` are counted from 1")

    @property
    def duration_s(self) -> float:
        """From the start of the first hold to the end of the last."""
        return sum(self.holds_s) + sum(self.transitions_s)

    @property
    def hold_spans_s(self) -> tuple[tuple[float, float], ...]:
        """Start and end of each hold, from the start of the first one."""
        spans, start = [], 0.0
        for hold, transition in zip(self.holds_s, (*self.transitions_s, 0.0), strict=True):
            spans.append((start, start + hold))
            start += hold + transition
        return tuple(spans)


def write_times(words: Iterable[TimedWord], path: str | Path) -> None:
    """Write words as CSV, a letter a row; the last letter of a word has no transition.

    Raises: OSError: the file cannot be written.
    """
    with Path(path).open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(COLUMNS)
        for word in words:
            for letter, hold, transition in zip(
                word.word, word.holds_s, (*word.transitions_s, None), strict=True
            ):
                passed = "" if transition is None else f"{1000 * transition:.2f}"
                rows.writerow((word.word, word.spelling, letter, f"{1000 * hold:.2f}", passed))


def read_times(path: str | Path) -> Sequence[TimedWord]:
    """Read what `write_times` wrote, or a table with the same columns.

    Raises: TimesError: the file is no such table. OSError: it cannot be read.
    """
    with Path(path).open(encoding="utf-8-sig", newline="") as file:
        try:
            table = csv.DictReader(file)
            missing = set(COLUMNS) - set(table.fieldnames or ())
            if missing:
                raise TimesError(f"`{path}` has no column `{min(missing, key=COLUMNS.index)}`")
            rows = list(enumerate(table, 2))
        except (UnicodeDecodeError, csv.Error) as error:
            raise TimesError(f"`{path}` is no CSV in UTF-8") from error
    words = [_word(path, list(group)) for group in _words(rows)]
    if not words:
        raise TimesError(f"`{path}` holds no words")
    return words


def _words(rows: list[tuple[int, dict[str, str]]]) -> Iterator[list[tuple[int, dict[str, str]]]]:
    """Yield the rows of each word: it ends where no transition follows."""
    word: list[tuple[int, dict[str, str]]] = []
    for row in rows:
        word.append(row)
        if not row[1]["transition_ms"]:
            yield word
            word = []
    if word:
        yield word


def _word(path: str | Path, rows: list[tuple[int, dict[str, str]]]) -> TimedWord:
    first = rows[0][0]
    names = {(row["word"], row["spelling"]) for _, row in rows}
    spelled = "".join(row["letter"] or "" for _, row in rows)
    if len(names) > 1 or spelled != rows[0][1]["word"]:
        shown = " and ".join(name for name, _ in groupby(row["word"] for _, row in rows))
        raise TimesError(
            f"`{path}`, line {first}: the letters `{spelled}` with transitions between them "
            f"do not spell {shown}"
        )
    try:
        holds = tuple(float(row["hold_ms"]) / 1000 for _, row in rows)
        ways = tuple(float(row["transition_ms"]) / 1000 for _, row in rows if row["transition_ms"])
        return TimedWord(spelled, holds, ways, int(rows[0][1]["spelling"]))
    except (TypeError, ValueError) as error:
        raise TimesError(f"`{path}`, line {first}: {error}") from error
