"""An evaluation as files: JSON, tables for people, figures."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from azee.capture.evaluation import MARKER_COUNTS, METHODS, THEIRS_CM, Evaluation
from azee.capture.figures import write_figures
from azee.capture.markers import Floats
from azee.export.files import replace_file


def write_report(evaluation: Evaluation, folder: Path) -> Sequence[Path]:
    """Write evaluation.json, evaluation.md and the figures. Raises: OSError."""
    data, page = folder / "evaluation.json", folder / "evaluation.md"
    text = json.dumps(evaluation.to_json(), indent=2, ensure_ascii=False, allow_nan=False)
    for path, content in ((data, text), (page, "\n".join(page_lines(evaluation)))):
        with replace_file(path) as file:
            file.write(f"{content}\n".encode())
    return [data, page, *write_figures(evaluation, folder)]


def page_lines(e: Evaluation) -> Iterator[str]:
    """Yield the tables of an evaluation in Markdown."""
    yield from _table_3_1(e)
    yield ""
    yield from _comparison(e)
    yield ""
    yield "| through all components against straight | largest difference |"
    yield "|---|---|"
    for name, off in e.identity_m.items():
        yield f"| {name} | {1000 * off:.2g} mm |"


def _table_3_1(e: Evaluation) -> Iterator[str]:
    """Yield table 3.1 with ours beside it, in centimetres."""
    counts: list[int | None] = [*MARKER_COUNTS, None]
    heads = [f"{m or 'all'} markers" for m in counts]
    yield f"| poses | {' | '.join(heads)} |"
    yield "|---|" + "---|" * len(heads)
    for p in sorted({p for p, _ in e.table}):
        cells = []
        for m in counts:
            mean, spread = (100 * x for x in e.table[p, m])
            theirs, theirs_spread = THEIRS_CM[p, m]
            cells.append(f"{mean:.2f} (σ {spread:.2f}); theirs {theirs:.2f} ({theirs_spread:.2f})")
        yield f"| {p} | {' | '.join(cells)} |"


def _comparison(e: Evaluation) -> Iterator[str]:
    """Yield all choices with all methods, in millimetres over the parts."""
    yield f"| choice | markers | {' | '.join(f'{m}: all | unseen' for m in METHODS)} |"
    yield "|---|---|" + "---|---|" * len(METHODS)
    mean = next(row for row in e.rows if row.method == "mean pose")
    told = f"{_spread(mean.errors.every)} | {_spread(mean.errors.unseen)}"
    yield f"| mean pose | 0 | {' | '.join([told] * len(METHODS))} |"
    for name, count in dict.fromkeys((row.choice, row.count) for row in e.rows if row.count):
        cells = []
        for method in METHODS:
            row = next(r for r in e.rows if (r.choice, r.count, r.method) == (name, count, method))
            cells += [_spread(row.errors.every), _spread(row.errors.unseen)]
        yield f"| {name} | {count} | {' | '.join(cells)} |"


def _spread(values_m: Floats) -> str:
    """Write the mean over parts, and the least and largest."""
    mm = 1000 * np.asarray(values_m)
    return f"{mm.mean():.2f} ({mm.min():.2f}–{mm.max():.2f})"
