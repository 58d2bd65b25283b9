"""Five postures in which a signer touches himself: they show whether a body fits a capture.

Gürel (2010, section 3.1.3 and figure 3.3) has actors bring parts of the body in contact, and looks
whether the virtual body has them in contact too: postures 1 to 3 test hands and arms, 4 and 5 the
face. The thesis shows them as pictures; which parts touch here is our choice.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee_rig.rig import Rig
from azee_solver import kinematics
from azee_solver.constraint import Place
from azee_solver.evaluate import Evaluator, evaluator
from azee_solver.geometry import Side, Site, SitePoint
from azee_solver.solve import solve
from azee_solver.task import Task

Array = NDArray[np.float64]

LEFT, RIGHT = Side.LEFT, Side.RIGHT
WITHIN_M = 0.02
"""Sites of a capture that come nearer count as touching: markers and skin are not the same."""


@dataclass(frozen=True, slots=True)
class ContactPosture:
    """A posture of the check: which sites touch which."""

    number: int
    meaning: str
    touches: tuple[tuple[Site, Site], ...]

    def distances(self, body: Evaluator, q: Array) -> Array:
        """Return how far the farthest of its touches is off in postures (T, V), (T,) metres."""
        frames = kinematics.frames(body.rig.chain, q)
        apart = [
            np.linalg.norm(body.site(a, frames) - body.site(b, frames), axis=-1)
            for a, b in self.touches
        ]
        return np.asarray(np.max(apart, axis=0))


POSTURES: tuple[ContactPosture, ...] = (
    ContactPosture(1, "palms together", ((Site("PA", RIGHT), Site("PA", LEFT)),)),
    ContactPosture(
        2, "tips of the index fingers together", ((Site("I_TIP", RIGHT), Site("I_TIP", LEFT)),)
    ),
    ContactPosture(3, "palm on the other elbow", ((Site("PA", RIGHT), Site("EL", LEFT)),)),
    ContactPosture(4, "index finger at the nose", ((Site("I_TIP", RIGHT), Site("NO")),)),
    ContactPosture(
        5,
        "index fingers at the cheeks",
        ((Site("I_TIP", RIGHT), Site("CK", RIGHT)), (Site("I_TIP", LEFT), Site("CK", LEFT))),
    ),
)


@dataclass(frozen=True, slots=True)
class Measured:
    """How near a body or a capture comes to a posture; time_s: of the nearest frame of a capture.

    distance_m: of its farthest touch.
    """

    posture: ContactPosture
    distance_m: float
    time_s: float | None = None

    def as_json(self) -> dict[str, object]:
        """Return it as plain data."""
        return {
            "number": self.posture.number,
            "posture": self.posture.meaning,
            "distance_m": self.distance_m,
            "time_s": self.time_s,
        }


def of_body(rig: Rig) -> tuple[Measured, ...]:
    """Solve the postures on a body. Raises: BindingError: it lacks a site."""
    body = evaluator(rig, Side.RIGHT)
    idle = rig.coordinates.idle
    out = []
    for posture in POSTURES:
        tasks = [
            Task(Place(a, SitePoint(b), contact=True), ("calibration",), Fraction(0), rank, 0.0)
            for rank, (a, b) in enumerate(posture.touches)
        ]
        found = solve(rig, tasks, dominant=Side.RIGHT, start=idle, reference=idle)
        distance = posture.distances(body, np.array(found.coordinates)[None])[0]
        out.append(Measured(posture, float(distance)))
    return tuple(out)


def of_capture(clip: Clip, rig: Rig) -> tuple[Measured, ...]:
    """Find the frame of a clip that is nearest to each posture. Raises: BindingError."""
    body = evaluator(rig, Side.RIGHT)
    out = []
    for posture in POSTURES:
        distances = posture.distances(body, clip.coordinates)
        nearest = int(distances.argmin())
        out.append(Measured(posture, float(distances[nearest]), float(clip.times[nearest])))
    return tuple(out)


def apart(found: Sequence[Measured], within_m: float) -> tuple[Measured, ...]:
    """Return the postures whose touches are farther apart than that."""
    return tuple(m for m in found if m.distance_m > within_m)
