"""Figures 4.3 to 4.8 of Wheatland (2016). Needs matplotlib (extra `spelling`)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from azee.spelling.timing import published as theirs
from azee.spelling.timing.evaluation import Evaluation
from azee.spelling.timing.facts import hold_by_place
from azee.spelling.timing.features import CHOSEN, FEATURES
from azee.spelling.timing.holds import HoldName
from azee.spelling.timing.validation import SCHEMES, Scheme

COLOURS: Mapping[Scheme, str] = {
    "resubstitution": "#b45309",
    "one left out": "#1d4ed8",
    "words held out": "#047857",
}
THEIRS = "#6b7280"


def write_figures(evaluation: Evaluation, folder: Path) -> Sequence[Path]:
    """Draw all figures as PNG. Raises: OSError: the folder cannot be written."""
    paths = []
    for name, figure in _figures(evaluation):
        figure.supxlabel(evaluation.origin, x=0.99, ha="right", size=7, color=THEIRS)
        paths.append(folder / f"{name}.png")
        figure.savefig(paths[-1], dpi=110, metadata={"Software": "azee"})
    return paths


def _figures(e: Evaluation) -> Iterator[tuple[str, Figure]]:
    drawings: tuple[tuple[str, int, Callable[[Evaluation, Sequence[Axes]], None]], ...] = (
        ("figure-4-3", 1, _places),
        ("figure-4-4", 2, lambda e, axes: _features(e, FEATURES, axes)),
        ("figure-4-5", 2, lambda e, axes: _features(e, CHOSEN, axes)),
        ("figure-4-6", 1, _sizes),
        ("figure-4-7", 4, _regressions),
        ("figure-4-8", 1, _metric_errors),
    )
    for name, panels, draw in drawings:
        rows = 2 if panels == 4 else 1
        columns = panels // rows
        figure = Figure(figsize=(5.5 * columns, 3.8 * rows), layout="constrained")
        axes = np.atleast_1d(figure.subplots(rows, columns)).ravel()
        draw(e, list(axes))
        for ax in axes:
            ax.spines[["top", "right"]].set_visible(False)
        yield name, figure


def _places(e: Evaluation, axes: Sequence[Axes]) -> None:
    """Draw holds by place, with deviations."""
    (ax,) = axes
    holds_ms = 1000 * hold_by_place([word for word in e.words if len(word.word) > 2])
    ax.bar(
        ("first", "middle", "last"), holds_ms.mean(axis=0), yerr=holds_ms.std(axis=0),
        color=COLOURS["one left out"], capsize=4,
    )  # fmt: skip
    ax.set(ylabel="hold, ms", title="Holds by the letter's place in its word")


def _features(e: Evaluation, names: tuple[str, ...], axes: Sequence[Axes]) -> None:
    """Draw accuracy and error as features are added."""
    accuracy, error = axes
    n = np.arange(1, len(names) + 1)
    for scheme in SCHEMES:
        found = e.by_feature[names][scheme]
        style: dict[str, Any] = {
            "color": COLOURS[scheme],
            "marker": "o",
            "ms": 3,
            "capsize": 2,
            "label": scheme,
        }
        accuracy.errorbar(
            n,
            [100 * errors.accuracy for errors in found],
            [100 * errors.accuracy_standard_error for errors in found],
            **style,
        )
        error.errorbar(
            n,
            [1000 * errors.error_s for errors in found],
            [1000 * errors.standard_error_s for errors in found],
            **style,
        )
    published = (
        {9: theirs.ACCURACY["9 features, no word"], 10: theirs.ACCURACY["10 features"]}
        if names == FEATURES
        else {9: theirs.ACCURACY["9 features, no shape"]}
    )
    accuracy.plot(
        list(published), [100 * a for a in published.values()], "x", color=THEIRS, label="published"
    )
    if names == CHOSEN:
        error.plot([9], [1000 * theirs.HOLD_ERROR_S], "x", color=THEIRS, label="published")
    for ax, label in ((accuracy, "holds right to the frame, %"), (error, "mean error, ms")):
        ax.set_xticks(n, names, rotation=45, ha="right")
        ax.set(ylabel=label, ylim=(0, None))
        ax.legend(frameon=False)
    accuracy.set_title(f"Naive Bayes, features added one by one to {len(names)}")


def _sizes(e: Evaluation, axes: Sequence[Axes]) -> None:
    """Draw mean errors by the letters that were learnt."""
    (ax,) = axes
    sizes = list(e.by_size)
    models: dict[HoldName, str] = {"naive-bayes": "#1d4ed8", "ridge": "#047857"}
    for name, colour in models.items():
        found = [e.by_size[size][name] for size in sizes]
        ax.errorbar(
            sizes,
            [1000 * errors.error_s for errors in found],
            [1000 * errors.standard_error_s for errors in found],
            color=colour, marker="o", ms=4, capsize=3, label=name,
        )  # fmt: skip
    ax.set(
        xlabel="letters learnt", ylabel="mean error over all letters, ms", ylim=(0, None),
        title="Errors by the size of the training data",
    )  # fmt: skip
    ax.legend(frameon=False)


def _regressions(e: Evaluation, axes: Sequence[Axes]) -> None:
    """Draw transition times against each distance."""
    for ax, (name, found) in zip(axes, e.metrics.items(), strict=True):
        ax.plot(found.distances, 1000 * found.times_s, ".", ms=4, alpha=0.6, color="#1d4ed8")
        slope, offset = found.line
        ends = np.array([found.distances.min(), found.distances.max()])
        ax.plot(ends, 1000 * (offset + slope * ends), color="#b45309")
        unit = "" if name == "GPLVMD" else ", rad"
        ax.set(
            xlabel=f"{name}{unit}", ylabel="transition, ms", ylim=(0, None),
            title=f"r = {found.r:.2f} (published {theirs.CORRELATION[name]:.2f})",
        )  # fmt: skip


def _metric_errors(e: Evaluation, axes: Sequence[Axes]) -> None:
    """Draw the mean error of each metric's regression."""
    (ax,) = axes
    errors = {name: 1000 * found.errors_s for name, found in e.metrics.items()}
    ax.bar(
        list(errors),
        [of.mean() for of in errors.values()],
        yerr=[of.std(ddof=1) / np.sqrt(len(of)) for of in errors.values()],
        color="#1d4ed8", capsize=4,
    )  # fmt: skip
    ax.axhline(1000 * theirs.TRANSITION_ERROR_S, color=THEIRS, ls="--", label="published, of RMSD")
    times_s = next(iter(e.metrics.values())).times_s
    always = 1000 * np.abs(times_s - times_s.mean()).mean()
    ax.axhline(always, color="#b45309", ls=":", label="always the mean")
    ax.set(
        ylabel="mean error of transitions, ms", title="Errors of the regressions",
        ylim=(0, 1.5 * always),
    )  # fmt: skip
    ax.legend(frameon=False, loc="upper right")
