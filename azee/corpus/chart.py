"""A chart of the rules of a corpus, by rank, after the chart of Sharma 2024 for 40 news briefs.

Drawn by matplotlib (extra `charts`). The same counts give the same bytes.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from azee.corpus.statistics import CorpusStatistics, RuleCount

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_BARS = 60
"""So many rules are drawn; the bars of more would be too thin to read."""
_COLOURS = {
    "published": "#2f6f4f",
    "read-off": "#5a9a6f",
    "inferred": "#8f9fbf",
    "placeholder": "#d9a441",
    "judged": "#1f4f8f",
    None: "#b0b0b0",
}
_UNKNOWN_COLOUR = "#b5483a"


class NoChartLibraryError(Exception):
    """matplotlib, which draws charts, is not installed."""


def write_chart(statistics: CorpusStatistics, path: str | Path) -> None:
    """Draw a bar for each of the most frequent rules, coloured by status; unknown ones apart.

    The suffix of the path names the format: .svg, .png or .pdf.

    Raises: NoChartLibraryError: matplotlib is missing. OSError: the file cannot be written.
    """
    try:
        import matplotlib as mpl
        from matplotlib.figure import Figure
        from matplotlib.ticker import MaxNLocator
    except ImportError as error:
        raise NoChartLibraryError("drawing a chart needs matplotlib") from error
    from azee.export.files import replace_file

    rules = statistics.rules[:MOST_BARS]
    suffix = Path(path).suffix.lower()
    with mpl.rc_context({"svg.hashsalt": "azee", "svg.fonttype": "none"}):
        figure = Figure(figsize=(8, 1.4 + 0.22 * max(len(rules), 4)), layout="constrained")
        axes = figure.add_subplot()
        axes.barh(
            [f"{rule.rule}  " for rule in rules],
            [rule.occurrences for rule in rules],
            color=[_colour(rule) for rule in rules],
            height=0.72,
        )
        for rule in rules:
            axes.annotate(
                str(rule.occurrences),
                (rule.occurrences, rule.rank - 1),
                xytext=(3, 0),
                textcoords="offset points",
                va="center",
                fontsize=7,
            )
        axes.invert_yaxis()
        axes.margins(x=0.08, y=0.01)
        axes.tick_params(axis="y", length=0, labelsize=8)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.spines[["top", "right", "left"]].set_visible(False)
        axes.set_xlabel("occurrences")
        axes.set_title(_title(statistics), loc="left", fontsize=9)
        _legend(axes, rules)
        nowhen = {"Date": None} if suffix == ".svg" else {"CreationDate": None}
        metadata = {} if suffix == ".png" else nowhen
        with replace_file(path) as file:
            figure.savefig(file, format=suffix.removeprefix("."), dpi=150, metadata=metadata)


def _legend(axes: Axes, rules: Sequence[RuleCount]) -> None:
    from matplotlib.patches import Patch

    found = {_meaning(rule): _colour(rule) for rule in rules}
    patches = [Patch(color=colour, label=meaning) for meaning, colour in found.items()]
    if patches:
        axes.legend(handles=patches, loc="lower right", frameon=False, fontsize=8)


def _meaning(rule: RuleCount) -> str:
    if not rule.known:
        return "unknown rule"
    return rule.status or "without a status"


def _colour(rule: RuleCount) -> str:
    return _COLOURS[rule.status] if rule.known else _UNKNOWN_COLOUR


def _title(statistics: CorpusStatistics) -> str:
    shown = min(MOST_BARS, len(statistics.rules))
    of = f"{shown} of {len(statistics.rules)}" if shown < len(statistics.rules) else str(shown)
    return f"{of} rules in {len(statistics.applications)} applications"
