"""Scores with ways of one hand, performed on the body that ships, and how fast its wrist is."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import cache

import numpy as np

from azee.animation import Animation, animate
from azee.motion.tasks.limbs import Limbs
from azee.motion.timing.pace import Pace
from azee.motion.timing.ways import Ways
from azee.score.interval import Interval
from azee.score.score import Block, Group, Key, Score, leaves
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver.constraint import (
    Constraint,
    Place,
    Rotate,
)
from azee_solver.evaluate import evaluator
from azee_solver.geometry import Bone, Side, Site, Vec, WorldPoint

F = Fraction
S = Side.STRONG
PALM = Site("PA", S)
UP, DOWN = Vec(0, 1, 0), Vec(0, -1, 0)
LEFT, RIGHT = Place(PALM, WorldPoint(0.1, 1.2, 0.3)), Place(PALM, WorldPoint(-0.4, 1.2, 0.3))
NEAR = Place(PALM, WorldPoint(-0.35, 1.2, 0.3))


@cache
def rig() -> Rig:
    return load_rig()


SCALE = Ways(evaluator(rig(), Side.RIGHT), Limbs.of(rig().coordinates).members, Pace()).scale


def block(name: str, start: str, length: str, *constraints: Constraint) -> Block:
    interval = Interval(F(start), F(start) + F(length))
    return Block(name, interval, Key(F(length), constraints=constraints))


def inside(name: str, start: str, score: Score) -> Block:
    return Block(name, Interval(F(start), F(start) + score.duration), score)


def sync(*blocks: Block) -> Group:
    return Group(max(b.interval_in_parent.end for b in blocks), blocks=blocks)


def turned(degrees: float) -> Rotate:
    return Rotate(Bone("head"), UP, math.radians(degrees))


SHAKE = sync(block("A", "0", ".05", turned(-10)), block("B", ".13", ".05", turned(10)))
FAR = sync(block("A", "0", ".4", LEFT), block("B", ".6", ".4", RIGHT))
"""Half a metre in .2 s."""


@cache
def played(score: Score, timing: str | None = None, tempo: float = 1.0) -> Animation:
    return animate(score, rig(), fps=100, life=False, timing=timing, tempo=tempo)  # type: ignore[arg-type]


def times(score: Score) -> dict[str, tuple[float, float]]:
    return {
        "/".join(x.path): (float(x.interval.start), float(x.interval.end)) for x in leaves(score)
    }


def largest(animation: Animation, bone: str = "palm_R") -> tuple[float, float]:
    """Largest speed and acceleration of a wrist between the ends of the score."""
    at = animation.clip.times - animation.lead_s
    rows = (at >= 0) & (at <= float(animation.score.duration))
    q = animation.clip.coordinates[rows]
    wrist = rig().chain.frames(q).positions[:, rig().bones[bone].origin_node]
    return tuple(  # type: ignore[return-value]
        float(np.linalg.norm(np.diff(wrist, n, axis=0), axis=1).max() * 100**n) for n in (1, 2)
    )
