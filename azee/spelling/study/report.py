"""The analysis of a study as files: JSON, a page with plots, the choices as a table."""

from __future__ import annotations

import csv
import json
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jinja2 import Environment, PackageLoader
from matplotlib.figure import Figure

from azee.spelling.study.analysis import Analysis, analysed
from azee.spelling.study.answers import Answers
from azee.spelling.study.design import comparisons
from azee.spelling.study.questions import AGES, FLUENCIES, OPEN
from azee.spelling.study.sample_size import sentence

BLUE, ORANGE, GREY = "#1d4ed8", "#b45309", "#6b7280"


def write_report(answers: Answers, folder: Path) -> tuple[Analysis, Sequence[Path]]:
    """Write analysis.json, report.html with its plots and choices.csv. Raises: OSError."""
    found = analysed(answers)
    paths = [folder / name for name in ("analysis.json", "choices.csv", "report.html")]
    paths[0].write_text(json.dumps(found.to_json(), indent=2, ensure_ascii=False) + "\n", "utf-8")
    _write_choices(answers, paths[1])
    plots = {"figure-5-4.png": _shares(found), "strengths.png": _strengths(found)}
    for name, figure in plots.items():
        figure.savefig(folder / name, dpi=110, metadata={"Software": "azee"})
        paths.append(folder / name)
    paths[2].write_text(_page(found), "utf-8")
    return found, paths


def _write_choices(answers: Answers, path: Path) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(("participant", "page", "word", "first", "second", "choice"))
        for person in answers.participants():
            pages = comparisons(answers.design, person.number)
            for number, choice in answers.choices(person).items():
                page = pages[number - 1]
                rows.writerow((person.number, number, page.word, page.first, page.second, choice))


def _page(found: Analysis) -> str:
    templates = Environment(
        loader=PackageLoader("azee.spelling.study"), autoescape=True, trim_blocks=True
    )
    ages = Counter(person.age for person in found.participants)
    fluencies = Counter(person.fluency for person in found.participants)
    return templates.get_template("report.html").render(
        found=found,
        size=sentence(len(found.design.words)),
        fewest=min(pair.for_first + pair.for_second for pair in found.pairs),
        shares=found.shares(),
        people=[(group, ages[group]) for group in AGES if ages[group]]
        + [(group, fluencies[group]) for group in FLUENCIES if fluencies[group]],
        strengths=list(
            zip(found.design.types, found.model.strengths, found.model.standard_errors, strict=True)
        ),
        remarks=[
            (question, [(who, text) for who, of, text in found.remarks if of == i])
            for i, question in enumerate(OPEN)
        ],
    )


def _shares(found: Analysis) -> Figure:
    """Draw figure 5.4: of the times that each type was shown, how often it was chosen."""
    figure = Figure(figsize=(6, 3.8), layout="constrained")
    ax = figure.subplots()
    with np.errstate(invalid="ignore"):
        each = 100 * found.counts / np.where(found.shown > 0, found.shown, np.nan)
    each = each[np.isfinite(each).all(axis=1)]
    types = found.design.types
    if len(each):
        spread = each.std(axis=0, ddof=1) / np.sqrt(len(each)) if len(each) > 1 else None
        ax.bar(types, each.mean(axis=0), yerr=spread, color=BLUE, capsize=4)
    ax.axhline(50, color=GREY, ls="--", lw=1)
    ax.set(
        ylabel="chosen, % of times shown", ylim=(0, 100),
        title=f"{len(each)} participants; bars are standard errors",
    )  # fmt: skip
    ax.spines[["top", "right"]].set_visible(False)
    return figure


def _strengths(found: Analysis) -> Figure:
    """Draw strengths with 95 % intervals."""
    figure = Figure(figsize=(6, 2.8), layout="constrained")
    ax = figure.subplots()
    order = np.argsort(found.model.strengths)
    errors = 1.96 * found.model.standard_errors
    ax.errorbar(
        found.model.strengths[order], range(len(order)), xerr=errors[order],
        fmt="o", color=ORANGE, capsize=4,
    )  # fmt: skip
    ax.set_yticks(range(len(order)), [found.design.types[i] for i in order])
    ax.set(
        xlabel=f"Bradley–Terry strength against {found.design.types[-1]}, logits",
        ylim=(-0.5, len(order) - 0.5),
    )
    ax.spines[["top", "right"]].set_visible(False)
    return figure
