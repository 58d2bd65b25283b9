"""Facial morphs over time.

A facial block's weight rises and falls inside the block by minimum jerk: in a short block it is a
bell with its apex in the middle, in a longer one a plateau between two ramps (the curves that
Sharma 2024 publishes are bells). What a hold keeps goes on without a dip. Where a block follows
another of the same morph at once, the weight goes from one to the next. Overlapping blocks of one
morph do not add up: the stronger shows. Different morphs of the same part of the face do add up.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.motion.tasks.timed_task import TimedTask
from azee_solver.constraint import Morph
from azee_solver.geometry import Side

Array = NDArray[np.float64]

RAMP_S = 0.15
"""Length of the rise and of the fall of a weight."""
SHORTEST_RAMP_S = 0.05
"""A face cannot move faster: the ramps of a shorter block begin before it and end after it."""
LARGEST_WEIGHT = 1.0
"""Largest weight of a face unit to either side, unless one morph alone asks for more."""


@dataclass(frozen=True, slots=True)
class Plateau:
    """One weight of a morph, from when to when, on the score's time line."""

    start: Fraction
    end: Fraction
    weight: float


def face_weights(
    facial_morphs: Iterable[TimedTask],
    morphs: Mapping[str, Mapping[str, float]],
    units: Sequence[str],
    dominant: Side,
    times_s: Array,
) -> Array:
    """Return the weights of face units at increasing times, (T, len(units)).

    Args: morphs: weight that a morph of weight 1 gives each unit, as a rig has it.
    """
    plateaus: dict[str, list[Plateau]] = {}
    for task in facial_morphs:
        morph, interval = task.constraint, task.interval
        assert isinstance(morph, Morph)
        plateaus.setdefault(morph.key(dominant), []).append(
            Plateau(interval.start, interval.end, morph.weight)
        )
    out = np.zeros((len(times_s), len(units)))
    largest = np.full(len(units), LARGEST_WEIGHT)
    for name, blocks in plateaus.items():
        curve = weight_curve(blocks, times_s)
        strongest = max(abs(b.weight) for b in blocks)
        for unit, share in morphs[name].items():
            column = units.index(unit)
            out[:, column] += share * curve
            largest[column] = max(largest[column], abs(share) * strongest)
    return np.clip(out, -largest, largest)


def weight_curve(blocks: Iterable[Plateau], times_s: Array) -> Array:
    """Return a morph's weight at increasing times, (T,)."""
    out = np.zeros(len(times_s))
    for chain in _chains(blocks):
        first, last = float(chain[0].start) - RAMP_S, float(chain[-1].end) + RAMP_S
        ends = np.searchsorted(times_s, (first, last))
        rows = slice(int(ends[0]), int(ends[1]))
        curve = _chain_curve(chain, times_s[rows])
        out[rows] = np.where(np.abs(curve) > np.abs(out[rows]), curve, out[rows])
    return out


def _chains(blocks: Iterable[Plateau]) -> list[list[Plateau]]:
    """Group blocks that follow one another without a gap; those of equal weight become one."""
    chains: list[list[Plateau]] = []
    for block in sorted(blocks, key=lambda b: (b.start, b.end)):
        for chain in chains:
            last = chain[-1]
            if last.weight == block.weight and block.start <= last.end:
                chain[-1] = Plateau(last.start, max(last.end, block.end), last.weight)
                break
            if last.end == block.start:
                chain.append(block)
                break
        else:
            chains.append([block])
    return chains


def _chain_curve(chain: Sequence[Plateau], times_s: Array) -> Array:
    first, last = chain[0], chain[-1]
    attack, decay = _ramp(first), _ramp(last)
    rise = min(float(first.start), _middle(first) - attack)
    fall = max(float(last.end), _middle(last) + decay)
    out = first.weight * minimum_jerk((times_s - rise) / attack)
    weight = first.weight
    for block in chain[1:]:
        step = minimum_jerk((times_s - float(block.start)) / _ramp(block))
        out = out + (block.weight - weight) * step
        weight = block.weight
    return np.asarray(out - weight * minimum_jerk((times_s - (fall - decay)) / decay))


def _middle(block: Plateau) -> float:
    return float(block.start + block.end) / 2


def _ramp(block: Plateau) -> float:
    return min(RAMP_S, max(SHORTEST_RAMP_S, float(block.end - block.start) / 2))


def is_active(facial_morphs: Iterable[TimedTask], times_s: Array) -> NDArray[np.bool_]:
    """Whether a facial block shows at times, its ramps included, (T,)."""
    out = np.zeros(len(times_s), dtype=np.bool_)
    for task in facial_morphs:
        ends = (float(task.interval.start) - RAMP_S, float(task.interval.end) + RAMP_S)
        first, last = np.searchsorted(times_s, ends)
        out[first:last] = True
    return out
