"""Descents: what their first, soft stage is good for, and that weights come back."""

from __future__ import annotations

import numpy as np
import pytest
from stick_body import stick_body
from tree_sign import DIR, S, along, tasks

from azee_solver import block
from azee_solver.body import Body
from azee_solver.broadphase import broad_phase
from azee_solver.collisions import MARGIN_M
from azee_solver.constraint import Constraint, Place
from azee_solver.descent import scaled_weights, soft_descent, stiff_descent, without_margin
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Bone, Side, Site, Vec, WorldPoint
from azee_solver.group_search import GroupSearch
from azee_solver.options import SolveOptions

RIG = stick_body()
IDLE = np.array(RIG.coordinates.idle)
ARM = frozenset(
    v
    for v, name in enumerate(RIG.coordinates.names)
    if name.startswith(("back", "clav_R", "arm_R", "f_arm_R", "palm_R"))
)
OPTIONS = SolveOptions()


def search(seed: int) -> GroupSearch:
    """A fingertip and a palm's direction, as a random posture has them."""
    rng = np.random.default_rng(seed)
    limits = RIG.coordinates
    q = IDLE.copy()
    free = sorted(ARM)
    q[free] = (limits.lower + rng.uniform(0.2, 0.8, len(q)) * (limits.upper - limits.lower))[free]
    evaluator, frames = Evaluator(RIG, Side.RIGHT), RIG.chain.frames(q)
    x, y, z = evaluator.site(Site("I_TIP", S), frames).tolist()
    u, v, w = frames.rotations[RIG.bones["palm_R"].node][:, 1].tolist()
    asked: list[Constraint] = [
        Place(Site("I_TIP", S), WorldPoint(x, y, z)),
        along(DIR, Bone("palm", S), Vec(u, v, w)),
    ]
    body = Body(RIG, evaluator, IDLE, {}, OPTIONS, asked)
    return GroupSearch(body, dict(enumerate(tasks(*asked))), IDLE, ARM)


def test_soft_descents_end_lower_after_fewer_evaluations() -> None:
    soft, hard, work = [], [], []
    for seed in range(20):
        program = search(seed).program
        start = IDLE[program.free]
        ends = []
        for descend in (soft_descent, stiff_descent):
            before = program.evaluations
            ends.append(program(descend(program, start, OPTIONS), np.empty(0)))
            work.append(program.evaluations - before)
        soft.append(ends[0])
        hard.append(ends[1])
    ratios = np.array(soft) / np.array(hard)
    assert np.median(ratios) <= 1.0
    assert np.mean(ratios < 1.01) > 0.85
    assert sum(work[0::2]) < 0.7 * sum(work[1::2])


def test_kept_damping_goes_on_where_the_last_steps_ended() -> None:
    bold, anew = 0, 0
    for seed in range(10):
        program = search(seed).program
        x = soft_descent(program, IDLE[program.free], OPTIONS)
        before = program.evaluations
        on = program.gauss_newton(x, rounds=50, tolerance=1e-9, keep_damping=True)
        between = program.evaluations
        again = program.gauss_newton(x, rounds=50, tolerance=1e-9)
        bold, anew = bold + between - before, anew + program.evaluations - between
        ends = [program(end, np.empty(0)) for end in (on, again)]
        assert ends[0] == pytest.approx(ends[1], rel=1e-6)
    assert bold < anew


def test_without_margin_capsules_are_as_wide_as_they_are() -> None:
    program = search(0).program
    wished = program.section(block.PAIR_REACH).copy()
    margin = program.layout.margin
    assert set(margin.tolist()) == {0.0, MARGIN_M}
    with without_margin(program):
        np.testing.assert_array_equal(program.section(block.PAIR_REACH), wished - margin)
    np.testing.assert_array_equal(program.section(block.PAIR_REACH), wished)
    pairs = broad_phase(RIG, search(0).collisions).pairs
    names = np.array(RIG.capsules.names)[broad_phase(RIG, search(0).collisions).capsules]
    trunk = [any(n.startswith("trunk") for n in names[pair]) for pair in pairs]
    assert margin[trunk].min() == MARGIN_M


def test_weights_come_back_also_after_an_error() -> None:
    program = search(1).program
    x = IDLE[program.free]
    before = program(x, np.empty(0))
    kept = program.ints.copy()
    soft = scaled_weights(
        program,
        misses=0.5,
        overlap=0.0,
        posture=np.full(len(program.free), 0.25),
    )
    lighter = []

    def fail() -> None:
        with soft:
            lighter.append(program(x, np.empty(0)))
            raise KeyError

    with pytest.raises(KeyError):
        fail()
    assert lighter[0] < before
    assert program(x, np.empty(0)) == before
    given = slice(program.ints[block.NUMBERS], program.ints[block.POSITIONS])
    np.testing.assert_array_equal(program.ints[given], kept[given])
