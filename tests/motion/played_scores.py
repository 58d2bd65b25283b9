"""Scores of single blocks, played on the body that ships, and what is read from the movement."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import cache

import numpy as np

from azee.animation import Animation, animate
from azee.quality.constraint_results import ConstraintResult
from azee.score.interval import Interval
from azee.score.score import Block, Call, Group, Hold, Key, Score
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver.constraint import (
    BoneAxis,
    Constraint,
    Orient,
    Place,
    Relation,
    Rotate,
    Transpath,
)
from azee_solver.geometry import (
    Bone,
    NamedPoint,
    Opp,
    Out,
    Side,
    SigningSpace,
    Site,
    Straight,
    Vec,
    VTranslate,
)

F = Fraction
S, W = Side.STRONG, Side.WEAK
UP = Vec(0, 1, 0)
INWARD = Opp(Out(S))
MIDDLE = NamedPoint(SigningSpace.MSSP)
TIP = Site("I_TIP", S)


@cache
def rig() -> Rig:
    return load_rig()


def at(site: Site, x: float, y: float, z: float) -> Place:
    return Place(site, VTranslate(MIDDLE, Vec(x, y, z)))


def block(name: str, start: str, length: str, *constraints: Constraint) -> Block:
    interval = Interval(F(start), F(start) + F(length))
    return Block(name, interval, Key(F(length), constraints=constraints))


def hold(name: str, start: str, length: str, of: str, *channels: str) -> Block:
    interval = Interval(F(start), F(start) + F(length))
    return Block(name, interval, Hold(F(length), block=of, channels=channels or ("hands",)))


def sync(*blocks: Block, rule: str | None = None) -> Group:
    calls = () if rule is None else (Call(rule),)
    return Group(max(b.interval_in_parent.end for b in blocks), blocks=blocks, calls=calls)


@cache
def played(
    score: Score, *, fps: float = 30.0, dominant: Side = Side.RIGHT, precise: bool = False
) -> Animation:
    return animate(score, rig(), fps=fps, dominant=dominant, life=False, precise=precise)


def results(animation: Animation) -> dict[str, ConstraintResult]:
    return {"/".join(c.path) + f" {c.kind}": c for c in animation.report.constraints}


def tip_track(animation: Animation, site: str = "I_TIP_R") -> np.ndarray:
    frames = rig().chain.frames(animation.clip.coordinates)
    return rig().sites[site].point(frames)


def frame_at(animation: Animation, score_s: float) -> int:
    return int(np.argmin(np.abs(animation.clip.times - animation.lead_s - score_s)))


TWO_KEYS = sync(
    block("START", "0", ".2", at(TIP, 0, 0.05, 0)),
    block("END", ".6", ".2", at(TIP, -0.1, -0.1, 0)),
    block("PALM", "0", ".8", Orient(BoneAxis.NRM, Bone("palm", S), Relation.ALONG, INWARD)),
)
PATH = sync(
    block("START", "0", ".2", at(TIP, 0, 0.1, 0)),
    block("MOVE", ".2", ".6", Transpath(TIP, Straight())),
    block("END", ".8", ".2", at(TIP, 0, -0.1, 0)),
)
SHAKE = sync(
    block("SIGN", "0", "1.2", at(TIP, 0, 0.05, 0)),
    block("R", ".3", ".1", Rotate(Bone("head"), UP, math.radians(-15))),
    block("L", ".6", ".1", Rotate(Bone("head"), UP, math.radians(15))),
)


NEARLY_RAD = math.radians(1.0)
"""Hands beside the trunk are drawn from it by so much."""
