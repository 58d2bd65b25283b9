"""The idle loop: a signer who stands, breathes and blinks, and does so again without a jump."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.clip.spline import minimum_jerk
from azee.compilation import perform
from azee.motion.keys.rest import DEFAULT, Rest
from azee.score.score import Blank
from azee_rig.rig import Rig

LOOP_S = 4.0
"""A breath. Who presses Play waits for the end of the loop, so it is short."""
JOIN_S = 1.0
"""How long the end of the loop is blended into what came before its start."""
SEED = 7


def idle_loop(rig: Rig, *, fps: int = 30, rest: Rest = DEFAULT) -> Clip:
    """Return `LOOP_S` of idling; its first and last frames are the same posture.

    Of a movement x over L + J seconds it is x(t) for t from J on. From L to L + J it is blended
    into x(t − L), so that it ends with x(J), where it began. The weights are those of minimum jerk:
    speed and acceleration do not jump either.
    """
    whole = perform(Blank(Fraction(LOOP_S + JOIN_S)), rig, fps=fps, rest=rest, seed=SEED).clip
    frames, join = round(LOOP_S * fps), round(JOIN_S * fps)
    share = minimum_jerk(np.arange(join + 1) / join)[:, None]

    def joined(values: NDArray[np.float64]) -> NDArray[np.float64]:
        loop = values[join : join + frames + 1].copy()
        loop[-join - 1 :] += share * (values[: join + 1] - loop[-join - 1 :])
        return loop

    return replace(
        whole,
        times=np.arange(frames + 1) / fps,
        coordinates=joined(whole.coordinates),
        unit_weights=joined(whole.unit_weights),
        labels=(),
    )
