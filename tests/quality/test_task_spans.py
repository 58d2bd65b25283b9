"""What a score asks of which limb and when, from blocks and bound tasks."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from movements import ARM_L, ARM_R, span

from azee.lang.program import evaluate_expression
from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.limbs import Limbs
from azee.motion.tasks.schedule import bind
from azee.motion.tasks.timed_task import EarlyEnd
from azee.quality.task_spans import asked, asked_to_move, task_spans
from azee_rig.rig import Rig
from azee_solver.binding import Binding
from azee_solver.geometry import Side

TIMES = np.array([0.0, 0.5, 1.0, 1.5, 2.0])


def test_a_limb_is_asked_by_what_names_it_and_by_what_can_move_it() -> None:
    hand = span(0.5, 1.5, limb="index_R", limbs=ARM_R)
    lean = span(1.5, 2.0, limb="trunk")
    assert asked([hand, lean], "arm_R", TIMES).tolist() == [False, True, True, True, False]
    assert asked([hand, lean], "index_R", TIMES).tolist() == [False, True, True, True, False]
    assert asked([hand, lean], "trunk", TIMES).tolist() == [False, False, False, True, True]
    assert not asked([hand, lean], "arm_L", TIMES).any()


def test_movement_is_asked_of_what_travels_and_of_what_keeps_touch_with_it() -> None:
    path = span(0.5, 1.5, limb="index_L", limbs=ARM_L, moving=True)
    touch = span(1.0, 2.0, limb="index_R", limbs=ARM_R, reads=frozenset({"index_L", "arm_L"}))
    free = span(0.0, 2.0, limb="index_R", limbs=ARM_R, reads=frozenset({"trunk"}))
    assert asked_to_move([path, touch], "arm_L", TIMES).tolist() == [False, True, True, True, False]
    assert asked_to_move([path, touch], "arm_R", TIMES).tolist() == [
        False, False, True, True, False,
    ]  # fmt: skip
    assert not asked_to_move([path, free], "arm_R", TIMES).any()


TEXT = """\
sync
    'FROM (key .3 (place @I_TIP(s) ^Rssp))
    'WAY (key .5 (transpath @I_TIP(s) straight))
    'start 'FROM:end
    'TO (key .3 (place @I_TIP(s) ^Mssp))
    'start 'WAY:end
    'SHAKE (key .5 (trill !palm(w) ^up))
    'start 'FROM:start
"""


def test_spans_say_what_a_score_asks(signer: Rig) -> None:
    limbs = Limbs.of(signer.coordinates)
    bound = bind(
        flatten(evaluate_expression(TEXT).score), signer, Binding(signer, Side.RIGHT), limbs
    )
    early = {t.rank: EarlyEnd(Fraction(1), ("NEXT",)) for t in bound.all if t.path == ("TO",)}
    found = {s.path: s for s in task_spans(bound.all, early)}
    assert [p for p, s in found.items() if s.moves] == [("WAY",), ("SHAKE",)]
    assert [found["TO",].start_s, found["TO",].end_s] == pytest.approx([0.8, 1.0])
    assert found["WAY",].concerns("arm_R")
    assert found["SHAKE",].concerns("arm_L")
    assert not found["FROM",].concerns("arm_L")
