"""Tables of the comparison on a terminal."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from rich.table import Table

from benchmarks.ik.comparison import Row, behind_best, of_solvable
from benchmarks.ik.goals import Goal
from benchmarks.ik.problems import LOOSE, TIGHT


def comparison(rows: Sequence[Row]) -> Table:
    """Return the table of one class of problems, with a line per method."""
    first = rows[0]
    table = _table(
        f"{first.body}: {first.kind}, {len(first.seconds)} problems",
        "method", "ms", "p95", "evals", "1 mm", "1 cm", "solvable", "behind", "worst miss",
        "over limit", "overlap",
    )  # fmt: skip
    solvable, behind = of_solvable(rows), behind_best(rows)
    for row in rows:
        worst = max(row.residuals, key=lambda miss: miss.size)
        met, of = solvable[row.method]
        table.add_row(
            row.method,
            f"{1000 * row.median_s:.3f}",
            f"{1000 * row.p95_s:.3f}",
            f"{sorted(row.evaluations)[len(row.evaluations) // 2]}",
            f"{row.met(TIGHT)}",
            f"{row.met(LOOSE)}",
            f"{met}/{of}",
            f"{1000 * behind[row.method]:.2f}" if first.kind == "unreachable" else "",
            f"#{worst.number} {1000 * worst.length_m:.1f} mm {math.degrees(worst.angle_rad):.1f}°",
            f"{math.degrees(row.excess_rad):.2f}°" if row.excess_rad else "none",
            f"{1000 * max(row.overlaps_m):.0f}" if row.overlaps_m else "",
        )
    counted = [row for row in rows if row.rounds]
    if counted:
        table.caption = "; ".join(f"{row.method}: {_rounds(row.rounds)}" for row in counted)
    return table


def _rounds(counts: Sequence[int]) -> str:
    """Describe iterations as in the paper's figures 5 and 8."""
    one, most = sum(c == 1 for c in counts), sum(c >= max(counts) for c in counts)
    return (
        f"{len(counts)} IK problems in {sum(counts)} iterations, {one} in one, "
        f"{most} in the most, {max(counts)}"
    )


def figure_5(rows: Sequence[Mapping[str, Any]]) -> Table:
    """Return the table of the tree by the two-level method, as in the paper's figure 5."""
    table = _table(
        "tree, two-level: the paper's figure 5",
        "IK problem", "places", "orientations", "iterations", "ms",
    )  # fmt: skip
    for row in rows:
        table.add_row(
            f"#{row['problem']} {row['name']}"[:72],
            str(row["places"]),
            str(row["constraints"] - row["places"]),
            str(row["iterations"]),
            f"{1000 * row['seconds']:.1f}",
        )
    return table


def signs(rows: Sequence[Mapping[str, Any]]) -> Table:
    """Return the table of whole texts, with a line per text and solver."""
    table = _table(
        "signs and sentences, the signer, everything on",
        "text", "solver", "IK problems", "score to clip ms", "evaluations", "unmet", "overlap mm",
        "iterations, most",
    )  # fmt: skip
    for row in rows:
        table.add_row(
            row["text"],
            row["solver"],
            str(row["problems"]),
            f"{1000 * row['score_to_clip_s']:.0f}",
            str(row["evaluations"]),
            f"{row['unmet']} of {row['constraints']}",
            f"{1000 * row['deepest_overlap_m']:.1f}",
            f"{sum(row['rounds'])}, {max(row['rounds'])}" if row["rounds"] else "",
        )
    return table


def scaling(found: Mapping[str, Sequence[Mapping[str, Any]]]) -> Table:
    """Return the table of how time grows."""
    table = _table("how time grows, the signer", "with", "number", "ms", "ms for each")
    for what, rows in found.items():
        for row in rows:
            size = next(iter(row.values()))
            if isinstance(row.get("median_s"), Mapping):
                for method, seconds in row["median_s"].items():
                    table.add_row(f"{what}, {method}", str(size), f"{1000 * seconds:.3f}", "")
                continue
            seconds = row.get("seconds", row.get("median_s"))
            assert isinstance(seconds, float)
            table.add_row(what, str(size), f"{1000 * seconds:.2f}", f"{1000 * seconds / size:.2f}")
    return table


def processes(found: Mapping[str, float]) -> Table:
    """Return the table of what a process costs, with the profile of one."""
    table = _table("a process", "what", "ms")
    for what, seconds in found.items():
        table.add_row(what, f"{1000 * seconds:.0f}")
    return table


def goals(found: Sequence[Goal]) -> Table:
    """Return the table of figures and their goals."""
    table = _table("goals", "what", "is", "should be", "")
    for goal in found:
        bounds = [f"≥ {goal.at_least:g}"] if goal.at_least is not None else []
        bounds += [f"≤ {goal.at_most:g}"] if goal.at_most is not None else []
        kept = {None: "", True: "kept", False: "missed"}[goal.kept]
        table.add_row(goal.what, f"{goal.value:.3g} {goal.unit}", " ".join(bounds), kept)
    return table


def _table(title: str, *columns: str) -> Table:
    table = Table(title=title, title_justify="left", caption_justify="left", box=None)
    for n, column in enumerate(columns):
        table.add_column(column, justify="left" if n == 0 else "right", no_wrap=True)
    return table
