"""Counts how far the forms of the rules in a text are known, from their `'status`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from azee.lang.library import SHIPPED_RESOLVING
from azee.lang.manifest import RuleState, read_beside
from azee.lang.program import Program
from azee.lang.rule import STATUSES, Rule
from azee.lang.written import Written, written_in
from azee.score.provenance import UNSTATED, LibraryStamp, Provenance
from azee_grammar.library import shipped
from azee_grammar.parser import parse_expression
from azee_grammar.source import Source
from azee_grammar.syntax import Expr


def written(
    program: Program, expression: str | None = None, utterance: int | None = None
) -> list[Written]:
    """Return the applications in an expression, else in one utterance or in all of a text.

    Args: utterance: its number from 1; the text has it.
    """
    exprs = _expressions(program, expression, utterance)
    return [found for expr in exprs for found in written_in(expr, program.scope)]


def provenance_of(applications: Iterable[Written]) -> Provenance:
    """Count the statuses of the rules applied, and stamp their libraries.

    Raises: AZeeError: the manifest of a library cannot be read.
    """
    counts: Counter[str] = Counter()
    used: dict[str, dict[str, Rule]] = {}
    for found in applications:
        rule = found.rule
        counts[_status(found)] += 1
        if rule is not None and rule.library is not None:
            used.setdefault(rule.library, {})[rule.name] = rule
    statuses = {status: counts[status] for status in (*STATUSES, UNSTATED) if counts[status]}
    return Provenance(statuses, tuple(_stamp(name, used[name].values()) for name in sorted(used)))


def names_by_status(applications: Iterable[Written]) -> dict[str, list[str]]:
    """Return the names of the rules applied, each once and sorted, by their status."""
    names: dict[str, set[str]] = {}
    for found in applications:
        names.setdefault(_status(found), set()).add(found.name)
    return {s: sorted(names[s]) for s in (*STATUSES, UNSTATED) if s in names}


def _status(found: Written) -> str:
    return (found.rule.status if found.rule else None) or UNSTATED


def _expressions(
    program: Program, expression: str | None, utterance: int | None
) -> Sequence[Expr] | Iterator[Expr]:
    if expression is not None:
        expr, _ = parse_expression(Source("<expression>", expression))
        return () if expr is None else (expr,)
    found = [item.expr for item in program.utterance_items()]
    return found if utterance is None else found[utterance - 1 : utterance]


def _stamp(name: str, used: Iterable[Rule]) -> LibraryStamp:
    rules = list(used)
    manifest = read_beside(_folder(rules[0]))
    if manifest is None or manifest.name != name:
        return LibraryStamp(name)
    changed = (rule.name for rule in rules if manifest.rules.get(rule.name) != RuleState.of(rule))
    return LibraryStamp(
        name,
        manifest.version,
        manifest.licence,
        manifest.citation,
        manifest.digest,
        tuple(sorted(changed)),
    )


def _folder(rule: Rule) -> Path:
    """Return the folder of the library that a rule is in."""
    file = Path(rule.definition.span.source.name)
    return shipped() / file.parent if rule.resolving is SHIPPED_RESOLVING else file.parent
