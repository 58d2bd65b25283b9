"""The counts of a corpus as tables: for people, as CSV, as JSON."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping, Sequence
from dataclasses import astuple, fields
from typing import Any, TypeAlias

from azee.corpus.statistics import (
    ArgumentCount,
    CorpusStatistics,
    DepthCount,
    PairCount,
    RuleCount,
)
from azee.wording import counted

Row: TypeAlias = RuleCount | ArgumentCount | PairCount | DepthCount

TABLES: Mapping[str, type[Row]] = {
    "rules": RuleCount,
    "unknown": RuleCount,
    "arguments": ArgumentCount,
    "pairs": PairCount,
    "depths": DepthCount,
}
"""Tables by name, each with the class of its rows; the names are those of the properties."""


def rows_of(statistics: CorpusStatistics, table: str) -> Sequence[Row]:
    """Return the rows of a table. Raises: KeyError: there is none of that name."""
    rows: dict[str, Sequence[Row]] = {
        "rules": statistics.rules,
        "unknown": statistics.unknown,
        "arguments": statistics.arguments,
        "pairs": statistics.pairs,
        "depths": statistics.depths,
    }
    return rows[table]


def columns_of(table: str) -> list[str]:
    """Return the names of a table's columns."""
    return [column.name for column in fields(TABLES[table])]


def as_csv(statistics: CorpusStatistics, table: str) -> str:
    """Return a table as CSV (RFC 4180, but lines end with LF); what is not known is empty."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(columns_of(table))
    writer.writerows(astuple(row) for row in rows_of(statistics, table))
    return file.getvalue()


def as_json(statistics: CorpusStatistics) -> str:
    """Return all tables and the summary as JSON."""
    data: dict[str, Any] = {
        "texts": len(statistics.texts),
        "utterances": len(statistics.utterances),
        "applications": len(statistics.applications),
        "known": statistics.known,
        "whole_texts": statistics.whole_texts,
    }
    for table in TABLES:
        names = columns_of(table)
        rows = rows_of(statistics, table)
        data[table] = [dict(zip(names, astuple(row), strict=True)) for row in rows]
    return json.dumps(data, indent=2, ensure_ascii=False) + "\n"


def as_text(statistics: CorpusStatistics, table: str, most: int | None = None) -> str:
    """Return a table in columns for people, at most so many rows of it."""
    rows = rows_of(statistics, table)
    names = columns_of(table)
    shown = [[_cell(value) for value in astuple(row)] for row in rows[:most]]
    widths = [max(map(len, column)) for column in zip(names, *shown, strict=True)]
    numeric = [_is_numeric(rows, i) for i in range(len(names))]
    lines = [_line(cells, widths, numeric) for cells in [names, *shown]]
    if len(rows) > len(shown):
        lines.append(f"… and {len(rows) - len(shown)} more")
    return "\n".join(lines)


def summary(statistics: CorpusStatistics) -> str:
    """Return what is in a corpus and how much of it is known, in two lines."""
    total, known = len(statistics.applications), statistics.known
    spoken = sum(bool(text) for text in statistics.texts)
    size = (
        f"{counted(len(statistics.texts), 'text')}, "
        f"{counted(len(statistics.utterances), 'utterance')}, "
        f"{counted(total, 'application')} of {counted(len(statistics.rules), 'rule')}"
    )
    part = f" ({known / total:.0%})" if total else ""
    return (
        f"{size}\nof known rules: {known} of {total} applications{part}, "
        f"all in {statistics.whole_texts} of {counted(spoken, 'text')}"
    )


def _cell(value: object) -> str:
    match value:
        case None:
            return "–"
        case bool():
            return "yes" if value else "no"
        case float():
            return f"{value:.3f}"
        case _:
            return str(value)


def _is_numeric(rows: Sequence[Row], column: int) -> bool:
    values = [astuple(row)[column] for row in rows]
    return all(isinstance(value, int | float) and not isinstance(value, bool) for value in values)


def _line(cells: Sequence[str], widths: Sequence[int], numeric: Sequence[bool]) -> str:
    parts = (
        f"{cell:>{width}}" if right else f"{cell:<{width}}"
        for cell, width, right in zip(cells, widths, numeric, strict=True)
    )
    return "  ".join(parts).rstrip()
