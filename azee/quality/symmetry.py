"""Whether arms are mirror images of each other where the score asks for that."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.motion.tasks.limbs import TRUNK
from azee.quality.kinematics import CHEST, SIDES, Extreme, Kinematics
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

    A moment is symmetric if places or orientations are asked of both arms, the mirror image of the
    posture meets them as well as the posture itself, and nothing turns the trunk to a side. It is
    looked for in the middle of every time in which the same tasks are held and none of them is a
    movement. The mirror is the plane between left and right of the chest. None if no moment is
    symmetric.
    """
    evaluator = Evaluator(k.rig, dominant)
    chest = k.rotation(CHEST)
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
        turned = any(s.limb == TRUNK and s.start_s <= middle <= s.end_s for s in spans)
        if (turned and _to_a_side(chest[n])) or not _symmetric(evaluator, now, k.q[n]):
            continue
        left, right = ((k.joint(f"f_arm_{s}")[n] - k.joint(CHEST)[n]) @ chest[n] for s in SIDES)
        apart = 100.0 * k.scale * float(np.linalg.norm(left * [-1.0, 1.0, 1.0] - right))
        if best is None or apart > best.value:
            best = Extreme(apart, "f_arm", float(k.times_s[n]))
    return best


def _arm(span: TaskSpan) -> str:
    """Sides of the arms that a task asks something of."""
    return "".join(side for side in SIDES if span.concerns(f"arm_{side}"))


def _to_a_side(turned: Array) -> bool:
    """Whether a turn (3, 3) is farther from its mirror image than `ALIKE`.

    The mirror image of R is M R M with M = diag(−1, 1, 1); the angle between two rotations is
    arccos((tr(AᵀB) − 1) / 2).
    """
    mirror = np.diag([-1.0, 1.0, 1.0])
    cosine = (np.trace(turned.T @ mirror @ turned @ mirror) - 1.0) / 2.0
    return bool(np.arccos(np.clip(cosine, -1.0, 1.0)) > ALIKE["rad"])


def _symmetric(evaluator: Evaluator, spans: Sequence[TaskSpan], q: Array) -> bool:
    both = np.stack([q, mirrored(evaluator.rig.coordinates, q)])
    frames = evaluator.rig.chain.frames(both)
    for span in spans:
        assert span.constraint is not None
        residual, unit = evaluator.residual(span.constraint, frames, both)
        if not residual[1] <= residual[0] + ALIKE[unit]:
            return False
    return True
