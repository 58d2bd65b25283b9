"""The state of one evaluation: the steps taken and the depth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from azee.lang.fault import Exhausted, Fault
from azee.lang.procedure import Applicable, Procedure
from azee.lang.recordings import Recordings
from azee.lang.scope import Namespace
from azee.lang.values import OperatorValue, ScoreValue, Value
from azee.score.score import Call, came_from
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.source import Span
from azee_solver.constraint import Origin


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of one evaluation, so that no text can run forever or fill the memory."""

    depth: int = 200
    """Expressions inside one another, bodies of called rules included; also parts of values."""
    steps: int = 1_000_000
    """Expressions evaluated and elements visited.

    Applying a rule, leaving one with a mistake and laying out a block of a score count as `HEAVY`
    steps each, by the time they take.
    """
    size: int = 500_000
    """Parts of one value, counted as a tree: a part that is used twice counts twice.

    A thousand signs of two hands, half an hour of signing, have about 250,000.
    """


DEFAULT_LIMITS = Limits()
HEAVY = 5


class Machine:
    """Evaluates within limits. One machine serves one utterance."""

    __slots__ = ("_results", "depth", "libraries", "limits", "recordings", "steps")

    def __init__(
        self,
        limits: Limits = DEFAULT_LIMITS,
        libraries: Sequence[Namespace] = (),
        recordings: Recordings | None = None,
    ) -> None:
        self.limits = limits
        self.libraries = libraries
        """What the evaluated text uses: rules of other libraries find these by name."""
        self.recordings = recordings
        """Where `recorded` finds signs."""
        self.steps = 0
        self.depth = 0
        self._results: dict[Procedure, Value] = {}
        """Values of rules that were applied without arguments: these are always the same."""

    def enter(self, steps: int, span: Span) -> int:
        """Count steps and go one level deeper; return the level to come back to."""
        self.steps += steps
        depth = self.depth
        if self.steps > self.limits.steps:
            raise self._out_of_steps(span)
        if depth >= self.limits.depth:
            message = f"more than {self.limits.depth} expressions stand inside one another"
            hint = "does a rule apply itself without end?"
            raise Exhausted(Diagnostic("recursion-limit", message, span, help=hint))
        self.depth = depth + 1
        return depth

    def spend(self, steps: int, span: Span) -> None:
        """Count steps for the parts of a value that an operator visits one by one."""
        self.steps += steps
        if self.steps > self.limits.steps:
            raise self._out_of_steps(span)

    def _out_of_steps(self, span: Span) -> Exhausted:
        message = f"this takes more than {self.limits.steps:,} steps"
        return Exhausted(Diagnostic("step-limit", message, span))

    def require_size(self, size: int, span: Span) -> None:
        """Refuse a value of more than `limits.size` parts, before it is built."""
        if size > self.limits.size:
            message = f"this value has more than {self.limits.size:,} parts"
            raise Exhausted(Diagnostic("size-limit", message, span))

    def require_depth(self, depth: int, span: Span) -> None:
        """Refuse a value nested deeper than `limits.depth`."""
        if depth > self.limits.depth:
            message = f"this value is nested more than {self.limits.depth} deep"
            raise Exhausted(Diagnostic("recursion-limit", message, span))

    def call(
        self, operator: Applicable, given: Mapping[str, Value], span: Span, origin: Origin
    ) -> Value:
        """Apply a rule or an `azop` to arguments by name.

        Defaults are evaluated now and can use the parameters before them. `arguments.bound` has
        checked that no mandatory argument is missing. `span` and `origin` are the place of the
        application.

        Raises: Fault: any fault inside, with this call added to the rule call stack.
        """
        procedure = operator.procedure
        plain = not (procedure.names or operator.bound or given)
        if plain and procedure in self._results:
            return _came_from(operator, self._results[procedure], origin)
        names = dict[str, Value](procedure.names)
        known = {**operator.bound, **given}
        depth = self.depth
        try:
            for parameter in procedure.parameters:
                if parameter.name in known or parameter.default is None:
                    names[parameter.name] = known[parameter.name]
                else:
                    names[parameter.name] = parameter.default.evaluate(self, names)
            value = procedure.body.evaluate(self, names)
        except Fault as problem:
            self.depth = depth
            self.steps += HEAVY
            raise problem.through(operator.title, span) from None
        if plain:
            self._results[procedure] = value
        return _came_from(operator, value, origin)


def _came_from(operator: Applicable, value: Value, origin: Origin) -> Value:
    """Mark a score as the result of a rule."""
    rule = operator.procedure.rule
    if rule is None or not isinstance(value, ScoreValue):
        return value
    score = came_from(value.content, Call(rule, origin, operator.handed_over))
    return ScoreValue(score, value.size, value.depth)


def operator_value(procedure: Procedure, bound: Mapping[str, Value]) -> OperatorValue:
    """Return a rule or an `azop` as a value, with some arguments given."""
    size = 1 + sum(v.size for v in bound.values())
    depth = 1 + max((v.depth for v in bound.values()), default=0)
    return OperatorValue(Applicable(procedure, bound, handed_over=True), size, depth)
