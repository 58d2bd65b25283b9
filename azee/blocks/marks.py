"""The marks with which blocks show what a rule or an operator does with its parts."""

from __future__ import annotations

from collections.abc import Mapping

from azee_grammar.syntax import BoneName, Head, OperatorName, RuleName, SiteName

MARKS: Mapping[str, str] = {
    "info-about": "=",
    "in-context": "/",
    "context-ssp": "/",
    "sequence-result": "→",
    "seq-res": "→",
    "conditional": "→",
    "simultaneous": "//",
    "intensity": "++",
}
"""By rule: the marks of the block editor of 2020 (`=`, `/`, `→`, `//`, `++`)."""

OPERATOR_MARKS: Mapping[str, str] = {"sync": "//", "seq": "→"}
"""By native operator: ours, in the sense of those of the rules."""


def mark_of(head: Head) -> str | None:
    """Return the mark of a head, if it has one."""
    match head:
        case RuleName(name=name):
            return MARKS.get(name)
        case OperatorName(name=name):
            return OPERATOR_MARKS.get(name, MARKS.get(name))
        case BoneName() | SiteName():
            return None
