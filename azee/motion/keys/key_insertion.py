"""Key insertion: keys are added between keys until every frame meets every constraint.

Between two keys that meet a constraint the interpolated posture may not. A key is added at the
worst frame of every such stretch. It is solved from the posture that the movement has there, and
drawn to it; the limbs pass through it without stopping. Each round about halves the stretches that
are too long. It ends when no frame is out of tolerance any more, or after `ROUNDS` rounds.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.movement import Interpolation, Movement
from azee.motion.keys.in_between import InBetweenSolver
from azee.motion.keys.residual_monitor import MovementSamples, ResidualMonitor, sample_movement
from azee.motion.tasks.key_posture import KeyPosture, Origin
from azee_solver.constraint import Constraint

Array = NDArray[np.float64]
Rows = NDArray[np.int64]

ROUNDS = 12
TOLERANCE_SHARE = 0.9
"""Share of the tolerance that an interpolated posture may use up before a key is added."""
UNMET_SHARE = 1.1
"""Between keys that cannot meet a constraint, its residual may be larger than there, by this."""
TRIALS = 4
"""How often one instant may be solved, as the curves of other limbs change with added keys."""
CLOSEST_S = 0.003
"""Keys nearer to another than this would only make the movement shake."""
NEIGHBOURS = 3
"""An added key bends the curve about as many keys away; those stretches are measured again."""


@dataclass(frozen=True, slots=True, eq=False)
class KeyedMovement:
    """Key postures in order of time, the movement through them, and its samples.

    samples: at the frames inside the score and at the keys.
    """

    postures: tuple[KeyPosture, ...]
    movement: Movement
    samples: MovementSamples


def insert_keys(
    postures: Iterable[KeyPosture],
    in_between: InBetweenSolver,
    interpolation: Interpolation,
    frame_times: Sequence[Fraction],
) -> KeyedMovement:
    """Return key postures, with those added that the frames need, and the movement through them.

    After a round only the stretches that it changed are measured; when these are in tolerance, all
    are measured once more. In flat mode no key is added.
    """
    out = sorted(postures, key=lambda p: p.time)
    changed: Sequence[Fraction] | None = None  # frames to measure; none for all
    trials: Counter[Fraction] = Counter()
    for _ in range(0 if in_between.selection.flat else ROUNDS):
        keyed = _keyed(out, in_between, interpolation, frame_times if changed is None else changed)
        worst = [t for t in worst_instants(keyed, in_between.monitor) if trials[t] < TRIALS]
        if worst:
            trials.update(worst)
            changed = _frames_around(worst, sorted({p.time for p in out}), frame_times)
            out = merge_keys(out, in_between.solve_at(worst, keyed.movement, Origin.ADDED))
        elif changed is None:
            return keyed
        else:
            changed = None
    return _keyed(out, in_between, interpolation, frame_times)


def merge_keys(postures: Iterable[KeyPosture], added: Iterable[KeyPosture]) -> list[KeyPosture]:
    """Return key postures in order of time; one added at the instant of a key keys more limbs."""
    by_time = {p.time: p for p in postures}
    for new in added:
        old = by_time.get(new.time)
        if old is not None:
            passing = old.passing | (new.limbs - old.limbs)
            new = replace(new, limbs=old.limbs | new.limbs, passing=passing, origin=old.origin)
        by_time[new.time] = new
    return sorted(by_time.values(), key=lambda p: p.time)


def _keyed(
    postures: Sequence[KeyPosture],
    in_between: InBetweenSolver,
    interpolation: Interpolation,
    frame_times: Iterable[Fraction],
) -> KeyedMovement:
    """Join key postures and sample the movement at frames and keys."""
    movement = interpolation.through(postures)
    times = sorted({*frame_times, *(p.time for p in postures)})
    samples = sample_movement(movement, times, in_between.monitor.evaluator)
    return KeyedMovement(tuple(postures), movement, samples)


def worst_instants(keyed: KeyedMovement, monitor: ResidualMonitor) -> list[Fraction]:
    """Return the worst instant of every stretch between keys that has one out of tolerance."""
    key_times = sorted({p.time for p in keyed.postures})
    if len(key_times) < 2:
        return []
    samples = keyed.samples
    key_s = np.array([float(t) for t in key_times])
    stretch = np.clip(np.searchsorted(key_s, samples.seconds, side="right") - 1, 0, len(key_s) - 2)
    ratio = _residual_ratios(samples, monitor, _key_rows(keyed), _unmet_rows(keyed))
    out = []
    for s in np.unique(stretch[ratio > 1.0]):
        members = np.flatnonzero(stretch == s)
        out.append(samples.times[int(members[int(np.argmax(ratio[members]))])])
    return out


def _key_rows(keyed: KeyedMovement) -> dict[str, Rows]:
    """Return the rows of every limb's keys among the samples, increasing."""
    found: dict[str, list[int]] = {name: [] for name in keyed.movement.limbs.names}
    rows = np.searchsorted(keyed.samples.seconds, [float(p.time) for p in keyed.postures])
    for posture, row in zip(keyed.postures, rows.tolist(), strict=True):
        for limb in posture.limbs:
            found[limb].append(row)
    return {limb: np.array(rows, dtype=np.int64) for limb, rows in found.items()}


def _unmet_rows(keyed: KeyedMovement) -> dict[Constraint, set[int]]:
    """Return the rows of the keys at which the solver could not meet a constraint."""
    found: dict[Constraint, set[int]] = {}
    rows = np.searchsorted(keyed.samples.seconds, [float(p.time) for p in keyed.postures])
    for posture, row in zip(keyed.postures, rows.tolist(), strict=True):
        for answer in posture.report.constraints:
            if not answer.met:
                found.setdefault(answer.task.constraint, set()).add(row)
    return found


def _residual_ratios(
    samples: MovementSamples,
    monitor: ResidualMonitor,
    key_rows: Mapping[str, Rows],
    unmet_rows: Mapping[Constraint, set[int]],
) -> Array:
    """Return the largest ratio of residual to allowed residual at every instant, (T,).

    Allowed is `TOLERANCE_SHARE` of the tolerance. A key is decided for a task if it keys all limbs
    that the task uses, or was solved without meeting it: no better posture is to be had there.
    Between decided keys the larger of their residuals, times `UNMET_SHARE`, is allowed.
    """
    ratio = np.zeros(len(samples.times))
    for task in monitor.measured_tasks:
        rows = monitor.rows_inside(task, samples.seconds, enforced=True)
        if rows.start == rows.stop:
            continue
        residual = monitor.residual(task, samples.only(rows))
        by_limb = [_rows_around(key_rows[limb], rows) for limb in task.used_limbs or key_rows]
        keys = np.unique(np.concatenate(by_limb))
        decided = np.isin(keys, [*unmet_rows.get(task.constraint, ())])
        decided |= np.all([np.isin(keys, own) for own in by_limb], axis=0)
        ends = keys[decided]
        allowed = np.full(len(ends) + 1, monitor.tolerance(task) * TOLERANCE_SHARE)
        inside = np.flatnonzero((ends >= rows.start) & (ends < rows.stop))
        allowed[inside] = np.fmax(
            allowed[inside], UNMET_SHARE * residual[ends[inside] - rows.start]
        )
        after = np.searchsorted(ends, np.arange(rows.start, rows.stop))
        task_ratio = residual / np.maximum(allowed[after - 1], allowed[after])
        at_keys = keys[(keys >= rows.start) & (keys < rows.stop)] - rows.start
        task_ratio[at_keys] *= TOLERANCE_SHARE
        task_ratio[_too_close_to_keys(samples.seconds, keys, rows)] = 0.0
        ratio[rows] = np.fmax(ratio[rows], task_ratio)
    return ratio


def _rows_around(keys: Rows, rows: slice) -> Rows:
    """Return the rows of a limb's keys inside some rows, with the one before and the one after."""
    first, last = np.searchsorted(keys, (rows.start, rows.stop))
    return keys[max(0, int(first) - 1) : int(last) + 1]


def _too_close_to_keys(seconds: Array, keys: Rows, rows: slice) -> NDArray[np.bool_]:
    """Return which instants of some rows are so close to a key that none can be added, (R,)."""
    if not len(keys):
        return np.zeros(rows.stop - rows.start, dtype=np.bool_)
    at, key_s = seconds[rows], seconds[keys]
    after = np.searchsorted(key_s, at)
    away = np.minimum(
        np.abs(at - key_s[np.maximum(after - 1, 0)]),
        np.abs(key_s[np.minimum(after, len(key_s) - 1)] - at),
    )
    return np.asarray((away > 0.0) & (away < CLOSEST_S))


def _frames_around(
    added: Sequence[Fraction], keys: Sequence[Fraction], frame_times: Sequence[Fraction]
) -> list[Fraction]:
    """Return the frames in the stretches that added keys change."""
    rows: set[int] = set()
    for time in added:
        k = bisect_left(keys, time)
        first = keys[max(0, k - 1 - NEIGHBOURS)]
        last = keys[min(len(keys) - 1, k + NEIGHBOURS)]
        rows.update(range(bisect_left(frame_times, first), bisect_right(frame_times, last)))
    return [frame_times[i] for i in sorted(rows)]
