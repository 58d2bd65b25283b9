"""Proposals: what an author could write so that the body is as it was dragged, the best first."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from azee.blocks.change import TextChange
from azee.blocks.document import Document
from azee.posing.handle import (
    BoneHandle,
    GazeHandle,
    Handle,
    MorphHandle,
    SiteHandle,
    Target,
)
from azee.posing.handshapes import shape_names
from azee.posing.instant import Instant
from azee.posing.moving_rules import of_rules
from azee.posing.names import PointName, PointNamer, direction_names, in_azee, rounded
from azee.posing.replaced import is_same
from azee.posing.sites import SiteMap
from azee.posing.spots import (
    Spot,
    beside_others,
    in_force,
    instead_of_shape,
    new_block,
    replacing,
)
from azee.posing.text import PosedText
from azee_grammar.diagnostic import AZeeError
from azee_solver import kinematics
from azee_solver.binding import EYES, Binding
from azee_solver.constraint import Constraint, Morph, Place
from azee_solver.evaluate import angle
from azee_solver.geometry import Side, Vec
from azee_solver.notation import number_text, part_text, vector_text

Array = NDArray[np.float64]

EACH = 6
"""How many names of a point or direction are proposed for each spot."""


@dataclass(frozen=True, slots=True, eq=False)
class Naming:
    """What may be written at a spot. off: from what was dragged, metres or radians."""

    text: str
    off: float
    fixes: str
    cost: float


@dataclass(frozen=True, eq=False)
class Proposal:
    """A text that has the body as it was dragged.

    written: what is new in it, as AZee. kind, where: of the spot. fixes: what it fixes, in words.
    off: how far that is from what was dragged; unit: metres, radians, or none for weights. handle:
    what was dragged. cost: less is better.
    """

    handle: Handle
    written: str
    kind: str
    where: str
    fixes: str
    off: float
    unit: str | None
    cost: float
    before: Document
    spot: Spot
    binding: Binding

    @cached_property
    def document(self) -> Document:
        """The text with the proposal. Raises: AZeeError: it cannot be written there."""
        return self.spot.write(self.written)

    @property
    def change(self) -> TextChange:
        """The one change of the text, which can be taken back."""
        return TextChange.between(self.before.text, self.document.text)

    @property
    def off_text(self) -> str:
        """How far it is from what was dragged, in words; nothing where that is nothing."""
        if self.unit == "m" and self.off >= 5e-4:
            return f", {self.off * 1000:.0f} mm from where it was dragged"
        if self.unit == "rad" and self.off >= math.radians(0.05):
            return f", {math.degrees(self.off):.1f}° from where it was dragged"
        return ""

    def as_json(self) -> dict[str, object]:
        """Return it as plain data; the change in UTF-16 units, as CodeMirror takes it."""
        return {
            "handle": str(self.handle),
            "written": self.written,
            "kind": self.kind,
            "where": self.where,
            "fixes": self.fixes,
            "off": self.off,
            "unit": self.unit,
            "cost": self.cost,
            "change": self.change.as_json(self.before.text),
        }


class Proposing:
    """Makes the proposals for one posture."""

    def __init__(
        self,
        text: PosedText,
        instant: Instant,
        q: Array,
        sites: Mapping[Handle, SiteMap],
    ) -> None:
        """Know the posture q (V,), and the sites that may be named for each handle."""
        frames = kinematics.frames(instant.evaluator.rig.chain, q)
        self._q = q
        self._text, self._instant, self._frames = text, instant, frames
        self._sites = sites
        self._evaluator = instant.evaluator
        self._sound: dict[Spot, bool] = {}  # by spot: what is written there differs little

    def proposals(self, handle: Handle, target: Target) -> list[Proposal]:
        """Return all proposals for a handle that can be written, the best first.

        Args: target: where it was dragged to.
        """
        units = {SiteHandle: "m", MorphHandle: None}
        unit = units.get(type(handle), "rad")
        found = [
            Proposal(
                handle,
                naming.text,
                spot.kind,
                spot.where,
                naming.fixes,
                naming.off,
                unit,
                spot.cost + naming.cost,
                self._text.document,
                spot,
                self._evaluator.binding,
            )
            for spot, naming in self._written(handle, target)
        ]
        found.sort(key=lambda proposal: proposal.cost)
        return [proposal for proposal in found if self._can_be_written(proposal)]

    def _can_be_written(self, proposal: Proposal) -> bool:
        """Whether the text is another one with it, and can be read."""
        try:
            edited = proposal.document
        except AZeeError:
            return False
        spot = proposal.spot
        if spot not in self._sound:
            try:
                self._sound[spot] = bool(self._text.with_document(edited).score.duration >= 0)
            except AZeeError:
                self._sound[spot] = False
        return self._sound[spot] and edited.text != proposal.before.text

    def _written(self, handle: Handle, target: Target) -> Iterator[tuple[Spot, Naming]]:
        """Yield what may be written where."""
        spots = [*self._spots(handle)]
        for spot in spots:
            for naming in self._namings(spot, handle, target):
                yield spot, naming
        if isinstance(handle, MorphHandle) and handle.side is not None:
            shaped = [*instead_of_shape(self._text, self._instant, handle)]
            for spot in shaped or [spot for spot in spots if spot.kind != "replace"]:
                for naming in self._shapes(handle.side):
                    yield spot, naming

    def _shapes(self, side: Side) -> Iterator[Naming]:
        dominant = self._evaluator.binding.dominant
        strong = side.bound(dominant) is dominant
        word, hand = (Side.STRONG, "strong") if strong else (Side.WEAK, "weak")
        for name in shape_names(self._text.program, self._evaluator, self._q, word)[:EACH]:
            fixes = f"the shape of the {hand} hand"
            yield Naming(name.text, name.off_rad, fixes, 0.5 + name.cost)

    def _spots(self, handle: Handle) -> Iterator[Spot]:
        own, foreign = in_force(self._text, self._instant, handle)
        if isinstance(handle, MorphHandle):
            # Weights add up: beside another morph of the same part there is nothing to write.
            others = bool(own or foreign)
            own, foreign = [(t, p) for t, p in own if self._is_same(handle, t.constraint)], []
            if others and not own:
                return
        if own:
            yield replacing(self._text, handle, *own[0])
        elif foreign:
            yield from of_rules(self._text, self._instant, foreign[0], self._frames)
        else:
            yield from beside_others(self._text, self._instant, handle)
            yield new_block(self._text, self._instant, handle)

    def _is_same(self, handle: MorphHandle, constraint: Constraint) -> bool:
        binding = self._evaluator.binding
        return isinstance(constraint, Morph) and is_same(handle, constraint, binding)

    def _namings(self, spot: Spot, handle: Handle, target: Target) -> Iterator[Naming]:
        if spot.wants != "constraint":
            yield from self._for_a_rule(spot, handle)
            return
        match handle:
            case SiteHandle():
                yield from self._placed(handle)
            case BoneHandle():
                yield from self._oriented(handle)
            case GazeHandle():
                yield from self._looking(handle, np.array(target))
            case MorphHandle():
                yield self._weighed(spot, handle, target)

    def _placed(self, handle: SiteHandle) -> Iterator[Naming]:
        point = self._evaluator.site(handle.site, self._frames)
        subject = f"place {part_text(handle.site)}"
        for name in self._namer(handle).names(point)[:EACH]:
            fixes = f"{handle} {name.what}"
            yield Naming(f"{subject} {name.text}{name.options}", name.off_m, fixes, name.cost)

    def _for_a_rule(self, spot: Spot, handle: Handle) -> Iterator[Naming]:
        """Name what an argument must be, or by what a rule must be moved."""
        assert spot.task is not None
        assert spot.shift is not None
        place = spot.task.constraint
        assert isinstance(place, Place)
        wanted = self._evaluator.site(place.site, self._frames) + spot.shift
        if spot.wants == "point":
            for name in self._namer(handle).names(wanted, options=False)[:EACH]:
                yield Naming(name.text, name.off_m, f"{handle}, by a point {name.what}", name.cost)
            return
        metres = rounded(wanted / self._evaluator.scale)
        off_m = float(np.linalg.norm(self._evaluator.scale * np.array(metres) - wanted))
        yield Naming(in_azee(vector_text(Vec(*metres))), off_m, f"{handle}, with the rest", 2.3)

    def _namer(self, handle: Handle) -> PointNamer:
        sites = self._sites[handle]
        return PointNamer(self._evaluator, self._frames, sites, self._text.places)

    def _oriented(self, handle: BoneHandle) -> Iterator[Naming]:
        direction = self._evaluator.axis(handle.bone, handle.axis, self._frames)
        subject = f"orient '{handle.axis.value} {part_text(handle.bone)} 'along"
        names = direction_names(direction, handle.bone, self._evaluator, self._frames)
        for name in names[:EACH]:
            fixes = f"{handle} along {name.text}"
            yield Naming(f"{subject} {name.text}", name.off_rad, fixes, name.cost)

    def _looking(self, handle: GazeHandle, aim: Array) -> Iterator[Naming]:
        eyes = np.mean([self._evaluator.gaze(eye, self._frames)[0] for eye in EYES], axis=0)
        far_m = float(np.linalg.norm(aim - eyes))

        def off(name: PointName) -> float:
            return float(angle(name.point - eyes, aim - eyes))

        for name in self._namer(handle).names(aim, options=False)[:EACH]:
            fixes = f"the gaze {name.what}"
            yield Naming(f"lookat {name.text}", off(name), fixes, name.cost)
        if far_m > 0:
            for way in direction_names(aim - eyes, None, self._evaluator, self._frames)[:EACH]:
                fixes = f"the gaze along {way.text}"
                yield Naming(f"look {way.text}", way.off_rad, fixes, 0.5 + way.cost)

    def _weighed(self, spot: Spot, handle: MorphHandle, target: Target) -> Naming:
        weight = in_azee(number_text(round(target[0], 2) + 0.0))
        fixes = f"{handle} at {weight}"
        if spot.kind == "replace":
            return Naming(weight, abs(target[0] - float(weight)), fixes, 0.0)
        return Naming(f"morph {handle} {weight}", abs(target[0] - float(weight)), fixes, 0.0)
