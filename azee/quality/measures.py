"""Measures of a clip beside its constraints: speeds of joints, penetration, times of blocks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.avoidance import CollisionAvoidance
from azee.motion.curves.capsule_overlap import CapsuleOverlaps
from azee.motion.tasks.interval_index import IntervalIndex
from azee.motion.tasks.schedule import TaskSchedule
from azee.motion.tasks.timed_task import EarlyEnd, TimedTask
from azee.score.interval import Interval
from azee_rig.rig import Rig
from azee_solver.constraint import Place
from azee_solver.evaluate import evaluator as evaluator_of
from azee_solver.geometry import Side, SitePoint
from azee_solver.penetration import Contact, meant_contact, mesh_penetration

Array = NDArray[np.float64]

NEAR_SKIN_M = -0.002
"""The skin is measured where capsules overlap by more, or are nearer, than this: they do not
enclose all of it."""
LEAST_M = 0.001
"""Shallower penetration of the skin is not reported."""
FINGERS_LEAST_M = 0.003
"""Shallower penetration of fingers of one hand would not be seen."""
TOUCH_S = 0.15
"""What touches because the score asks for it may be as near this long before and after."""
FORMED_S, FORMED_RAD = 1.0, np.radians(8.0)
"""Fingers form a hand shape while the arm still moves: those within this angle of a shape whose
digits touch touch as it asks, this long before."""


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
    """One part of the body inside another for a while, on the score's time line.

    time_s: when it is deepest. pair: the two parts. depth_m: on the skin. intended: the
    score asks for a touch there.
    """

    start_s: float
    end_s: float
    time_s: float
    pair: tuple[str, str]
    depth_m: float
    intended: bool

    def as_json(self) -> dict[str, object]:
        """Return it as the report's JSON has it."""
        return {
            "start_s": self.start_s,
            "end_s": self.end_s,
            "time_s": self.time_s,
            "pair": [*self.pair],
            "depth_m": self.depth_m,
            "intended": self.intended,
        }


@dataclass(frozen=True, slots=True, eq=False)
class PenetrationSearch:
    """Finds the penetrations of one clip when called. It can be pickled.

    coordinates: (T, V) radians. times_s: (T,) on the score's time line.
    """

    rig: Rig
    dominant: Side
    schedule: TaskSchedule
    coordinates: Array
    times_s: Array

    def __call__(self) -> tuple[Penetration, ...]:
        """Find penetration in every frame, on the skin where capsules are near or overlap."""
        avoidance = self._avoidance()
        overlaps = avoidance.overlaps
        no_touch = overlaps.axis_distances(())
        depths = np.vstack([overlaps.depths(part, no_touch) for part in _chunks(self.coordinates)])
        on_skin = _on_skin(self.rig, self.coordinates, self.times_s, avoidance, depths)
        return tuple(sorted((*on_skin, *self.between_fingers()), key=lambda p: (p.start_s, p.pair)))

    def between_fingers(self) -> tuple[Penetration, ...]:
        """Find fingers of one hand inside each other in every frame."""
        avoidance = self._avoidance()
        overlaps = avoidance.overlaps
        pairs = np.flatnonzero(overlaps.same_hand)
        no_touch = overlaps.axis_distances(())
        depths = np.vstack([overlaps.depths(q, no_touch, pairs) for q in _chunks(self.coordinates)])
        found = _between_fingers(self, avoidance, pairs, depths)
        return tuple(sorted(found, key=lambda p: (p.start_s, p.pair)))

    def _avoidance(self) -> CollisionAvoidance:
        evaluator = evaluator_of(self.rig, self.dominant)
        overlaps = CapsuleOverlaps(evaluator)
        return CollisionAvoidance(evaluator, self.schedule, IntervalIndex(()), overlaps)


def _on_skin(
    rig: Rig, q: Array, times_s: Array, avoidance: CollisionAvoidance, depths: Array
) -> Iterator[Penetration]:
    """Yield what penetrates what on the skin, once per stretch of frames with near capsules."""
    overlaps = avoidance.overlaps
    for regions, columns in _by_regions(overlaps, ~overlaps.same_hand).items():
        deepest = depths[:, columns].max(axis=1)
        for run in _runs(deepest > NEAR_SKIN_M):
            worst = run[int(deepest[run].argmax())]
            found = [
                p
                for p in mesh_penetration(rig, q[worst])
                if {_region(p.limb), _region(p.body)} == {*regions}
            ]
            if not found or found[0].depth_m < LEAST_M:
                continue
            pair = columns[int(depths[worst, columns].argmax())]
            span = float(times_s[run[0]]), float(times_s[run[-1]]), float(times_s[worst])
            intended = _is_intended(avoidance, pair, float(times_s[worst]))
            names = (found[0].limb, found[0].body)
            yield Penetration(*span, names, found[0].depth_m, intended)


def _region(part: str) -> str:
    """Return the region of a part of the skin: a digit belongs to its arm."""
    return part if part in ("trunk", "head") else f"arm_{part[-1]}"


def _between_fingers(
    search: PenetrationSearch,
    avoidance: CollisionAvoidance,
    pairs: NDArray[np.int64],
    depths: Array,
) -> Iterator[Penetration]:
    """Yield which fingers of one hand are in each other, once per stretch of frames.

    Capsules, (T, P), tell where to look; what counts is the skin. About a touch that the score asks
    for, skin that yields is no penetration.
    """
    overlaps, times_s = avoidance.overlaps, search.times_s
    digits: dict[tuple[str, str], list[int]] = {}
    for column, pair in enumerate(pairs.tolist()):
        first, second = sorted(_digit(name) for name in overlaps.names(pair))
        digits.setdefault((first, second), []).append(column)
    for names, columns in digits.items():
        deepest = depths[:, columns].max(axis=1)
        for run in _runs(deepest > FINGERS_LEAST_M):
            worst = run[int(deepest[run].argmax())]
            span = float(times_s[run[0]]), float(times_s[run[-1]]), float(times_s[worst])
            depth, intended = _in_skin(search, avoidance, worst, names)
            if depth > FINGERS_LEAST_M:
                yield Penetration(*span, names, depth, intended)


def _in_skin(
    search: PenetrationSearch, avoidance: CollisionAvoidance, frame: int, digits: tuple[str, str]
) -> tuple[float, bool]:
    """Return how deep the skins of two digits are in each other, and whether that is a touch."""
    q = search.coordinates[frame]
    evaluator = avoidance.evaluator
    frames = evaluator.rig.chain.frames(q)
    touches = [meant_contact(evaluator, frames, place) for place in _touches(search, frame, digits)]

    def deepest(contacts: Sequence[Contact]) -> float:
        found = mesh_penetration(search.rig, q, contacts, digits)
        return max((p.depth_m for p in found if {p.limb, p.body} == {*digits}), default=0.0)

    unmeant = deepest(touches)
    if unmeant > FINGERS_LEAST_M or not touches:
        return unmeant, False
    return deepest(()), True


def _touches(search: PenetrationSearch, frame: int, digits: tuple[str, str]) -> Iterator[Place]:
    """Yield the touches that the score asks for about a frame, or in the shape that digits have."""
    time_s = float(search.times_s[frame])
    own = [v for v, name in enumerate(search.rig.coordinates.names) if name.startswith(digits)]
    span = Interval(
        Fraction(time_s - TOUCH_S).limit_denominator(10**6),
        Fraction(time_s + FORMED_S).limit_denominator(10**6),
    )
    for task in search.schedule.in_force.overlapping(span):
        place, start_s = task.constraint, float(task.interval.start)
        if not isinstance(place, Place) or not isinstance(place.point, SitePoint):
            continue
        then = int(np.abs(search.times_s - start_s).argmin())
        turn = np.abs(search.coordinates[frame, own] - search.coordinates[then, own])
        if start_s - time_s <= TOUCH_S or float(turn.max(initial=0.0)) <= FORMED_RAD:
            yield place


def _digit(name: str) -> str:
    """Return the digit of a capsule or bone such as `thumb_R_3`."""
    return name[: name.rindex("_")]


def block_times(
    tasks: Iterable[TimedTask], early_ends: Mapping[int, EarlyEnd]
) -> list[dict[str, object]]:
    """Return the blocks of a score with their times, and until when their constraints hold."""
    found: dict[tuple[str, ...], dict[str, object]] = {}
    for task in tasks:
        early = early_ends.get(task.rank)
        held = float(task.interval.end if early is None else early.time)
        row = found.setdefault(
            task.path,
            {
                "path": [*task.path],
                "start_s": float(task.interval.start),
                "end_s": float(task.interval.end),
                "held_until_s": held,
            },
        )
        row["held_until_s"] = min(held, float(str(row["held_until_s"])))
    return list(found.values())


def _chunks(q: Array) -> list[Array]:
    return np.array_split(q, max(1, len(q) // 240))


def _is_intended(avoidance: CollisionAvoidance, pair: int, time_s: float) -> bool:
    """Whether a pair may come nearer than usual because the score asks for a touch."""
    overlaps = avoidance.overlaps
    allowed = overlaps.axis_distances(avoidance.intended_touches(time_s, time_s))
    return bool(allowed[pair] < overlaps.axis_distances(())[pair] - 1e-9)


def _runs(hits: NDArray[np.bool_]) -> list[NDArray[np.int64]]:
    """Return the rows of every stretch of hits."""
    rows = np.flatnonzero(hits)
    return [run for run in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1) if len(run)]


def _by_regions(
    overlaps: CapsuleOverlaps, chosen: NDArray[np.bool_]
) -> dict[tuple[str, str], NDArray[np.int64]]:
    """Return the chosen pairs by the parts of the body that they belong to, indices each."""
    found: dict[tuple[str, str], list[int]] = {}
    for pair in np.flatnonzero(chosen).tolist():
        a, b = sorted(overlaps.regions(pair))
        if a != b:
            found.setdefault((a, b), []).append(pair)
    return {regions: np.array(pairs, dtype=np.int64) for regions, pairs in found.items()}
