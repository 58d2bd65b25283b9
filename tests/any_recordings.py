"""A recorded sign for every name but those of `MISSING`: a raised arm that moves a little."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from azee.clip.clip import Clip
from azee.score.recorded_motion import RecordingError
from azee.score.score import Recorded
from azee_rig.rig import Rig

MISSING = ("NONE",)
LASTS_S, ATTACK_S, DECAY_S = Fraction(3), Fraction(1), Fraction(1, 2)
RAISED = {"arm_R.flexion": 0.9, "f_arm_R.flexion": 1.5}
"""Where the right arm is in what the sign means, radians."""
FPS = 60


@dataclass(frozen=True)
class RaisedArm:
    """A movement: the right arm rises in its attack, moves to and fro, and falls."""

    name: str
    digest: str = "0"

    def clip(self, rig: Rig) -> Clip:
        """Return it on a body."""
        t = np.arange(int(LASTS_S * FPS) + 1) / FPS
        up = np.clip(np.minimum(t / float(ATTACK_S), (t[-1] - t) / float(DECAY_S)), 0.0, 1.0)
        up = up**2 * (3.0 - 2.0 * up)
        q = np.tile(rig.coordinates.idle, (len(t), 1))
        for name, angle in RAISED.items():
            v = rig.coordinates.index[name]
            q[:, v] += up * (angle - q[0, v] + 0.2 * np.sin(4.0 * t))
        q = np.clip(q, rig.coordinates.lower, rig.coordinates.upper)
        return Clip(t, q, (), np.zeros((len(t), 0)))


class AnyRecordings:
    """Finds them."""

    def find(self, name: str, language: str | None, variant: str | None) -> Recorded:
        """Return the sign. Raises: RecordingError: it is one of `MISSING`."""
        if name in MISSING:
            raise RecordingError("unknown-sign", f"there is no sign `{name}`", "look elsewhere")
        behind = ", ".join(filter(None, (language, variant)))
        motion = RaisedArm(f"{name} ({behind})" if behind else name)
        return Recorded(LASTS_S, motion=motion, attack_s=ATTACK_S, decay_s=DECAY_S)
