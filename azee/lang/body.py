"""Bones and sites of the body in a text."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from azee.lang.code import Code, Names, gathered
from azee.lang.fault import Fault, fault, together
from azee.lang.machine import Machine
from azee.lang.values import BoneValue, Kind, NumberValue, SideValue, SiteValue, Value
from azee_grammar.source import Span
from azee_grammar.vocabulary import Name
from azee_solver.geometry import Bone, Side, Site


@dataclass(frozen=True, slots=True, eq=False)
class BodyPart(Code):
    """`!index s 2`, `@I_TIP s`: a name of the vocabulary, then side and phalanx."""

    span: Span
    entry: Name
    wanted: Kind
    """BONE or SITE."""
    operands: tuple[Code, ...]

    @property
    def kind(self) -> Kind:
        """A bone or a site."""
        return self.wanted

    @property
    def title(self) -> str:
        """The name with its sigil."""
        return f"`{'!' if self.wanted is Kind.BONE else '@'}{self.entry.name}`"

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Evaluate side and phalanx."""
        level = machine.enter(1 + len(self.operands), self.span)
        values = gathered(self.operands, machine, names)
        machine.depth = level
        faults: list[Fault] = []
        side: Side | None = None
        phalanx: int | None = None
        rest = list(zip(values, self.operands, strict=True))
        if rest and not (isinstance(rest[0][0], NumberValue) and not self.entry.takes_side):
            value, code = rest.pop(0)
            if not isinstance(value, SideValue):
                faults.append(self._no_side(value.kind, code.span))
            elif not self.entry.takes_side:
                faults.append(self._sideless(code.span))
            else:
                side = value.content
        if rest and self.entry.takes_phalanx:
            value, code = rest.pop(0)
            phalanx = self._phalanx(value)
            if phalanx is None:
                faults.append(self._bad_phalanx(value, code.span))
        if rest:
            faults.append(
                fault("too-many-arguments", f"{self.title} takes {self.takes}", rest[0][1].span)
            )
        if not self.operands:
            faults += self._lacking()
        elif self.entry.takes_phalanx and len(self.operands) == 1 and not faults:
            faults.append(fault("bad-phalanx", f"{self.title} lacks its phalanx", self.span))
        if faults:
            raise together(faults)
        name = self.entry.name
        if self.wanted is Kind.BONE:
            return BoneValue(Bone(name, side, phalanx))
        return SiteValue(Site(name, side, phalanx))

    @property
    def takes(self) -> str:
        """The operands that it takes, as messages call them."""
        side = "a side" if self.entry.takes_side else "no side"
        if not self.entry.takes_phalanx:
            return side
        return f"{side}, then a phalanx, {_numbers(self.entry.phalanges)}"

    def _lacking(self) -> Sequence[Fault]:
        if self.entry.takes_side and not self.entry.side_optional:
            message = f"{self.title} lacks its side"
            sigil = "!" if self.wanted is Kind.BONE else "@"
            more = f", {self.entry.phalanges[0]}" if self.entry.takes_phalanx else ""
            hint = f"write `{sigil}{self.entry.name}(s{more})`: s, w, L or R"
            return (fault("bad-side", message, self.span, help=hint),)
        return ()

    def _no_side(self, kind: Kind, span: Span) -> Fault:
        message = f"{self.title} takes {self.takes}; {kind.value} is no side"
        return fault("bad-side", message, span, label="one of s, w, L, R goes here")

    def _sideless(self, span: Span) -> Fault:
        return fault("bad-side", f"{self.title} is in the middle of the body: no side", span)

    def _phalanx(self, value: Value) -> int | None:
        if isinstance(value, NumberValue) and value.content in self.entry.phalanges:
            return int(value.content)
        return None

    def _bad_phalanx(self, value: Value, span: Span) -> Fault:
        numbers = _numbers(self.entry.phalanges)
        got = f"{value.content:g}" if isinstance(value, NumberValue) else value.kind.value
        return fault("bad-phalanx", f"{self.title} has the phalanges {numbers}, not {got}", span)


def _numbers(phalanges: tuple[int, ...]) -> str:
    *first, last = map(str, phalanges)
    return f"{', '.join(first)} and {last}" if first else last
