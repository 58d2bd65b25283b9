"""Describes the meaning of a name: the same for hover, documentation and completion."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum

from azee.assist.knowledge import Knowledge
from azee.lang.constants import CONSTANTS
from azee.lang.native import Native, Operand
from azee.lang.registry import NATIVES
from azee.lang.rule import Rule
from azee.lang.sync_shape import RULES, SyncRule
from azee_grammar import vocabulary
from azee_grammar.source import Span

_SUFFIX = re.compile(r"_(?:R|L)(?:_[123])?$")

_SIDE_WORD = re.compile(r"\b(?:left|right) ", re.IGNORECASE)


class What(Enum):
    """What kind of name it is."""

    RULE = "rule"
    OPERATOR = "operator"
    BONE = "bone"
    SITE = "site"
    MORPH = "morph"
    CONSTANT = "constant"
    SIDE = "side"
    SYNC_RULE = "sync rule"
    ARGUMENT = "argument"
    OPTION = "option"
    WORD = "word"
    BLOCK = "block"
    LOCAL = "local name"
    LIBRARY = "library"
    ENTRY = "entry"


@dataclass(frozen=True, slots=True)
class Description:
    """A name as it is written, its use, its meaning, and further facts with their labels.

    `place` is where it is defined, if a text defines it.
    """

    what: What
    title: str
    signature: str
    meaning: str
    facts: tuple[tuple[str, str], ...] = ()
    place: Span | None = None


def rule(found: Rule, knowledge: Knowledge) -> Description:
    """Describe a rule: its arguments with their defaults, its source, an example."""
    facts: list[tuple[str, str]] = []
    for parameter in found.defaults:
        default = "mandatory"
        if parameter.default is not None:
            default = f"by default {_one_line(parameter.default.span.text)}"
        facts.append(("argument", f"'{parameter.name}  {default}"))
    if kind := knowledge.gives(found):
        facts.append(("gives", kind.value))
    facts += [
        (entry.name, text.text)
        for entry, text in found.definition.entries
        if entry.name != "meaning"
    ]
    facts.append(("library", found.library or str(found.definition.name_span)))
    meaning = found.entry("meaning") or ""
    place = found.definition.name_span
    return Description(
        What.RULE, f":{found.name}", rule_signature(found), meaning, tuple(facts), place
    )


def rule_signature(found: Rule) -> str:
    """Return a rule with its arguments; optional ones are in brackets."""
    return " ".join((f":{found.name}", *(text for text in parameter_texts(found))))


def parameter_texts(found: Rule) -> Iterator[str]:
    """Yield a rule's arguments in the notation of a signature."""
    for parameter in found.defaults:
        if parameter.default is None:
            yield f"'{parameter.name}"
        else:
            default = _one_line(parameter.default.span.text)
            yield f"['{parameter.name}{f' {default}' if len(default) <= 24 else ''}]"


def operator(native: Native) -> Description:
    """Describe a native operator: operands, options, result, example."""
    facts = [("operand", _operand(operand)) for operand in native.operands]
    for option in native.options:
        wanted = f", {option.operand.wanted}" if option.operand else ""
        facts.append(("option", f"'{option.word}{wanted}: {option.meaning}"))
    if native.result:
        facts.append(("gives", native.result.value))
    if native.example:
        facts.append(("example", native.example))
    return Description(What.OPERATOR, native.name, native.signature, native.meaning, tuple(facts))


def _operand(operand: Operand) -> str:
    more = " …" if operand.rest else ", may be left out" if operand.optional else ""
    meaning = "" if operand.meaning == operand.wanted else f": {operand.meaning}"
    return f"{operand.name.upper()}, {operand.wanted}{more}{meaning}"


def sync_rule(found: SyncRule) -> Description:
    """Describe a word that places a block of a `sync`."""
    words = {"start": "REF", "end": "REF", "duration": "SECONDS", "block": "BLOCK"}
    pattern = " ".join((f"'{found.word}", *(words[operand] for operand in found.operands)))
    return Description(What.SYNC_RULE, f"'{found.word}", pattern, f"the block is {found.meaning}")


def constant(name: str) -> Description | None:
    """Describe `^name`."""
    found = CONSTANTS.get(name)
    if found is None:
        return None
    facts = (("gives", found.value.kind.value),)
    return Description(What.CONSTANT, f"^{name}", f"^{name}", found.meaning, facts)


def side(name: str) -> Description | None:
    """Describe `s`, `w`, `L` or `R`."""
    found = CONSTANTS.get(name)
    if found is None or name not in "swLR":
        return None
    return Description(What.SIDE, name, name, found.meaning)


def bone(name: str) -> Description | None:
    """Describe `!name`."""
    found = vocabulary.bone_names().get(name)
    if found is None:
        return None
    parents = {
        _SUFFIX.sub("", parent)
        for full, parent in vocabulary.BONES.items()
        if parent and _SUFFIX.sub("", full) == name and _SUFFIX.sub("", parent) != name
    }
    hangs = f"hangs on {' or '.join(f'!{parent}' for parent in sorted(parents))}" if parents else ""
    return Description(What.BONE, f"!{name}", f"!{_operands(found)}", hangs)


def site(name: str) -> Description | None:
    """Describe `@NAME`."""
    found = vocabulary.site_names().get(name)
    if found is None:
        return None
    entry = _entry(vocabulary.SITES, name)
    bone_name = _SUFFIX.sub("", entry.bone) if entry else ""
    facts = (("bone", f"!{bone_name}"),) if bone_name else ()
    meaning = _of_either_side(found, entry.description) if entry else ""
    return Description(What.SITE, f"@{name}", f"@{_operands(found)}", meaning, facts)


def morph(name: str) -> Description | None:
    """Describe `'name` after `morph`."""
    found = vocabulary.morph(name)
    if found is None:
        return None
    entry = _entry(vocabulary.MORPHS, name)
    side_word = " SIDE" if found.takes_side else ""
    if found.side_optional:
        side_word = " [SIDE]"
    facts = (("kind", entry.kind),) if entry else ()
    meaning = _of_either_side(found, entry.description) if entry else ""
    return Description(What.MORPH, f"'{name}", f"'{name}{side_word} WEIGHT", meaning, facts)


def library(name: str) -> Description:
    """Describe `'name` after `use`."""
    return Description(What.LIBRARY, f"'{name}", f"use '{name}", "a library of rules")


NAMED: Mapping[str, Callable[[str], Description | None]] = {
    "!": bone,
    "@": site,
    "^": constant,
}
"""Functions that describe a name by its sigil, if the sigil alone decides."""


def describe(name: str, knowledge: Knowledge) -> tuple[Description, ...]:
    """Return the possible meanings of a name: with its sigil one, without it all of that name."""
    sigil, rest = name[:1], name[1:]
    found: list[Description | None] = []
    if sigil in NAMED:
        found.append(NAMED[sigil](rest))
    elif sigil == "'":
        found += [sync_rule(RULES[rest]) if rest in RULES else None, morph(rest)]
    else:
        bare = name.removeprefix(":#").removeprefix(":").removeprefix(".")
        named = knowledge.rule(bare)
        found.append(rule(named, knowledge) if named else None)
        if bare == name:
            found.append(operator(NATIVES[name]) if name in NATIVES else None)
            found.append(sync_rule(RULES[name]) if name in RULES else None)
            found += [bone(name), site(name), morph(name), constant(name)]
    return tuple(description for description in found if description is not None)


def _operands(found: vocabulary.Name) -> str:
    parts = [found.name]
    if found.takes_side:
        parts.append("[SIDE]" if found.side_optional else "SIDE")
    if found.takes_phalanx:
        parts.append("|".join(map(str, found.phalanges)))
    return " ".join(parts)


def _entry(table: Mapping[str, vocabulary.V], name: str) -> vocabulary.V | None:
    """Return the entry of an unsided name: the first of its variants."""
    if name in table:
        return table[name]
    return next((entry for full, entry in table.items() if _SUFFIX.sub("", full) == name), None)


def _of_either_side(found: vocabulary.Name, text: str) -> str:
    """Rewrite the description of one side's variant as that of both sides."""
    if not found.takes_side or found.side_optional:
        return text
    plain = _SIDE_WORD.sub("", text)
    return plain[:1].upper() + plain[1:]


def _one_line(text: str) -> str:
    return " ".join(text.split())
