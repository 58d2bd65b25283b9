"""An interactive session on a compiled score at one instant: drag, propose, write.

session = PosingSession.open("hello.azee", at_s=0.6)
session.drag("@I_TIP(s)", (0.1, 1.2, 0.3))   # a frame, thirty times a second or more
for proposal in session.proposals():
    print(proposal.written, proposal.fixes)
text = session.proposals()[0].document.text
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee.blocks.document import Document
from azee.compilation import Compilation, Hand, perform, source_of
from azee.motion.tasks.flatten import flatten
from azee.posing.drag import Dragged, DragSolver
from azee.posing.fault import cannot_pose
from azee.posing.grips import Grip, grips
from azee.posing.handle import (
    Handle,
    MorphHandle,
    SiteHandle,
    Target,
    checked_target,
    read_handle,
)
from azee.posing.instant import Instant
from azee.posing.proposal import Proposal, Proposing
from azee.posing.replaced import is_replaced
from azee.posing.text import PosedText
from azee.score.interval import Interval
from azee.score.score import Score
from azee_grammar.diagnostic import AZeeError
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver import kinematics
from azee_solver.body_words import capsule_words
from azee_solver.collisions import Overlap
from azee_solver.constraint import Morph
from azee_solver.geometry import Side

Array = NDArray[np.float64]

FRAME_S = 1 / 30
"""Between two frames of a clip."""
STEP_M = 0.01
"""How far a hand goes between two frames at a third of a metre a second."""
MET_M, MET_RAD = 1e-3, math.radians(0.5)
"""What counts as there."""


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """What a screen shows after a drag.

    q: (V,) radians. unit_weights: of the face. handle: what was dragged. place: (3,) where its site
    or None. miss: how far it is from its target, metres or radians. blocked: what is in the way, in
    words. reason: why it misses, where that was asked for. solve_s: processor time.
    """

    rig: Rig
    q: Array
    unit_weights: dict[str, float]
    handle: Handle
    place: tuple[float, float, float] | None
    miss: float
    blocked: tuple[str, ...]
    reason: str | None
    solve_s: float

    @property
    def summary(self) -> str:
        """How far it is from its target and why, in words; empty if it is there."""
        parts = []
        if self.place is not None and self.miss > MET_M:
            parts.append(f"{self.miss * 1000:.0f} mm from its target")
        elif self.place is None and self.miss > MET_RAD:
            parts.append(f"{math.degrees(self.miss):.1f}° from its target")
        parts += [self.reason] if self.reason else []
        parts += self.blocked
        return "; ".join(parts)

    def as_json(self) -> dict[str, object]:
        """Return it as plain data; rotations xyzw of all joints, in the order of the skeleton."""
        return {
            "handle": str(self.handle),
            **_posture(self.rig, self.q, self.unit_weights),
            "place": None if self.place is None else [*self.place],
            "miss": self.miss,
            "blocked": [*self.blocked],
            "reason": self.reason,
            "solve_ms": self.solve_s * 1e3,
        }


class PosingSession:
    """Holds what was dragged so far, and the posture that came of it."""

    def __init__(self, text: PosedText, made: Compilation, at_s: float) -> None:
        """Begin at an instant of a compiled text, seconds on the score's time line.

        Raises: AZeeError: cannot-pose: there is no such instant.
        """
        self.text, self.made, self.at_s = text, made, at_s
        self.instant = Instant.of(made, at_s, _side(text.dominant))
        self._solver = DragSolver(self.instant)
        self._goals: dict[Handle, Target] = {}
        self._q: Array = np.array(self.instant.q)
        self._dropped = False

    @classmethod
    def open(
        cls,
        text_or_path: str | Path,
        at_s: float,
        rig: str | Path | Rig = "signer",
        *,
        utterance: int | None = None,
        libraries: Sequence[str | Path] = (),
        dominant: Hand = "right",
    ) -> PosingSession:
        """Compile a text and begin; the arguments are those of `azee.compile`.

        Raises: AZeeError: the text has mistakes; cannot-pose: there is no such instant.
        """
        document = Document(source_of(text_or_path))
        text = PosedText(document, tuple(map(Path, libraries)), utterance, dominant)
        body = rig if isinstance(rig, Rig) else load_rig(rig)
        return cls(text, perform(text.score, body, dominant=dominant), at_s)

    # Dragging ---------------------------------------------------------------------------------

    def drag(self, handle: Handle | str, target: Sequence[float]) -> Frame:
        """Drag a handle to a target, and return what the screen shows then.

        Args: target: of a site or of the gaze a point, (3,) metres in the world; of a bone a
            direction, (3,); of a morph a weight, (1,).
        Raises: AZeeError: cannot-pose: it is no such target.
        """
        known = self.handle(handle)
        self._goals[known] = checked_target(
            str(known), target, weight=isinstance(known, MorphHandle)
        )
        return self._frame(known, self._moved(self._solver.solve(self._goals, self._q)))

    def beside(self, handle: Handle | str, offset: Sequence[float]) -> tuple[float, ...]:
        """Return the point beside where a site is now, by an offset, (3,) metres.

        Raises: AZeeError: cannot-pose: the handle is no site.
        """
        known = self.handle(handle)
        if not isinstance(known, SiteHandle):
            reason = f"`{known}` is no site, and only sites are moved by metres"
            raise AZeeError(cannot_pose(reason))
        offset = checked_target(str(known), offset, weight=False)
        return tuple((self._place(known) + np.array(offset)).tolist())

    def drag_along(self, handle: Handle | str, target: Sequence[float]) -> Frame:
        """Drag a handle to a target in steps of at most a centimetre, as a hand would go there."""
        known = self.handle(handle)
        if isinstance(known, SiteHandle):
            there = np.array(checked_target(str(known), target, weight=False))
            start = self._place(known)
            steps = math.ceil(float(np.linalg.norm(there - start)) / STEP_M)
            for k in range(1, steps):
                self.drag(known, (start + (there - start) * k / steps).tolist())
        return self.drag(known, target)

    def _place(self, handle: SiteHandle) -> Array:
        """Where a site is now, (3,) metres in the world."""
        frames = kinematics.frames(self._rig.chain, self._q)
        return self.instant.evaluator.site(handle.site, frames)

    def drop(self) -> list[Frame]:
        """Let go: find the posture that compiling would find, and why handles miss their targets.

        Returns: what the screen shows then, for each handle that was dragged.
        """
        done = self._moved(self._solver.agreed(self._goals, self._q))
        self._dropped = True
        return [self._frame(handle, done) for handle in self._goals]

    def release(self, handle: Handle | str) -> None:
        """Forget what was dragged with a handle; the posture is found anew."""
        self._goals.pop(self.handle(handle), None)
        self._q = np.array(self.instant.q)
        if self._goals:
            self._moved(self._solver.solve(self._goals, self._q))

    def handle(self, handle: Handle | str) -> Handle:
        """Return a handle that was given by its text. Raises: AZeeError: there is none."""
        return read_handle(handle, self.text.program) if isinstance(handle, str) else handle

    @property
    def goals(self) -> dict[Handle, Target]:
        """What was dragged where."""
        return dict(self._goals)

    @property
    def q(self) -> Array:
        """The posture now, (V,) radians."""
        return np.array(self._q)

    @property
    def grips(self) -> list[Grip]:
        """What can be dragged of the body as it is now."""
        return grips(self.instant.evaluator, kinematics.frames(self._rig.chain, self._q))

    def still(self) -> dict[str, object]:
        """Return the posture now as plain data: `rotations` and `weights`, as a frame has them."""
        return _posture(self._rig, self._q, self._unit_weights(self._q))

    def _moved(self, done: Dragged) -> Dragged:
        self._q, self._dropped = done.q, False
        return done

    def _frame(self, handle: Handle, done: Dragged) -> Frame:
        place = None
        if isinstance(handle, SiteHandle):
            x, y, z = self._place(handle).tolist()
            place = (x, y, z)
        return Frame(
            self._rig,
            done.q,
            self._unit_weights(done.q),
            handle,
            place,
            done.residuals[handle],
            tuple(map(_in_words, done.overlaps)),
            done.reasons.get(handle),
            done.solve_s,
        )

    @property
    def _rig(self) -> Rig:
        return self.instant.evaluator.rig

    def _unit_weights(self, q: Array) -> dict[str, float]:
        """Return the weights of the face: as they were, but for what was dragged and the lids."""
        rig, weights = self._rig, dict(self.instant.unit_weights)

        def add(units: dict[str, float], factor: float) -> None:
            for unit, weight in units.items():
                weights[unit] = weights.get(unit, 0.0) + factor * weight

        dominant = self.instant.evaluator.binding.dominant
        for handle, target in self._goals.items():
            if not isinstance(handle, MorphHandle):
                continue
            key = Morph(handle.name, handle.side, 0.0).key(dominant)
            before = sum(
                t.constraint.weight
                for t in self.instant.face
                if isinstance(t.constraint, Morph) and t.constraint.key(dominant) == key
            )
            add(dict(rig.face_morphs.get(key, {})), target[0] - before)
        for now, factor in ((q, 1.0), (self.instant.q, -1.0)):
            add({unit: float(w) for unit, w in rig.lid_weights(now).items()}, factor)
        return weights

    # Writing ----------------------------------------------------------------------------------

    def proposals(self, handle: Handle | str | None = None) -> list[Proposal]:
        """Let go, and return what could be written for a handle, or for all; the best first.

        Raises: AZeeError: cannot-pose: nothing was dragged.
        """
        goals = self._goals
        if handle is not None:
            known = self.handle(handle)
            goals = {h: t for h, t in goals.items() if h == known}
        if not goals:
            raise AZeeError(cannot_pose("nothing was dragged"))
        if not self._dropped:
            self.drop()
        sites = {h: self._solver.sites(frozenset({h})) for h in goals}
        proposing = Proposing(self.text, self.instant, self.q, sites)
        found = [p for h, target in goals.items() for p in proposing.proposals(h, target)]
        return sorted(found, key=lambda proposal: proposal.cost)

    def opened_with(self, proposal: Proposal) -> PosingSession:
        """Return a session on the text with a proposal, compiled anew.

        It is at the same instant, or where what was written is in force if it is not then: a hand
        that has farther to go gets more time, and all that follows moves.
        """
        text = self.text.with_document(proposal.document)
        made = perform(text.score, self.made.rig, dominant=text.dominant)
        when = _written_at(made.score, proposal)
        at_s = self.at_s if when is None else _well_inside(when, self.at_s)
        return PosingSession(text, made, at_s)


def _well_inside(interval: Interval, at_s: float) -> float:
    """Return the time nearest to one at which a frame of a clip is in an interval, if any is."""
    start, end = float(interval.start), float(interval.end)
    margin = min(FRAME_S, (end - start) / 2)
    return min(max(at_s, start + margin), end - margin)


def _written_at(score: Score, proposal: Proposal) -> Interval | None:
    """Return when the constraint is in force that a proposal writes or has its target changed."""
    change, source = proposal.change, proposal.document.source
    first, last = (
        source.position(offset)[0] for offset in (change.start, change.start + len(change.insert))
    )
    task = proposal.spot.task
    for found in flatten(score).requirements:
        origin = found.constraint.origin
        if not is_replaced(found.constraint, proposal.handle, proposal.binding):
            continue
        if task is not None:
            if found.path == task.path:
                return found.interval
        elif origin and origin.file == source.name and first <= origin.line <= last:
            return found.interval
    return None


def _posture(rig: Rig, q: Array, unit_weights: dict[str, float]) -> dict[str, object]:
    wxyz = rig.pose(q).rotations
    return {
        "rotations": np.roll(wxyz, -1, axis=-1).round(6).tolist(),
        "weights": {name: round(w, 4) for name, w in unit_weights.items() if w},
    }


def _in_words(overlap: Overlap) -> str:
    first, second = capsule_words(overlap.first), capsule_words(overlap.second)
    return f"{first} is {overlap.depth_m * 1000:.0f} mm in {second}"


def _side(hand: Hand) -> Side:
    return Side.RIGHT if hand == "right" else Side.LEFT
