"""Where in a text a posture can be written, as edits of its blocks.

In this order of preference: in the place of what the text says of the same part of the body; among
the constraints of a block that is in force; as an argument of a rule that the text applies; by
moving what a rule does to another place; in a copy of a library's rule; as a new block.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from azee.blocks.document import Document
from azee.blocks.edits import Edit, Insert, Replace, Wrap
from azee.blocks.tree import Path, node_at
from azee.lang.values import ConstraintsValue
from azee.motion.tasks.timed_task import TimedTask
from azee.posing.handle import Handle, MorphHandle
from azee.posing.instant import Instant, scores_at
from azee.posing.names import in_azee
from azee.posing.replaced import is_replaced
from azee.posing.text import PosedText
from azee.score.moment import decimal
from azee.score.score import Group, Score
from azee_grammar.diagnostic import AZeeError
from azee_grammar.format import one_line
from azee_grammar.syntax import (
    Application,
    Definition,
    OperatorName,
    RuleForm,
    RuleName,
    SideWord,
    Symbol,
)
from azee_solver.constraint import Morph
from azee_solver.notation import subject_text

Array = NDArray[np.float64]
Wants: TypeAlias = Literal["constraint", "point", "vector"]

NEW_BLOCK_S = Fraction(1, 5)
"""How long a new block is; keys in published signs last .17 to .25 s."""
_HUNDREDTHS = 100


@dataclass(frozen=True, slots=True, eq=False)
class Spot:
    """A place in a text where a posture can be written.

    kind: `replace`, `beside`, `argument`, `relocate`, `own-rule` or `block`. where: in plain words.
    wants: what is to be written there. write: makes the text with it. task: the constraint that is
    replaced, if one is. shift: (3,) metres in the world, from where that constraint has its site to
    the point to be written. cost: less is better.
    """

    kind: str
    where: str
    write: Callable[[str], Document]
    wants: Wants = "constraint"
    task: TimedTask | None = None
    shift: Array | None = None
    cost: float = 0.0


def in_force(
    text: PosedText, instant: Instant, handle: Handle
) -> tuple[list[tuple[TimedTask, Path]], list[TimedTask]]:
    """Return what a handle replaces: what the text says itself, with its path, and the rest.

    What starts last comes first.
    """
    binding = instant.evaluator.binding
    found = [t for c, t in instant.constraints if is_replaced(c, handle, binding)]
    found.sort(key=lambda task: task.interval.start, reverse=True)
    own = [(t, path) for t in found if (path := text.path_of(t.constraint.origin)) is not None]
    return own, [t for t in found if text.path_of(t.constraint.origin) is None]


def replacing(text: PosedText, handle: Handle, task: TimedTask, path: Path) -> Spot:
    """Return the spot of a constraint that the text has itself."""
    document = text.document
    if isinstance(handle, MorphHandle):
        path = _weight(document, path, handle)
    line = document.source.position(node_at(document.nodes, path).span.start)[0]
    inside = _definition(document, path)
    where = f"instead of `{subject_text(task.constraint)} …` in line {line}"
    write = _editing(document, partial(Replace, path))
    return Spot("replace", where + inside, write, task=task)


def _weight(document: Document, path: Path, handle: MorphHandle) -> Path:
    """Return the path of the weight of a morph, in a `morph` that may have several."""
    node = node_at(document.nodes, path)
    assert isinstance(node, Application)
    names = (handle.name, f"{handle.name}_L", f"{handle.name}_R")
    for i, operand in enumerate(node.operands):
        if isinstance(operand, Symbol) and operand.name in names:
            return (*path, i + 1 + isinstance(node.operands[i + 1], SideWord))
    return path


def beside_others(text: PosedText, instant: Instant, handle: Handle) -> Iterator[Spot]:
    """Yield the spot among constraints that the text has itself and that are in force."""
    own = [
        (task, path)
        for constraint, task in instant.constraints
        if (path := text.path_of(constraint.origin)) is not None
    ]
    if not own:
        return
    document = text.document
    task, path = max(own, key=lambda found: found[0].interval.start)
    around = node_at(document.nodes, path[:-1]) if len(path) > 1 else None
    line = document.source.position(node_at(document.nodes, path).span.start)[0]
    where = f"beside `{subject_text(task.constraint)} …` in line {line}"
    where += _definition(document, path)

    def edit(constraint: str) -> Edit:
        if _is(around, "cstr"):
            return Insert(path[:-1], path[-1] + 1, constraint)
        return Wrap(path, f"cstr\n    ?it\n    {constraint}")

    if isinstance(around, Application):
        yield Spot("beside", where, _editing(document, edit), cost=0.2)


def instead_of_shape(text: PosedText, instant: Instant, handle: MorphHandle) -> Iterator[Spot]:
    """Yield the spots of posture rules in the text that shape the same hand then."""
    document = text.document
    now = {c for c, _ in instant.constraints if isinstance(c, Morph)}
    own = {c for c in now if is_replaced(c, handle, instant.evaluator.binding)}
    for path, node in text.nodes:
        if not isinstance(node, Application) or not _is_posture(node):
            continue
        try:
            value = text.program.value(one_line(node), "the text")
        except AZeeError:  # it reads a parameter
            continue
        found = value.content if isinstance(value, ConstraintsValue) else ()
        shapes = {c for c in found if isinstance(c, Morph)}
        if shapes & own and shapes <= now:
            line = document.source.position(node.span.start)[0]
            where = f"instead of `{one_line(node)}` in line {line}{_definition(document, path)}"
            yield Spot("replace", where, _editing(document, partial(Replace, path)))


def _is_posture(node: Application) -> bool:
    return isinstance(node.head, RuleName) and node.head.form is RuleForm.POSTURE


def new_block(text: PosedText, instant: Instant, handle: Handle) -> Spot:
    """Return the spot of a new block beside the innermost rule that the text applies then.

    It is so short that the hand has time to come from what is asked of it before, and to go on.
    """
    document = text.document
    path, names, score, start = _application_at(text, instant)
    passed_s = instant.time - start
    share = min(max(passed_s / score.duration, Fraction(0)), Fraction(1)) if score.duration else 0
    own = _inside(text.score, names)
    half_s = min(NEW_BLOCK_S / 2, _alone_s(instant, handle) / 2)
    begin_s = _hundredths(max(own.duration * share - half_s, Fraction(0)))
    ref = f"'SIG:start{f':{in_azee(decimal(begin_s))}' if begin_s else ''}"
    duration = in_azee(decimal(_hundredths(2 * half_s)))
    line = document.source.position(node_at(document.nodes, path).span.start)[0]

    def edit(constraint: str) -> Edit:
        block = f"    'SIG ?it\n    'POSE (key {duration} ({constraint}))\n    'start {ref}\n"
        return Wrap(path, f"sync\n{block}")

    where = f"as a block beside line {line}{_definition(document, path)}"
    return Spot("block", where, _editing(document, edit), cost=0.5)


def _hundredths(seconds: Fraction) -> Fraction:
    return Fraction(round(seconds * _HUNDREDTHS), _HUNDREDTHS)


def _alone_s(instant: Instant, handle: Handle) -> Fraction:
    """Return how far the nearest block is in time that asks something else of a handle."""
    binding, time = instant.evaluator.binding, instant.time
    others = [t.interval for t in instant.around if is_replaced(t.constraint, handle, binding)]
    apart = [max(i.start - time, time - i.end, Fraction(0)) for i in others]
    return min(apart, default=NEW_BLOCK_S)


def _application_at(
    text: PosedText, instant: Instant
) -> tuple[Path, tuple[str, ...], Score, Fraction]:
    """Return the innermost application in force then that an utterance of the text has itself.

    With it, the names of the blocks that lead to its score, the score as performed, and when that
    starts. By default it is the utterance.
    """
    document = text.document
    found = None
    numbers = list(text.utterance_paths)
    for names, score, start in scores_at(instant.score, instant.time):
        depth = 0 if text.utterance is not None or len(numbers) == 1 else 1
        if len(names) == depth and found is None:
            number = (text.utterance or (int(names[0]) if names else 1)) - 1
            found = numbers[number], names, score, start
        for call in score.calls:
            path = None if call.handed_over else text.path_of(call.origin)
            if path is not None and not isinstance(document.nodes[path[0]], Definition):
                found = path, names, score, start
    if found is None:  # between utterances: the first
        return numbers[0], ("1",), _inside(instant.score, ("1",)), Fraction(0)
    return found


def _inside(score: Score, names: tuple[str, ...]) -> Score:
    for name in names:
        assert isinstance(score, Group)
        score = score.block(name).score
    return score


def _editing(document: Document, edit: Callable[[str], Edit]) -> Callable[[str], Document]:
    return lambda written: document.apply(edit(written)).document


def _is(node: object, operator: str) -> bool:
    return (
        isinstance(node, Application)
        and isinstance(node.head, OperatorName)
        and node.head.name == operator
    )


def _definition(document: Document, path: Path) -> str:
    """Return in which rule of the text a path leads, in words; nothing in an utterance."""
    item = document.nodes[path[0]]
    return f", in the rule `{item.name}`" if isinstance(item, Definition) else ""
