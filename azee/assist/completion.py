"""Completes a word that is being written."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from azee.assist import description
from azee.assist.description import Description, What
from azee.assist.expected import Expected, expected
from azee.assist.frame import Frame
from azee.assist.knowledge import Knowledge
from azee.assist.place import Place, place
from azee.lang.constants import CONSTANTS
from azee.lang.registry import NATIVES
from azee.lang.values import Kind
from azee_grammar import vocabulary
from azee_grammar.nearest import folded


@dataclass(frozen=True, slots=True)
class Completion:
    """A name that can replace `[start, end)`, with its meaning."""

    insert: str
    start: int
    end: int
    described: Description


def completions(text: str, offset: int, knowledge: Knowledge) -> tuple[Completion, ...]:
    """Return the completions at an offset, the likeliest first.

    Names that begin with the written word come first, then names that contain it, without regard to
    case, accents and hyphens. Without a sigil, operators, sides and rules by their bare names are
    proposed.
    """
    where = place(text, offset)
    if where.silent:
        return ()
    wanted = expected(where, knowledge)
    found: dict[str, Description] = {}
    for candidate in _candidates(where, wanted, knowledge):
        found.setdefault(candidate.title, candidate)
    name = folded(where.name)
    ranked = []
    for order, candidate in enumerate(found.values()):
        rank = _rank(name, candidate.title)
        if rank is not None and candidate.title != where.word:
            ranked.append((rank, order, candidate))
    ranked.sort(key=lambda entry: entry[:2])
    return tuple(
        Completion(_insert(candidate, where), where.start, offset, candidate)
        for _, _, candidate in ranked
    )


def _rank(wanted: str, title: str) -> int | None:
    known = folded(title.lstrip(":#.'^!@"))
    if known.startswith(wanted):
        return 0
    return 1 if len(wanted) > 1 and wanted in known else None


def _insert(candidate: Description, where: Place) -> str:
    named = where.frame.called and candidate.what is What.ARGUMENT
    return f"{candidate.title} = " if named else candidate.title


def _candidates(where: Place, wanted: Expected, knowledge: Knowledge) -> Iterator[Description]:
    match where.sigil:
        case ":" | ".":
            yield from _rules(where, wanted, knowledge, where.sigil)
        case ":#":
            constraints = Expected((Kind.CONSTRAINTS,))
            yield from _rules(where, constraints, knowledge, ":#")
        case "'":
            yield from wanted.symbols
        case "^":
            yield from visible_locals(where, knowledge)
            yield from _fitting(filter(None, map(description.constant, CONSTANTS)), wanted)
            yield from filter(None, map(description.constant, CONSTANTS))
        case "!":
            yield from filter(None, map(description.bone, vocabulary.bone_names()))
        case "@":
            yield from filter(None, map(description.site, vocabulary.site_names()))
        case _:
            yield from wanted.symbols
            if wanted.value:
                yield from _values(where, wanted, knowledge)


def _values(where: Place, wanted: Expected, knowledge: Knowledge) -> Iterator[Description]:
    """Yield everything that gives a value: certain candidates first, possible ones last."""
    if where.frame.head is None and where.frame.parent is None:
        yield from map(description.operator, (NATIVES["def"], NATIVES["use"]))
    yield from visible_locals(where, knowledge)
    if wanted.kinds:
        if Kind.SIDE in wanted.kinds:
            yield from filter(None, map(description.side, "swLR"))
        if Kind.BONE in wanted.kinds:
            yield from filter(None, map(description.bone, vocabulary.bone_names()))
        if wanted.accepts(Kind.SITE):
            yield from filter(None, map(description.site, vocabulary.site_names()))
        yield from _fitting(filter(None, map(description.constant, CONSTANTS)), wanted)
    natives = [native for native in NATIVES.values() if native.name not in ("def", "use", "places")]
    yield from (description.operator(n) for n in natives if n.result in wanted.kinds)
    yield from _rules(where, wanted, knowledge, ":")
    yield from (description.operator(n) for n in natives if wanted.accepts(n.result))


def _fitting(found: Iterable[Description], wanted: Expected) -> Iterator[Description]:
    for described in found:
        if wanted.accepts(CONSTANTS[described.title[1:]].value.kind):
            yield described


def _rules(
    where: Place, wanted: Expected, knowledge: Knowledge, sigil: str
) -> Iterator[Description]:
    """Yield the rules of the text itself, then those in scope whose result may fit."""
    for name in where.defined:
        yield Description(What.RULE, f"{sigil}{name}", f":{name}", "a rule of this text")
    typed = folded(where.name)
    for rule in knowledge.rules(lambda name: _rank(typed, name) is not None):
        kind = knowledge.gives(rule)
        if sigil == ".":
            kind = Kind.OPERATOR if wanted.kinds else None
        if not wanted.accepts(kind):
            continue
        prefix = ":#" if sigil == ":" and _is_posture(kind, wanted) else sigil
        described = description.rule(rule, knowledge)
        yield replace(described, title=f"{prefix}{rule.name}")


def _is_posture(kind: Kind | None, wanted: Expected) -> bool:
    return kind is Kind.CONSTRAINTS and Kind.CONSTRAINTS in wanted.kinds


def visible_locals(where: Place, knowledge: Knowledge) -> Iterator[Description]:
    """Yield parameters, local names and the text's places that are visible, the innermost first."""
    inside: Frame | None = None
    for frame in where.frame.outwards():
        head = frame.head
        if head is not None and head.text == "azop":
            for i, name in frame.symbols():
                if i % 2 == 0:
                    yield Description(What.LOCAL, f"^{name}", f"^{name}", "a parameter")
        elif head is not None and head.text == "let" and _is_body(frame, inside, where):
            for i, name in frame.symbols():
                if i == 0:
                    yield Description(What.LOCAL, f"^{name}", f"^{name}", "a local name")
        inside = frame
    for name in knowledge.scope.places:
        yield Description(What.LOCAL, f"^{name}", f"^{name}", "a place of this text")


def _is_body(let: Frame, inside: Frame | None, where: Place) -> bool:
    """Whether a place is in the body of a `let`, where its name is visible."""
    if inside is None:
        return where.number >= 2
    number = next((i for i, operand in enumerate(let.operands) if operand.frame is inside), 0)
    return number >= 2
