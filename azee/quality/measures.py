"""What a clip is worth beside its constraints: how fast joints turn, and what enters what."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.avoidance import Clearing
from azee.motion.curves.capsule_overlap import Overlaps
from azee.motion.tasks.timed_task import Bound, GivingWay
from azee_rig.rig import Rig
from azee_solver.penetration import mesh_penetration

Array = NDArray[np.float64]

SEEN_M = -0.002
"""Where capsules are as near as this the skin is looked at: they do not hold all of it."""
LEAST_M = 0.001
"""Shallower penetration of the skin is not told."""
FINGERS_LEAST_M = 0.003
"""Fingers of one hand have no skin to judge by here: capsules, and only what shows."""


@dataclass(frozen=True, slots=True)
class CoordinatePeaks:
    """Largest speed, acceleration and jerk of a coordinate, radians and seconds, and when."""

    coordinate: str
    speed: float
    acceleration: float
    jerk: float
    fastest_s: float

    def as_json(self) -> dict[str, object]:
        """Return it as the report's JSON has it."""
        return {
            "coordinate": self.coordinate,
            "speed_rad_s": self.speed,
            "acceleration_rad_s2": self.acceleration,
            "jerk_rad_s3": self.jerk,
            "fastest_s": self.fastest_s,
        }


def peaks(q: Array, fps: float, names: Sequence[str], lead_s: float) -> tuple[CoordinatePeaks, ...]:
    """Measure every coordinate by differences of frames; those that never move are left out.

    Args: q: (T, V). lead_s: when the score's time line starts in the clip.
    """
    speed, acceleration, jerk = (
        np.abs(np.diff(q, n=n, axis=0)) * fps**n if len(q) > n else np.zeros((1, q.shape[1]))
        for n in (1, 2, 3)
    )
    return tuple(
        CoordinatePeaks(
            name,
            float(speed[:, v].max()),
            float(acceleration[:, v].max()),
            float(jerk[:, v].max()),
            (int(speed[:, v].argmax()) + 0.5) / fps - lead_s,
        )
        for v, name in enumerate(names)
        if np.any(speed[:, v] > 0.0)
    )


@dataclass(frozen=True, slots=True)
class Penetration:
    """Something inside something else for a while, on the score's time line.

    time_s: when it is deepest. pair: what is in what. on: what was measured, skin or capsules.
    intended: a touch that the score asks for.
    """

    start_s: float
    end_s: float
    time_s: float
    pair: tuple[str, str]
    depth_m: float
    on: str
    intended: bool

    def as_json(self) -> dict[str, object]:
        """Return it as the report's JSON has it."""
        return {
            "start_s": self.start_s,
            "end_s": self.end_s,
            "time_s": self.time_s,
            "pair": [*self.pair],
            "depth_m": self.depth_m,
            "on": self.on,
            "intended": self.intended,
        }


def penetrations(rig: Rig, q: Array, times_s: Array, clearing: Clearing) -> tuple[Penetration, ...]:
    """Look for penetration in every frame: with capsules, then on the skin where they are near.

    Args: q: (T, V). times_s: (T,) on the score's time line.
    """
    overlaps = clearing.overlaps
    plain = overlaps.reach(())
    depth = np.vstack([overlaps.depth(part, plain) for part in _chunks(q)])
    same_hand = overlaps.same_hand
    out: list[Penetration] = []
    for regions, columns in _by_regions(overlaps, ~same_hand).items():
        deepest = depth[:, columns].max(axis=1)
        for run in _runs(deepest > SEEN_M):
            worst = run[int(deepest[run].argmax())]
            found = [p for p in mesh_penetration(rig, q[worst]) if {p.limb, p.body} == {*regions}]
            if not found or found[0].depth_m < LEAST_M:
                continue
            pair = columns[int(depth[worst, columns].argmax())]
            span = float(times_s[run[0]]), float(times_s[run[-1]]), float(times_s[worst])
            meant = _meant(clearing, pair, float(times_s[worst]))
            out.append(
                Penetration(*span, (found[0].limb, found[0].body), found[0].depth_m, "skin", meant)
            )
    for pair in np.flatnonzero(same_hand & (depth.max(axis=0) > FINGERS_LEAST_M)).tolist():
        for run in _runs(depth[:, pair] > FINGERS_LEAST_M):
            worst = run[int(depth[run, pair].argmax())]
            span = float(times_s[run[0]]), float(times_s[run[-1]]), float(times_s[worst])
            meant = _meant(clearing, pair, float(times_s[worst]))
            out.append(
                Penetration(
                    *span, overlaps.names(pair), float(depth[worst, pair]), "capsules", meant
                )
            )
    return tuple(sorted(out, key=lambda p: (p.start_s, p.pair)))


def block_times(
    bounds: Iterable[Bound], giving_way: Mapping[int, GivingWay]
) -> list[dict[str, object]]:
    """Return the blocks of a score with their times, and until when each holds what it asks."""
    found: dict[tuple[str, ...], dict[str, object]] = {}
    for b in bounds:
        r = b.requirement
        given = giving_way.get(r.rank)
        held = float(r.interval.end if given is None else given.start)
        row = found.setdefault(
            r.path,
            {
                "path": [*r.path],
                "start_s": float(r.interval.start),
                "end_s": float(r.interval.end),
                "held_until_s": held,
            },
        )
        row["held_until_s"] = min(held, float(str(row["held_until_s"])))
    return list(found.values())


def _chunks(q: Array) -> list[Array]:
    return np.array_split(q, max(1, len(q) // 240))


def _meant(clearing: Clearing, pair: int, time_s: float) -> bool:
    """Whether a pair may come nearer than others because the score wants a touch."""
    overlaps = clearing.overlaps
    wanted = overlaps.reach(clearing.meant(time_s, time_s))
    return bool(wanted[pair] < overlaps.reach(())[pair] - 1e-9)


def _runs(hits: NDArray[np.bool_]) -> list[NDArray[np.int64]]:
    rows = np.flatnonzero(hits)
    return [run for run in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1) if len(run)]


def _by_regions(
    overlaps: Overlaps, chosen: NDArray[np.bool_]
) -> dict[tuple[str, str], NDArray[np.int64]]:
    """Columns of pairs by the parts of the body that they belong to, (…,) indices each."""
    found: dict[tuple[str, str], list[int]] = {}
    for pair in np.flatnonzero(chosen).tolist():
        a, b = sorted(overlaps.regions(pair))
        if a != b:
            found.setdefault((a, b), []).append(pair)
    return {regions: np.array(pairs, dtype=np.int64) for regions, pairs in found.items()}
