"""Writes the results of a run as Markdown, between two marks of a page."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

START, END = "<!-- results: written by `run.py solver --page` -->", "<!-- end of results -->"


def put_on_page(document: Mapping[str, Any], page: Path) -> None:
    """Replace the text between the marks of a page."""
    before, _, rest = page.read_text(encoding="utf-8").partition(START)
    _, mark, after = rest.partition(END)
    if not mark:
        raise ValueError(f"{page} lacks the marks {START} and {END}")
    text = "\n\n".join(_sections(document))
    page.write_text(f"{before}{START}\n\n{text}\n\n{END}{after}", encoding="utf-8")


def _sections(document: Mapping[str, Any]) -> Iterable[str]:
    machine = document["machine"]
    versions = ", ".join(f"{name} {number}" for name, number in document["versions"].items())
    yield (
        f"{document['problems_per_class']} problems of each class, on {machine['cores']} cores of "
        f"{machine['processor']} under {machine['system']}, with Python {machine['python']}; "
        f"load {machine['load']:.1f}. {versions}."
    )
    rows = document["comparison"]
    for body in dict.fromkeys(row["body"] for row in rows):
        yield f"### {body.capitalize()}"
        yield _comparison([row for row in rows if row["body"] == body])
    if document["signs"]:
        yield "### Signs and sentences"
        yield _table(
            (
                "text",
                "solver",
                "IK problems",
                "score to clip, ms",
                "evaluations",
                "unmet",
                "overlap, mm",
                "iterations, most",
            ),
            [_sign(row) for row in document["signs"]],
        )
    if document["figure_5"]:
        yield "### Figure 5 of the paper: tree by the two-level method"
        yield _table(
            ("IK problem", "places", "orientations", "iterations", "ms"),
            [_figure_5(row) for row in document["figure_5"]],
        )
    if document["scaling"]:
        yield "### How time grows"
        yield _table(("with", "number", "ms"), list(_scaling(document["scaling"])))
    if document["process"]:
        yield "### A process: `azee compile` of tree"
        yield _table(("what", "ms"), [_process(*item) for item in document["process"].items()])
    yield "### Goals"
    yield _table(("what", "is", "should be", ""), [_goal(goal) for goal in document["goals"]])
    if document["skipped"]:
        yield "\n".join(f"- {line}" for line in document["skipped"])


def _comparison(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return a table of methods and classes: median time, problems met at either tolerance."""
    kinds = list(dict.fromkeys(row["class"] for row in rows))
    cells = {(row["method"], row["class"]): _cell(row) for row in rows}
    methods = dict.fromkeys(row["method"] for row in rows)
    return _table(
        ("", *kinds), [(method, *(cells[method, kind] for kind in kinds)) for method in methods]
    )


def _cell(row: Mapping[str, Any]) -> str:
    ms, late = (_ms(row[name]) for name in ("median_s", "p95_s"))
    return f"{ms} ({late}) ms · {row['met_1mm_05deg']} · {row['met_1cm_5deg']}"


def _ms(seconds: float) -> str:
    return f"{1000 * seconds:.{2 if seconds < 0.01 else 0}f}"


def _sign(row: Mapping[str, Any]) -> tuple[str, ...]:
    rounds = row["rounds"]
    return (
        row["text"],
        row["solver"],
        str(row["problems"]),
        _ms(row["score_to_clip_s"]),
        str(row["evaluations"]),
        f"{row['unmet']} of {row['constraints']}",
        _mm(row["deepest_overlap_m"]),
        f"{sum(rounds)}, {max(rounds)}" if rounds else "",
    )


def _figure_5(row: Mapping[str, Any]) -> tuple[str, ...]:
    orientations = row["constraints"] - row["places"]
    name = f"{row['problem']}: {row['name']}"
    counts = (row["places"], orientations, row["iterations"])
    return name, *map(str, counts), _ms(row["seconds"])


def _mm(length_m: float) -> str:
    return f"{1000 * length_m:.1f}"


def _scaling(found: Mapping[str, Sequence[Mapping[str, Any]]]) -> Iterable[tuple[str, ...]]:
    for what, rows in found.items():
        for row in rows:
            size = str(next(iter(row.values())))
            times = row.get("median_s", row.get("seconds"))
            if isinstance(times, Mapping):
                for method, seconds in times.items():
                    yield f"{what}: {method}", size, _ms(seconds)
            else:
                assert isinstance(times, float)
                yield what, size, _ms(times)


def _process(what: str, seconds: float) -> tuple[str, str]:
    return what.strip(), f"{1000 * seconds:.0f}"


def _goal(goal: Mapping[str, Any]) -> tuple[str, ...]:
    low, high = goal["at_least"], goal["at_most"]
    bounds = [f"≥ {low:g}"] if low is not None else []
    bounds += [f"≤ {high:g}"] if high is not None else []
    kept = {None: "", True: "kept", False: "**missed**"}[goal["kept"]]
    return goal["what"], f"{goal['value']:.3g} {goal['unit']}", " ".join(bounds), kept


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)
