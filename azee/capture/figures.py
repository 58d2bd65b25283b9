"""Figures 1.1, 1.2, 3.3, 3.5 and 3.6 of Wheatland (2016) from our data. Needs matplotlib.

The figures of the thesis show errors of joint angles; ours show those of markers, millimetres.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from azee.capture.components import principal_components
from azee.capture.evaluation import Evaluation, Example
from azee.capture.markers import Floats
from azee.export.files import replace_file

TRUTH = "#111827"
COLOURS = {
    ("ours", 6): "#1d4ed8", ("ours", 3): "#60a5fa",
    ("algorithm 1", 6): "#b45309", ("algorithm 1", 3): "#f59e0b",
    ("algorithm 2", 6): "#047857", ("algorithm 2", 3): "#6ee7b7",
    ("finger tips", 5): "#6b7280",
}  # fmt: skip
SHOWN_S = 8.0
"""Seconds of the held-out part that figures over time show."""


def write_figures(evaluation: Evaluation, folder: Path) -> Sequence[Path]:
    """Draw all figures as PNG. Raises: OSError: the folder cannot be written."""
    paths = []
    for name, figure in _figures(evaluation):
        paths.append(folder / f"{name}.png")
        with replace_file(paths[-1]) as file:
            figure.savefig(file, format="png", dpi=110, metadata={"Software": "azee"})
    return paths


def _figures(e: Evaluation) -> Iterator[tuple[str, Figure]]:
    drawings: tuple[tuple[str, int, Callable[[Evaluation, Sequence[Axes]], None]], ...] = (
        ("figure-1-1", 1, _components_needed),
        ("figure-1-2", 1, _with_and_without),
        ("figure-3-3", 1, _trajectory),
        ("figure-3-5", 1, _choices),
        ("figure-3-6", 3, _components),
    )
    for name, panels, draw in drawings:
        figure = Figure(figsize=(7.5, 3.6 if panels == 1 else 1.9 * panels), layout="constrained")
        axes = np.atleast_1d(figure.subplots(panels, 1, sharex=True))
        draw(e, list(axes))
        for ax in axes:
            ax.spines[["top", "right"]].set_visible(False)
        yield name, figure


def _components_needed(e: Evaluation, axes: Sequence[Axes]) -> None:
    (ax,) = axes
    found = 1000 * e.by_components_m
    ax.plot(np.arange(1, len(found) + 1), found, marker="o", ms=3, color="#1d4ed8")
    ax.set(
        xlabel="principal components", ylabel="mean error of a marker, mm", ylim=(0, None),
        title="Figure 1.1: poses held out, made from few components",
    )  # fmt: skip


def _with_and_without(e: Evaluation, axes: Sequence[Axes]) -> None:
    """Draw errors over time straight on, which all components give too, and through a few."""
    (ax,) = axes
    times, rows = _shown(e.example)
    for (markers, components), made in e.example.through.items():
        straight = components is None
        ax.plot(
            times, _off(e.example, made)[rows], "-" if straight else ":", lw=1,
            color=COLOURS["ours", markers],
            label=f"{markers} markers, " + ("straight" if straight else f"{components} components"),
        )  # fmt: skip
    ax.set(
        xlabel="s", ylabel="mean error, mm", ylim=(0, None),
        title="Figure 1.2: straight on (as through all components), and through few",
    )  # fmt: skip
    ax.legend(frameon=False, ncols=2, fontsize=8)


def _trajectory(e: Evaluation, axes: Sequence[Axes]) -> None:
    """Draw one coordinate of the middle of the index finger, or of the marker that moves most."""
    (ax,) = axes
    example = e.example
    times, rows = _shown(example)
    spread = example.truth.std(axis=0)
    hidden = _hidden(e)
    m = max(hidden, key=lambda k: float(spread[k].max()))
    axis = int(spread[m].argmax())
    ax.plot(times, 1000 * example.truth[rows, m, axis], color=TRUTH, lw=1.6, label="recorded")
    for (choice, count, method), made in example.made.items():
        if method == "regression" and (choice, count) in COLOURS:
            ax.plot(
                times, 1000 * made[rows, m, axis], lw=0.9, color=COLOURS[choice, count],
                label=f"{choice}, {count}",
            )  # fmt: skip
    ax.set(
        xlabel="s", ylabel=f"{'xyz'[axis]} in the root, mm",
        title=f"Figure 3.3: {example.names[m]}",
    )  # fmt: skip
    ax.legend(frameon=False, ncols=3, fontsize=8)


def _choices(e: Evaluation, axes: Sequence[Axes]) -> None:
    (ax,) = axes
    times, rows = _shown(e.example)
    for (choice, count, method), made in e.example.made.items():
        if method == "regression" and count in (5, 6) and (choice, count) in COLOURS:
            off = _off(e.example, made)[rows]
            ax.plot(
                times, off, lw=1, color=COLOURS[choice, count],
                label=f"{choice}, {count}: {off.mean():.1f} mm",
            )  # fmt: skip
    ax.set(
        xlabel="s", ylabel="mean error, mm", ylim=(0, None),
        title="Figure 3.5: ways to choose markers",
    )  # fmt: skip
    ax.legend(frameon=False, ncols=2, fontsize=8)


def _components(e: Evaluation, axes: Sequence[Axes]) -> None:
    times, rows = _shown(e.example)
    every = principal_components(e.example.samples.reshape(len(e.example.samples), -1))

    def of(poses: Floats) -> Floats:
        return 1000 * every.of(poses.reshape(len(poses), -1))[rows]

    for c, ax in enumerate(axes):
        ax.plot(times, of(e.example.truth)[:, c], color=TRUTH, lw=1.6, label="recorded")
        for count in (6, 3):
            made = e.example.made["ours", count, "regression"]
            ax.plot(
                times, of(made)[:, c], lw=1, color=COLOURS["ours", count],
                label=f"{count} markers",
            )  # fmt: skip
        ax.set(ylabel=f"component {c + 1}, mm")
    axes[0].set_title("Figure 3.6: components of the hand, recorded and made")
    axes[0].legend(frameon=False, ncols=3, fontsize=8)
    axes[-1].set(xlabel="s")


def _shown(example: Example) -> tuple[Floats, slice]:
    """Return the times of the figures' frames, seconds, and the frames: those that move most."""
    count = min(len(example.truth), round(SHOWN_S * example.rate_hz))
    way = np.abs(np.diff(example.truth, axis=0)).sum(axis=(1, 2))
    moved = np.concatenate([[0.0], np.cumsum(way)])
    start = int((moved[count - 1 :] - moved[: len(moved) - count + 1]).argmax())
    return np.arange(count) / example.rate_hz, slice(start, start + count)


def _off(example: Example, made: Floats) -> Floats:
    """Mean error of a marker in each frame, (T,) millimetres."""
    return np.asarray(1000 * np.linalg.norm(made - example.truth, axis=-1).mean(axis=1))


def _hidden(e: Evaluation) -> list[int]:
    """Markers that no choice of ours records."""
    ours = next(row for row in e.rows if row.choice == "ours" and row.count == 6)
    return [m for m, name in enumerate(e.example.names) if name not in ours.markers[-1]]
