"""Finds the rule or operator that is applied at a place, and its next operand."""

from __future__ import annotations

from dataclasses import dataclass

from azee.assist import description
from azee.assist.expected import argument_number
from azee.assist.knowledge import Knowledge
from azee.assist.place import Place, place
from azee.lang.native import Native
from azee.lang.registry import NATIVES
from azee.lang.rule import Rule


@dataclass(frozen=True, slots=True)
class Signature:
    """The notation of an application, ranges in `text` of its operands, and the current one."""

    text: str
    meaning: str
    operands: tuple[tuple[int, int], ...]
    active: int | None


def signature(text: str, offset: int, knowledge: Knowledge) -> Signature | None:
    """Return the signature of the application at an offset."""
    where = place(text, offset)
    head = where.frame.head
    if where.silent or head is None:
        return None
    if head.kind == "OPERATOR" and head.text in NATIVES:
        return _native(NATIVES[head.text], where)
    if head.kind in ("RULE", "REFERENCE", "POSTURE", "OPERATOR"):
        found = knowledge.rule(head.text)
        return _rule(found, where) if found else None
    return None


def _rule(found: Rule, where: Place) -> Signature:
    texts = list(description.parameter_texts(found))
    names = [name for name, _ in found.parameters]
    active = argument_number(where, names)
    return _laid_out(f":{found.name}", texts, found.entry("meaning") or "", active)


def _native(native: Native, where: Place) -> Signature:
    head, *texts = native.signature.split(" ")
    active: int | None = None
    if native.operands:
        last = len(native.operands) - 1
        active = (
            where.number if where.number <= last else last if native.operands[-1].rest else None
        )
    elif native.pattern and where.number < len(texts):
        active = where.number
    return _laid_out(head, texts, native.meaning, active)


def _laid_out(head: str, texts: list[str], meaning: str, active: int | None) -> Signature:
    ranges: list[tuple[int, int]] = []
    line = head
    for text in texts:
        ranges.append((len(line) + 1, len(line) + 1 + len(text)))
        line = f"{line} {text}"
    return Signature(line, meaning, tuple(ranges), active)
