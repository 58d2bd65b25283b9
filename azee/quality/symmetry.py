"""Whether arms are mirror images of each other where the score asks for that."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.quality.kinematics import SIDES, Extreme, Kinematics
from azee.quality.task_spans import TaskSpan
from azee_rig.mirror import mirrored
from azee_solver.constraint import Orient, Place
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Side

Array = NDArray[np.float64]

ALIKE = {"m": 0.01, "rad": np.radians(5.0)}
"""By how much worse a posture's mirror image may meet what is asked of a symmetric sign: the
tolerance of Nunnari, Filhol & Heloir 2018."""


def elbow_asymmetry_cm(
    k: Kinematics, spans: Sequence[TaskSpan], dominant: Side = Side.RIGHT
) -> Extreme | None:
    """Return how far an elbow is from the mirror image of the other in symmetric signs, cm.

    A moment is symmetric if places or orientations are asked of both arms and the mirror image of
    the posture meets them as well as the posture itself. It is looked for in the middle of every
    time in which the same tasks are held and none of them is a movement. The mirror is the plane
    between left and right of the neutral posture. None if no moment is symmetric.
    """
    evaluator = Evaluator(k.rig, dominant)
    held = [s for s in spans if isinstance(s.constraint, Place | Orient) and _arm(s)]
    edges = sorted({t for s in spans if _arm(s) for t in (s.start_s, s.end_s)})
    best: Extreme | None = None
    for start, end in pairwise(edges):
        middle = (start + end) / 2.0
        now = [s for s in held if s.start_s <= middle <= s.end_s]
        moving = any(s.moves and _arm(s) and s.start_s <= middle <= s.end_s for s in spans)
        if moving or {side for s in now for side in _arm(s)} != {"L", "R"}:
            continue
        n = int(np.abs(k.times_s - middle).argmin())
        if not _symmetric(evaluator, now, k.q[n]):
            continue
        left, right = (k.joint(f"f_arm_{side}")[n] for side in SIDES)
        apart = 100.0 * k.scale * float(np.linalg.norm(left * [-1.0, 1.0, 1.0] - right))
        if best is None or apart > best.value:
            best = Extreme(apart, "f_arm", float(k.times_s[n]))
    return best


def _arm(span: TaskSpan) -> str:
    """Sides of the arms that a task asks something of."""
    return "".join(side for side in SIDES if span.concerns(f"arm_{side}"))


def _symmetric(evaluator: Evaluator, spans: Sequence[TaskSpan], q: Array) -> bool:
    both = np.stack([q, mirrored(evaluator.rig.coordinates, q)])
    frames = evaluator.rig.chain.frames(both)
    for span in spans:
        assert span.constraint is not None
        residual, unit = evaluator.residual(span.constraint, frames, both)
        if not residual[1] <= residual[0] + ALIKE[unit]:
            return False
    return True
