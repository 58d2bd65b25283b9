"""Spots for a place that a library's rule decides: its arguments, moving it, a rule of one's own.

Which argument moves a site, and from where, is found by trying: the text is evaluated with two
points in its place. If the site's target moves by the difference of the two, the point that it
needs follows.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from azee.blocks.document import Document
from azee.blocks.edits import Edit, Insert, Replace, Wrap
from azee.blocks.tree import Path, node_at, operand_rows
from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.timed_task import TimedTask
from azee.posing.instant import Instant
from azee.posing.own_rule import with_own_rules
from azee.posing.spots import Spot
from azee.posing.text import PosedText
from azee.score.score import Call, Group
from azee_grammar.diagnostic import AZeeError
from azee_grammar.syntax import Application, Named, OperatorName, RuleName, Symbol
from azee_rig.chain import Frames
from azee_solver.constraint import Place
from azee_solver.geometry import FreePoint, SitePoint
from azee_solver.notation import subject_text

Array = NDArray[np.float64]
Edits: TypeAlias = Callable[[str], Edit]
Write: TypeAlias = Callable[[str], Document]

ORIGIN, PROBE = "point(0, 0, 0)", "point(.1, .2, .3)"
PROBE_VECTOR = "vec(.1, .2, .3)"
MOVED = np.array([0.1, 0.2, 0.3])
EXACT_M = 1e-6


def of_rules(text: PosedText, instant: Instant, task: TimedTask, frames: Frames) -> Iterator[Spot]:
    """Yield the spots for a constraint that a rule of a library has, in frames of a posture."""
    chain = _calls(instant, task)
    own = [n for n, call in enumerate(chain) if _path(text, call) is not None]
    if not own:
        return
    if isinstance(task.constraint, Place):
        mover = _RuleMover(text, instant, task, task.constraint, frames)
        for n in reversed(own):
            path = _path(text, chain[n])
            assert path is not None
            yield from mover.arguments(path)
        path = _path(text, chain[own[-1]])
        assert path is not None
        yield from mover.relocated(path)
    yield from _own_rule(text, task, [call.rule for call in chain[own[-1] :]])


def _path(text: PosedText, call: Call) -> Path | None:
    return None if call.handed_over else text.path_of(call.origin)


def _calls(instant: Instant, task: TimedTask) -> list[Call]:
    """Return the applications of rules that lead to a constraint, outermost first."""
    score = instant.score
    out = [*score.calls]
    for name in task.path:
        assert isinstance(score, Group)
        score = score.block(name).score
        out += score.calls
    return out


def _own_rule(text: PosedText, task: TimedTask, names: list[str]) -> Iterator[Spot]:
    origin = task.constraint.origin
    if origin is None or origin.rule is None:
        return
    program, document = text.program, text.document
    chain = [*names, origin.rule]
    where = f"in a rule `{names[0]}` of this text, a copy of the library's"

    def write(constraint: str) -> Document:
        assert origin is not None
        written = with_own_rules(document, program, chain, origin, constraint)
        assert written is not None, "it was tried"
        return written

    if with_own_rules(document, program, chain, origin, "place @I_TIP(s) ^Mssp") is not None:
        yield Spot("own-rule", where, write, task=task, cost=3.0)


class _RuleMover:
    """Finds what moves the target of a placement, by trying."""

    def __init__(
        self, text: PosedText, instant: Instant, task: TimedTask, place: Place, frames: Frames
    ) -> None:
        self._text, self._instant, self._task, self._place = text, instant, task, place
        self._frames = frames
        self._evaluator = instant.evaluator

    def arguments(self, path: Path) -> Iterator[Spot]:
        """Yield a spot for each argument of an application that moves the target."""
        node = node_at(self._text.document.nodes, path)
        assert isinstance(node, Application)
        if not isinstance(node.head, RuleName | OperatorName):
            return
        rule = self._text.program.scope.find(node.head.name)
        for name, _ in rule.parameters if rule is not None else ():
            edit = _argument(node, path, name)
            offset = self._offset(edit)
            if offset is None:
                continue
            line = self._text.document.source.position(node.span.start)[0]
            where = f"as `'{name}` of `{node.head.name}` in line {line}"
            yield Spot("argument", where, self._writing(edit), "point", self._task, -offset, 0.1)

    def relocated(self, path: Path) -> Iterator[Spot]:
        """Yield the spot that moves all that an application does, if that moves the target."""
        before = self._evaluator.target(self._place, self._frames)

        def edit(vector: str) -> Edit:
            return Wrap(path, f"relocate\n    ?it\n    {vector}")

        moved = self._target(edit(PROBE_VECTOR))
        if moved is None or not self._is_the_probe(moved - before):
            return
        line = self._text.document.source.position(
            node_at(self._text.document.nodes, path).span.start
        )[0]
        where = f"by moving what line {line} does ({subject_text(self._place)} and the rest)"
        yield Spot("relocate", where, self._writing(edit), "vector", self._task, -before, 0.8)

    def _writing(self, edit: Edits) -> Write:
        return lambda written: self._text.document.apply(edit(written)).document

    def _offset(self, edit: Edits) -> Array | None:
        """Return how far the target is from an argument, (3,), if it goes along with it."""
        first, second = (self._target(edit(point)) for point in (ORIGIN, PROBE))
        if first is None or second is None or not self._is_the_probe(second - first):
            return None
        return first - self._evaluator.point(FreePoint(0, 0, 0), self._frames)

    def _is_the_probe(self, moved: Array) -> bool:
        return bool(np.abs(moved - self._evaluator.scale * MOVED).max() < EXACT_M)

    def _target(self, edit: Edit) -> Array | None:
        """Return where an edited text has the site, (3,) metres in the world."""
        text = self._text
        try:
            edited = text.with_document(text.document.apply(edit).document)
            timeline = flatten(edited.score)
        except AZeeError:
            return None
        for found in timeline.requirements:
            other = found.constraint
            if (
                found.path == self._task.path
                and isinstance(other, Place)
                and (other.site, other.origin) == (self._place.site, self._place.origin)
                and (isinstance(other.point, SitePoint) or not other.distance_m)
            ):
                return self._evaluator.target(other, self._frames)
        return None


def _argument(node: Application, path: Path, name: str) -> Edits:
    """Return the edit that gives an argument of an application, in its place or as the last."""
    for i, operand in enumerate(node.operands):
        if isinstance(operand, Named) and operand.name.name == name:
            return lambda point: Replace((*path, i), point)
        if not node.called and isinstance(operand, Symbol) and operand.name == name and i % 2 == 0:
            return lambda point: Replace((*path, i + 1), point)
    return lambda point: Insert(path, len(operand_rows(node)), f"'{name} {point}")
