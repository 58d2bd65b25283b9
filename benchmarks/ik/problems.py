"""The problems of the comparison: reachable ones from random postures, contacts, far targets.

Problem n of a class is drawn with the seed (SEED, class, n). So none was chosen by hand, and a
shorter run has the first problems of a longer one. The posture that gave the targets is within the
limits and, on a body with capsules, without overlap. So the problem is known to be solvable.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.rig import Rig
from azee_solver.anatomy import anatomy
from azee_solver.binding import Binding
from azee_solver.collisions import Obstacles
from azee_solver.constraint import BoneAxis, Constraint, Orient, Place, Relation
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Bone, Dir, Nrm, Opp, Side, Site, SitePoint, Vec, WorldPoint
from azee_solver.task import Task
from benchmarks.ik.levenberg import Flat

Array = NDArray[np.float64]

SEED = 2018
S, W = Side.STRONG, Side.WEAK
UP = Vec(0.0, 1.0, 0.0)
DIR, NRM = BoneAxis.DIR, BoneAxis.NRM
TIGHT = (1e-3, math.radians(0.5))
LOOSE = (1e-2, math.radians(5.0))
"""Tolerances, metres and radians: ours, and the paper's."""
TRUNK_SHARE = 0.4
"""Share of its range that the trunk may use, since signers do not fold their trunk."""


@dataclass(frozen=True, slots=True, eq=False)
class Problem:
    """Constraints of one moment.

    free: coordinates that are known to suffice. truth: a posture (V,) that meets all, if known.
    """

    kind: str
    number: int
    tasks: tuple[Task, ...]
    free: tuple[int, ...]
    truth: Array | None = None

    @property
    def constraints(self) -> list[Constraint]:
        """The constraints, in order."""
        return [task.constraint for task in self.tasks]


class Maker:
    """Draws problems for one body."""

    def __init__(self, rig: Rig) -> None:
        self.rig, self.evaluator = rig, Evaluator(rig, Side.RIGHT)
        names = rig.coordinates.names
        limits = rig.coordinates
        self.middle, self.half = (
            (limits.lower + limits.upper) / 2,
            (limits.upper - limits.lower) / 2,
        )

        def of(*starts: str) -> tuple[int, ...]:
            return tuple(v for v, name in enumerate(names) if name.startswith(starts))

        self.trunk = of("back")
        self.arm = {s: of(f"clav_{s}", f"arm_{s}", f"f_arm_{s}", f"palm_{s}") for s in "LR"}
        self.thumb = of("thumb_R")
        self.index = of("index_R")
        self.fingers = of("index_R", "middle_R", "ring_R", "little_R")
        obstacles = Obstacles(Binding(rig, Side.RIGHT), anatomy(rig.chain, limits), [])
        self.clear: Callable[[Array], bool] = lambda q: not obstacles.overlaps(q)

    def classes(self) -> dict[str, Callable[[np.random.Generator], Problem | None]]:
        """Return a function per class that draws a problem, or none if a draw is unusable."""
        return {
            "place": self.place,
            "place, 1 orientation": self.place_and_orientation,
            "4 orientations": self.four,
            "place, 2 at stops": self.stops,
            "two-handed contact": self.contact,
            "tree": self.tree,
            "unreachable": self.unreachable,
        }

    def problems(self, kind: str, count: int) -> Iterator[Problem]:
        """Yield the first problems of a class."""
        index = list(self.classes()).index(kind)
        for number in range(count):
            rng = np.random.default_rng((SEED, index, number))
            found = None
            while found is None:
                found = self.classes()[kind](rng)
            yield Problem(kind, number, found.tasks, found.free, found.truth)

    # Postures ---------------------------------------------------------------------------------

    def posture(
        self, rng: np.random.Generator, free: tuple[int, ...], spread: float = 0.9, stops: float = 0
    ) -> Array | None:
        """Return random coordinates within the limits, some at a limit; none if parts overlap.

        Args: spread: share of the ranges that is used.
        """
        q = np.array(self.rig.coordinates.idle)
        x = np.where(
            rng.random(len(q)) < stops,
            np.where(rng.random(len(q)) < 0.5, -1.0, 1.0),
            spread * rng.uniform(-1, 1, len(q)),
        )
        x[list(self.trunk)] *= TRUNK_SHARE
        q[list(free)] = (self.middle + self.half * x)[list(free)]
        np.clip(q, self.rig.coordinates.lower, self.rig.coordinates.upper, out=q)
        return q if self.clear(q) else None

    def at(self, site: str, side: Side, q: Array) -> Place:
        """Return the placement of a site at its place in a posture."""
        named = Site(site, side)
        x, y, z = self.evaluator.site(named, self.rig.chain.frames(q)).tolist()
        return Place(named, WorldPoint(x, y, z))

    def as_in(self, axis: BoneAxis, bone: Bone, q: Array) -> Orient:
        """Return the orientation of a bone in a posture."""
        x, y, z = self.evaluator.axis(bone, axis, self.rig.chain.frames(q)).tolist()
        return Orient(axis, bone, Relation.ALONG, Vec(x, y, z))

    # Classes ----------------------------------------------------------------------------------

    def place(self, rng: np.random.Generator) -> Problem | None:
        """Draw: the tip of the index finger at a point."""
        free = self.trunk + self.arm["R"]
        q = self.posture(rng, free)
        return None if q is None else problem([self.at("I_TIP", S, q)], free, q)

    def place_and_orientation(self, rng: np.random.Generator) -> Problem | None:
        """Draw the same, with one axis of the hand along or (one in four) across a direction."""
        free = self.trunk + self.arm["R"]
        q = self.posture(rng, free)
        if q is None:
            return None
        palm, axis = Bone("palm", S), (DIR, NRM)[int(rng.integers(2))]
        orient = self.as_in(axis, palm, q)
        if rng.random() < 0.25:
            assert isinstance(orient.vector, Vec)
            v = np.array([orient.vector.x, orient.vector.y, orient.vector.z])
            across = np.cross(v, rng.normal(size=3))
            x, y, z = (across / np.linalg.norm(across)).tolist()
            orient = Orient(axis, palm, Relation.ACROSS, Vec(x, y, z))
        return problem([self.at("I_TIP", S, q), orient], free, q)

    def four(self, rng: np.random.Generator) -> Problem | None:
        """Draw the paper's problem 2: directions of the thumb, upright arm and hand."""
        free = self.trunk + self.arm["R"] + self.thumb
        base: list[Constraint] = [
            Orient(DIR, Bone("palm", S), Relation.ALONG, UP),
            Orient(DIR, Bone("f_arm", S), Relation.ALONG, UP),
        ]
        q = self.met(rng, base, free, self.trunk + self.arm["R"])
        return None if q is None else problem([*self.thumb_as_in(q), *base], free, q)

    def thumb_as_in(self, q: Array) -> list[Constraint]:
        """Return the paper's constraints on the thumb, with the directions of a posture."""
        return [
            self.as_in(DIR, Bone("thumb", S, 3), q),
            self.as_in(NRM, Bone("thumb", S, 2), q),
        ]

    def met(
        self,
        rng: np.random.Generator,
        constraints: list[Constraint],
        free: tuple[int, ...],
        moved: tuple[int, ...],
    ) -> Array | None:
        """Return a random posture that the LM kernel has changed to meet some constraints."""
        start = self.posture(rng, free)
        if start is None:
            return None
        flat = Flat(self.rig, constraints, moved, (TIGHT[0] / 100, TIGHT[1] / 100))
        q, _ = flat.descend(start)
        return q if flat.worst(q) <= 1 and self.clear(q) else None

    def stops(self, rng: np.random.Generator) -> Problem | None:
        """Draw: a place and the whole rotation of the hand, two fifths of the joints at a limit."""
        free = self.trunk + self.arm["R"]
        q = self.posture(rng, free, spread=1.0, stops=0.4)
        if q is None:
            return None
        palm = Bone("palm", S)
        axes = [self.as_in(DIR, palm, q), self.as_in(NRM, palm, q)]
        return problem([self.at("I_TIP", S, q), *axes], free, q)

    def contact(self, rng: np.random.Generator) -> Problem | None:
        """Draw: the weak hand somewhere in front, the strong hand touching it, some palms turned.

        These problems are not known to be solvable; they are judged by what any method solves.
        """
        weak = ("PA", "H_BACK")[int(rng.integers(2))]
        strong = ("I_TIP", "M_TIP", "T_TIP", "PA")[int(rng.integers(4))]
        touched = Site(("PA", "H_BACK", "I_TIP", "M_TIP")[int(rng.integers(4))], W)
        low, high = np.array([-0.15, -0.35, 0.2]), np.array([0.25, 0.05, 0.42])
        scale = self.evaluator.scale
        middle = self.rig.landmarks.shoulder_middle
        x, y, z = (middle + scale * rng.uniform(low, high)).tolist()
        constraints: list[Constraint] = [
            Place(Site(weak, W), WorldPoint(x, y, z)),
            Place(Site(strong, S), SitePoint(touched), contact=True),
        ]
        turned = int(rng.integers(3))
        if turned >= 1:
            up = (UP, Vec(0.0, 0.0, -1.0), Vec(-1.0, 0.0, 0.0))[int(rng.integers(3))]
            constraints.append(Orient(NRM, Bone("palm", W), Relation.ALONG, up))
        if turned == 2:
            facing = Opp(Nrm(Bone("palm", W)))
            constraints.append(Orient(NRM, Bone("palm", S), Relation.ALONG, facing))
        return problem(constraints, self.trunk + self.arm["L"] + self.arm["R"])

    def tree(self, rng: np.random.Generator) -> Problem | None:
        """Draw the paper's eleven problems at some place, with a possible thumb."""
        low, high = np.array([-0.2, -0.32, 0.18]), np.array([0.05, -0.18, 0.32])
        x, y, z = (
            self.rig.landmarks.shoulder_middle + self.evaluator.scale * rng.uniform(low, high)
        ).tolist()
        forearm, palm, weak = Bone("f_arm", S), Bone("palm", S), Bone("palm", W)
        hands: list[Constraint] = [
            Place(Site("H_BACK", W), WorldPoint(x, y, z)),
            Orient(NRM, weak, Relation.ALONG, UP),
            Orient(DIR, weak, Relation.ALONG, Dir(Bone("f_arm", W))),
            Place(Site("EL", S), SitePoint(Site("PA", W)), contact=True),
            Orient(DIR, forearm, Relation.ALONG, UP),
            Orient(DIR, palm, Relation.ALONG, UP),
        ]
        arms = self.arm["L"] + self.arm["R"]
        start = np.array(self.rig.coordinates.idle)
        spread = 0.9 * rng.uniform(-1, 1, len(start))
        moved = list(arms + self.thumb)
        start[moved] = (self.middle + self.half * spread)[moved]
        flat = Flat(self.rig, hands, arms, (TIGHT[0] / 100, TIGHT[1] / 100))
        q, _ = flat.descend(start)
        if flat.worst(q) > 1:
            return None
        fingers: list[Constraint] = []
        for name in ("index", "middle", "ring", "little"):
            first, second = Bone(name, S, 1), Bone(name, S, 2)
            fingers.append(Orient(DIR, first, Relation.ALONG, Dir(palm)))
            fingers.append(Orient(DIR, second, Relation.ALONG, Dir(first)))
        whole = [*hands, *self.thumb_as_in(q), *fingers]
        return problem(whole, self.trunk + arms + self.thumb + self.fingers)

    def unreachable(self, rng: np.random.Generator) -> Problem | None:
        """Draw: the index finger at a point farther from the shoulder than it can reach."""
        free = self.trunk + self.arm["R"] + self.index
        q = self.posture(rng, free)
        if q is None:
            return None
        frames = self.rig.chain.frames(q)
        shoulder = frames.positions[self.rig.bones["arm_R"].origin_node]
        tip = self.evaluator.site(Site("I_TIP", S), frames)
        away = (tip - shoulder) / np.linalg.norm(tip - shoulder)
        reach = self.rig.landmarks.arm_m
        x, y, z = (shoulder + away * reach * rng.uniform(1.9, 2.6)).tolist()
        return problem([Place(Site("I_TIP", S), WorldPoint(x, y, z))], free)


def problem(
    constraints: list[Constraint], free: tuple[int, ...], truth: Array | None = None
) -> Problem:
    """Return constraints as a problem, in the order in which they are written."""
    tasks = tuple(Task(c, rank=i) for i, c in enumerate(constraints))
    return Problem("", 0, tasks, free, truth)
