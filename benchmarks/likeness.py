"""How like a person's movements are: `benchmarks/run.py likeness`; docs/likeness.md explains.

Every example, the example of every rule that ships and the texts below benchmarks/texts are
compiled at 120 frames/s, with breath and blinks, and measured. A `*` stands where a target is
missed. Prints figures, not times.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from azee.compilation import perform, score_of
from azee.lang.program import load
from azee.quality.likeness import Likeness
from azee.quality.transitions import correlation
from azee_grammar.files import read_source
from azee_grammar.source import Source
from azee_rig.load import load_rig
from benchmarks.likeness_figures import FIGURES, Figure
from benchmarks.penetration import sources

TEXTS = Path(__file__).parent / "texts"
PAGE = Path(__file__).parents[1] / "docs" / "likeness.md"
BEGIN, END = "<!-- figures: written by `run.py likeness --page` -->", "<!-- end of the figures -->"
FPS = 120.0
POOLED = next(f for f in FIGURES if f.unit == "r")


@dataclass(frozen=True, slots=True)
class Case:
    """What was measured of one text, or of several with the same figures."""

    names: tuple[str, ...]
    likeness: Likeness

    @property
    def name(self) -> str:
        """The first name, and how many more there are."""
        more = len(self.names) - 1
        return f"{self.names[0]} and {more} more" if more else self.names[0]

    def as_json(self) -> dict[str, object]:
        """Every figure, which targets are kept, and all that was measured."""
        return {
            "names": [*self.names],
            "figures": [
                {
                    "figure": f.title,
                    "unit": f.unit,
                    "values": [*f.read(self.likeness)],
                    "at_least": f.at_least,
                    "at_most": f.at_most,
                    "kept": f.judged(self.likeness),
                }
                for f in FIGURES
            ],
            "likeness": self.likeness.as_json(),
        }


def texts() -> Iterator[tuple[str, Source]]:
    """Yield all that is measured, by name: examples, rules with a colon, texts of this folder."""
    yield from sources()
    for path in sorted(TEXTS.glob("*.azee")):
        yield path.stem, read_source(path)


def cases(names: Sequence[str] = ()) -> Iterator[Case]:
    """Measure all texts, or those that are named."""
    rig = load_rig()
    for name, source in texts():
        if not names or name in names:
            score = score_of(load(source), None, None)
            yield Case((name,), perform(score, rig, fps=FPS).report.likeness)


def merged(found: Sequence[Case]) -> list[Case]:
    """Join cases with the same figures, such as the names of a rule in two languages."""
    groups: dict[tuple[tuple[float, ...], ...], list[Case]] = {}
    for case in found:
        groups.setdefault(tuple(f.read(case.likeness) for f in FIGURES), []).append(case)
    return [
        Case(tuple(n for c in group for n in c.names), group[0].likeness)
        for group in groups.values()
    ]


def cell(figure: Figure, likeness: Likeness, mark: str) -> str:
    """One figure of one clip, marked where it misses its target."""
    values = figure.read(likeness)
    if not values:
        return "–"
    text = figure.text(values)
    return mark.format(text) if figure.judged(likeness) is False else text


def table(found: Sequence[Case]) -> list[list[str]]:
    """Return titles, targets and a row a case."""
    heads = [["", *(f"{f.title} {f.unit}".strip() for f in FIGURES)]]
    heads.append(["target", *(f.target for f in FIGURES)])
    return heads + [[c.name, *(cell(f, c.likeness, "{}*") for f in FIGURES)] for c in found]


@dataclass(frozen=True, slots=True)
class Verdict:
    """How many clips keep a target, and which misses it farthest."""

    figure: Figure
    judged: int
    kept: int
    worst: str

    @property
    def line(self) -> str:
        f = self.figure
        title = f"{f.title} {f.target} {f.unit}".rstrip()
        return f"{title}: {self.kept} of {self.judged}{self.worst and f'; {self.worst}'}"


def verdicts(found: Sequence[Case]) -> Iterator[Verdict]:
    """Yield a verdict for every target; transitions of all clips together are one more clip."""
    for figure in FIGURES:
        if not figure.target:
            continue
        judged = [(c, k) for c in found if (k := figure.judged(c.likeness)) is not None]
        missing = [c for c, kept in judged if not kept]
        worst = max(missing, key=lambda c: figure.beyond(figure.read(c.likeness)), default=None)
        told = (
            "" if worst is None
            else f"worst {figure.text(figure.read(worst.likeness))} in {worst.names[0]}"
        )  # fmt: skip
        yield Verdict(figure, len(judged), len(judged) - len(missing), told)


def pooled(found: Sequence[Case]) -> tuple[float | None, int]:
    """Correlation of time and distance over the transitions of all clips, and their number."""
    every = [t for c in found for t in c.likeness.transitions]
    return correlation(every), len(every)


def summary(found: Sequence[Case]) -> Iterator[str]:
    """Yield the lines that say which targets hold."""
    for verdict in verdicts(found):
        holds = "holds " if verdict.kept == verdict.judged else "MISSED"
        yield f"{holds if verdict.judged else 'none  '} {verdict.line}"
    r, count = pooled(found)
    if r is not None:
        holds = "holds " if POOLED.kept((r,)) else "MISSED"
        yield f"{holds} time with distance over all {count} transitions ≥ 0.5: {r:.2f}"


def printed(found: Sequence[Case]) -> Iterator[str]:
    """Yield the lines of the table, in columns."""
    rows = table(found)
    words = [title.split() for title in rows[0]]
    deep = max(len(w) for w in words)
    heads = [
        [w[n - deep + len(w)] if n >= deep - len(w) else "" for w in words] for n in range(deep)
    ]
    rows = [*heads, *rows[1:]]
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        first, *rest = (
            text.ljust(width) if i == 0 else text.rjust(width)
            for i, (text, width) in enumerate(zip(row, widths, strict=True))
        )
        yield "  ".join([first, *rest]).rstrip()


def page(found: Sequence[Case]) -> str:
    """Return the generated part of docs/likeness.md."""
    lines = ["| target | kept by | farthest from it |", "|---|---|---|"]
    for v in verdicts(found):
        title = f"{v.figure.title} {v.figure.target} {v.figure.unit}".rstrip()
        lines.append(f"| {title} | {v.kept} of {v.judged} | {v.worst.removeprefix('worst ')} |")
    r, count = pooled(found)
    if r is not None:
        kept = "kept" if POOLED.kept((r,)) else "missed"
        lines += ["", f"Time with distance over all {count} transitions: {r:.2f}, {kept}."]
    titles, targets, *_ = table([])
    lines += ["", "| " + " | ".join(titles) + " |", "|" + "---|" * len(titles)]
    lines.append("| " + " | ".join(f"*{t}*" if t else "" for t in targets) + " |")
    for case in found:
        names = ", ".join(f"`{n}`" for n in case.names)
        cells = (cell(f, case.likeness, "**{}**") for f in FIGURES)
        lines.append(f"| {names} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def rewrite(path: Path, begin: str, end: str, text: str) -> None:
    """Put a generated text between its two markers in a document."""
    before, _, rest = path.read_text(encoding="utf-8").partition(begin)
    after = rest.partition(end)[2]
    path.write_text(f"{before}{begin}\n\n{text}\n\n{end}{after}", encoding="utf-8")


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table and which targets hold."""
    parser = argparse.ArgumentParser(prog="likeness", description=__doc__)
    parser.add_argument(
        "--case", action="append", default=[], metavar="NAME",
        help="an example, a rule as `:name` or a text of benchmarks/texts; repeatable",
    )  # fmt: skip
    parser.add_argument("-o", "--output", type=Path, metavar="FILE.json", help="everything")
    parser.add_argument("--page", action="store_true", help=f"write the tables into {PAGE.name}")
    options = parser.parse_args(arguments)
    if options.page and options.case:
        parser.error("--page is of all cases: leave out --case")
    unknown = set(options.case) - {name for name, _ in texts()} if options.case else set()
    if unknown:
        parser.error(f"there is no example, rule or text called {', '.join(sorted(unknown))}")
    found = []
    for case in cases(options.case):
        found.append(case)
        print(f"\r{len(found)} {case.name:<30}", end="", file=sys.stderr)
    print(f"\r{'':<40}\r", end="", file=sys.stderr)
    different = merged(found)
    print("\n".join(printed(different)))
    print("\n".join(["", *summary(different)]))
    if options.output:
        document = {
            "fps": FPS,
            "cases": [case.as_json() for case in different],
            "summary": [*summary(different)],
        }
        options.output.write_text(json.dumps(document, indent=1), encoding="utf-8")
    if options.page:
        rewrite(PAGE, BEGIN, END, page(different))


if __name__ == "__main__":
    main()
