"""How good hands from few markers are: choices and methods compared on parts that are held out.

Everything is measured on stretches of the recordings that neither the choice of markers nor the
samples have seen. Neighbouring frames are nearly alike, so that frames held out at random would
tell nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from azee.capture.choosing import by_clusters, by_components, by_regression
from azee.capture.components import principal_components
from azee.capture.markers import Floats
from azee.capture.places import place_of
from azee.capture.poses import representatives
from azee.capture.reconstruction import through_components
from azee.capture.regression import LocalRegression, nearest_rows
from azee.capture.smoothing import COMPONENT_TAPS, NEAREST_TAPS, cone_filter, taps_at
from azee.capture.training import REGRESSION_FRAMES, REGRESSION_POSES, Poses, split

MethodName: TypeAlias = Literal["nearest pose", "regression as published", "regression"]
Told = Callable[[int, int], None]

HELD_OUT = ((0.0, 0.3), (0.35, 0.65), (0.7, 1.0))
"""Parts that are held out in turn."""
PUBLISHED = LocalRegression(exponent=1.0, nearest=None)
INSIDE = LocalRegression(ridge_m=0.001**0.5, penalised=True)
METHODS: tuple[MethodName, ...] = ("nearest pose", "regression as published", "regression")
FEW = 10
"""Components that figure 1.2 compares with going straight."""
POSE_COUNTS, MARKER_COUNTS = (50, 100, 500, 1000), (2, 4, 6)
SPARSE = (3, 6)
THEIRS_CM: Mapping[tuple[int, int | None], tuple[float, float]] = {
    (50, 2): (1.2, 0.38), (50, 4): (1.1, 0.31), (50, 6): (1.1, 0.32), (50, None): (1.0, 0.27),
    (100, 2): (1.1, 0.32), (100, 4): (1.3, 0.40), (100, 6): (0.88, 0.21), (100, None): (0.86, 0.19),
    (500, 2): (1.0, 0.57), (500, 4): (1.0, 0.54), (500, 6): (0.68, 0.23), (500, None): (0.65, 0.21),
    (1000, 2): (0.88, 0.27), (1000, 4): (0.80, 0.35), (1000, 6): (0.65, 0.23),
    (1000, None): (0.62, 0.20),
}  # fmt: skip
"""Table 3.1 of Wheatland 2016, mean and deviation; None stands for all markers."""


@dataclass(frozen=True, eq=False)
class Errors:
    """How far markers are off, metres: means over a part's frames, (S,) for S parts.

    every: over all markers. unseen: over those that are neither recorded nor the root's.
    """

    every: Floats
    unseen: Floats

    def to_json(self) -> dict[str, list[float]]:
        """Return millimetres, a part each."""
        return {
            "all_mm": [round(1000 * float(x), 3) for x in self.every],
            "unseen_mm": [round(1000 * float(x), 3) for x in self.unseen],
        }


@dataclass(frozen=True, eq=False)
class Row:
    """A choice of markers with a method. markers: the choice in each part."""

    choice: str
    method: str
    count: int
    markers: tuple[tuple[str, ...], ...]
    errors: Errors


@dataclass(frozen=True, eq=False)
class Example:
    """The last part, for the figures. Frames T, markers M.

    truth: (T, M, 3) metres in the root's frame. made: by choice and method, the same as foretold.
    through: the same from our choices, by their number and that of components; None: straight on.
    """

    names: tuple[str, ...]
    rate_hz: float
    truth: Floats
    made: Mapping[tuple[str, int, str], Floats]
    through: Mapping[tuple[int, int | None], Floats]
    samples: Floats


@dataclass(frozen=True, eq=False)
class Evaluation:
    """All that is measured.

    table: by poses and markers, mean and deviation over the frames of all parts, metres. rows: all
    choices with all methods. identity_m: largest difference between going through all components
    and going straight, by the kind of regression. sources: of the recordings.
    """

    sources: tuple[str, ...]
    frames: int
    table: Mapping[tuple[int, int | None], tuple[float, float]]
    rows: tuple[Row, ...]
    identity_m: Mapping[str, float]
    by_components_m: Floats
    example: Example

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON values."""
        return {
            "sources": list(self.sources),
            "frames": self.frames,
            "table_3_1_cm": {
                f"{p} poses, {m or 'all'} markers": [round(100 * x, 3) for x in found]
                for (p, m), found in self.table.items()
            },
            "rows": [
                {
                    "choice": row.choice, "method": row.method, "count": row.count,
                    "markers": [list(names) for names in row.markers], **row.errors.to_json(),
                }
                for row in self.rows
            ],
            "components_against_direct_m": dict(self.identity_m),
            "error_by_components_m": [float(x) for x in self.by_components_m],
        }  # fmt: skip


@dataclass(frozen=True, eq=False)
class _Part:
    """Samples and a test of one held-out part. known: samples for choosing; judged: its test.

    few, few_known: of samples and known, those that stand for all, by their number.
    """

    poses: Poses
    samples: Floats
    test: Floats
    known: Floats
    judged: Floats
    few: Mapping[int, Floats]
    few_known: Mapping[int, Floats]

    def of(self, method: MethodName) -> Floats:
        """Return the samples that a method uses."""
        return self.few[max(self.few)] if method == "nearest pose" else self.samples


def parts_of(poses: Poses) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """Yield the rows of samples and those held out, a contiguous stretch, part by part."""
    count = len(poses.positions)
    for first, last in HELD_OUT:
        held = np.arange(round(first * count), round(last * count))
        yield np.setdiff1d(np.arange(count), held), held


def evaluate(poses: Poses, *, quick: bool = False, told: Told | None = None) -> Evaluation:
    """Measure everything. Args: quick: on every fourth sample, with fewer poses."""
    counts = POSE_COUNTS[:2] if quick else POSE_COUNTS
    parts = [_part(poses, *rows, counts, 4 if quick else 1) for rows in parts_of(poses)]
    total = len(counts) + len(SPARSE) * 4 + 1
    done = 0

    def step() -> None:
        nonlocal done
        done += 1
        if told:
            told(done, total)

    table: dict[tuple[int, int | None], tuple[float, float]] = {}
    for p in counts:
        table |= _table_row(parts, p)
        step()
    rows = [_mean_pose(parts)]
    made: dict[tuple[str, int, str], Floats] = {}
    for name, count, chosen in _choices(parts, step):
        for method in METHODS:
            results = [
                foretell_part(part.poses, part.of(method), part.test, markers, method)
                for part, markers in zip(parts, chosen, strict=True)
            ]
            rows.append(_row(name, method, parts, chosen, results))
            made[name, count, method] = results[-1]
    last = parts[-1]
    ours = {row.count: row.markers[-1] for row in rows if row.choice == "ours"}
    few = {(count, of): _made_of(last, ours[count], of) for count in SPARSE for of in (None, FEW)}
    example = Example(poses.names, poses.rate_hz, last.test, made, few, last.samples)
    return Evaluation(
        poses.sources,
        len(poses.positions),
        table,
        tuple(rows),
        identity(last.poses, last.samples, last.test[:: 10 if quick else 4], ours[6]),
        _by_components(last),
        example,
    )


def foretell_part(
    poses: Poses, samples: Floats, test: Floats, chosen: Sequence[str], method: MethodName
) -> Floats:
    """Return all markers (T, M, 3) of a test, made from those chosen and the root's."""
    used = poses.columns([*chosen, *poses.root.names])
    flat = samples.reshape(len(samples), -1)
    trust = np.ones((len(test), len(used)))
    if method == "nearest pose":
        rows = nearest_rows(samples[:, used], test[:, used], trust)
        return cone_filter(samples[rows], taps_at(poses.rate_hz, NEAREST_TAPS))
    how = PUBLISHED if method == "regression as published" else LocalRegression()
    taps = taps_at(poses.rate_hz, COMPONENT_TAPS)
    (found,) = through_components(how, samples[:, used], test[:, used], trust, [flat], taps)
    return found.reshape(test.shape)


def identity(
    poses: Poses, samples: Floats, test: Floats, chosen: Sequence[str]
) -> dict[str, float]:
    """Return how far regression onto components is from regression straight onto markers, metres.

    The paper's advantage of components over direct regression cannot come from all components: what
    is foretold is linear in what samples have, and shares that sum to one commute with the mean.
    """
    used = poses.columns([*chosen, *poses.root.names])
    trust = np.ones((len(test), len(used)))
    flat = samples.reshape(len(samples), -1)
    kinds: dict[str, tuple[LocalRegression, int | None]] = {
        "intercept outside the ridge": (LocalRegression(), None),
        "1/d over all samples, as published": (PUBLISHED, None),
        "intercept inside a ridge of 10⁻³": (INSIDE, None),
        "35 components": (LocalRegression(), 35),
        "10 components": (LocalRegression(), 10),
    }
    out = {}
    for name, (how, count) in kinds.items():
        asked = samples[:, used], test[:, used], trust
        straight = how.foretell(*asked, flat)
        (through,) = through_components(how, *asked, [flat], count=count)
        out[name] = float(np.abs(straight - through).max())
    return out


def _made_of(part: _Part, chosen: Sequence[str], count: int | None) -> Floats:
    """Return all markers of a part's test, through so many components or straight on."""
    used = part.poses.columns([*chosen, *part.poses.root.names])
    flat = part.samples.reshape(len(part.samples), -1)
    asked = part.samples[:, used], part.test[:, used], np.ones((len(part.test), len(used)))
    taps = taps_at(part.poses.rate_hz, COMPONENT_TAPS)
    if count is None:
        made = cone_filter(LocalRegression().foretell(*asked, flat), taps)
    else:
        (made,) = through_components(LocalRegression(), *asked, [flat], taps, count)
    return made.reshape(part.test.shape)


def errors_of(
    parts: Sequence[tuple[Poses, Floats, Floats]], chosen: Sequence[Sequence[str]]
) -> Errors:
    """Return errors of (poses, truth, made), a part each, with the markers chosen in each."""
    every, unseen = [], []
    for (poses, truth, made), names in zip(parts, chosen, strict=True):
        off = np.linalg.norm(made - truth, axis=-1).mean(axis=0)
        seen = (*names, *poses.root.names)
        hidden = [m for m, name in enumerate(poses.names) if name not in seen]
        every.append(float(off.mean()))
        unseen.append(float(off[hidden].mean()) if hidden else np.nan)
    return Errors(np.array(every), np.array(unseen))


def _part(
    poses: Poses,
    rows: NDArray[np.int64],
    held: NDArray[np.int64],
    counts: Sequence[int],
    stride: int,
) -> _Part:
    """Make a part with every so manieth sample."""
    samples = poses.positions[rows][::stride]
    known, judged = (samples[rows] for rows in split(len(samples)))
    few, few_known = (
        {p: of[representatives(of, p)] for p in (*counts, REGRESSION_POSES)}
        for of in (samples, known)
    )
    return _Part(poses, samples, poses.positions[held], known, judged[::4], few, few_known)


def _mean_pose(parts: Sequence[_Part]) -> Row:
    made = [np.broadcast_to(p.samples.mean(axis=0), p.test.shape) for p in parts]
    return _row("none", "mean pose", parts, [() for _ in parts], made)


def _row(
    name: str,
    method: str,
    parts: Sequence[_Part],
    chosen: Sequence[tuple[str, ...]],
    made: Sequence[Floats],
) -> Row:
    errors = errors_of([(p.poses, p.test, m) for p, m in zip(parts, made, strict=True)], chosen)
    return Row(name, method, len(chosen[-1]), tuple(chosen), errors)


def _choices(
    parts: Sequence[_Part], step: Callable[[], None]
) -> Iterator[tuple[str, int, list[tuple[str, ...]]]]:
    """Yield every way to choose markers, how many, and the choice in each part."""
    poses = parts[0].poses
    tips = tuple(n for n in poses.names if (place := place_of(n)) and place.bone == 3)
    yield "finger tips", len(tips), [tips for _ in parts]
    step()
    columns = poses.candidates

    def named(found: Sequence[Sequence[int]]) -> list[tuple[str, ...]]:
        return [tuple(poses.names[m] for m in markers) for markers in found]

    for count in SPARSE:
        for name, printed in (("algorithm 1", False), ("algorithm 1, printed", True)):
            ranked = [
                by_clusters(
                    part.few_known[max(part.few_known)], part.judged, count, columns,
                    printed=printed,
                )[0].markers
                for part in parts
            ]  # fmt: skip
            yield name, count, named(ranked)
            step()
        ranked2 = [by_components(part.samples, columns)[:count] for part in parts]
        yield "algorithm 2", count, named(ranked2)
        step()
        ours = [
            by_regression(
                part.few_known[REGRESSION_POSES],
                part.judged[:: max(1, len(part.judged) // REGRESSION_FRAMES)],
                count,
                columns,
            ).markers
            for part in parts
        ]
        yield "ours", count, named(ours)
        step()


def _table_row(parts: Sequence[_Part], p: int) -> dict[tuple[int, int | None], tuple[float, float]]:
    """Return a row of table 3.1: algorithm 1 and nearest poses with a cone, of p poses."""
    found: dict[tuple[int, int | None], list[Floats]] = {}
    for part in parts:
        few, database = part.few_known[p], part.few[p]
        taps = taps_at(part.poses.rate_hz, NEAREST_TAPS)
        for m in (*MARKER_COUNTS, None):
            columns = part.poses.candidates
            if m is not None:
                columns = list(by_clusters(few, part.judged, m, columns)[0].markers)
            trust = np.ones((len(part.test), len(columns)))
            rows = nearest_rows(database[:, columns], part.test[:, columns], trust)
            made = cone_filter(database[rows], taps)
            off = np.linalg.norm(made - part.test, axis=-1).mean(axis=1)
            found.setdefault((p, m), []).append(off)
    joined = {key: np.concatenate(offs) for key, offs in found.items()}
    return {key: (float(off.mean()), float(off.std())) for key, off in joined.items()}


def _by_components(part: _Part) -> Floats:
    """Return the mean error of a marker with 1, 2, … components of all markers, metres (C,)."""
    samples, test = (x.reshape(len(x), -1) for x in (part.samples, part.test))
    every = principal_components(samples)
    out = []
    for count in range(1, every.directions.shape[1] + 1):
        directions = every.directions[:, :count]
        back = every.mean + (test - every.mean) @ directions @ directions.T
        off = np.linalg.norm((back - test).reshape(part.test.shape), axis=-1)
        out.append(float(off.mean()))
    return np.array(out)
