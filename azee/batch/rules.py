"""The rules of a library as texts of a batch: a clip for each sign of a lexicon."""

from __future__ import annotations

from pathlib import Path

from azee.batch.text import Text
from azee.lang.library import CORE, shipped_library
from azee.lang.program import Program, load
from azee.lang.rule import Rule
from azee.lang.rule_table import by_name
from azee.lang.scope import Namespace
from azee.lang.values import Kind
from azee_grammar.diagnostic import AZeeError, Diagnostic, Severity
from azee_grammar.files import is_file, is_folder
from azee_grammar.source import Source


def rules_of(library: str) -> tuple[list[Text], int]:
    """Return a text for each rule that can be signed, by name, and how many rules cannot.

    The text is the example of a rule, else the rule without arguments; a posture is held for a
    second. Rules that must be given arguments and have no example are left out, and so are those
    that give a point, a vector or the like. A rule that fails when it is evaluated is a text like
    others: what is wrong is found when it is compiled.

    Args: library: the folder or the file of one, else the name of one that ships or is installed.
    Raises: AZeeError: library-not-found, there is no rule in it, or the mistakes in a folder.
    """
    path = Path(library)
    own = is_folder(path) or is_file(path)
    folder = path.resolve().parent if own else None
    name = library
    if own:
        name = path.resolve().name if is_folder(path) else path.stem
    program = load(Source("<none>", f"use '{name}\n"), [] if folder is None else [folder])
    mistakes = [found for found in program.check() if found.severity is Severity.ERROR]
    if mistakes:
        raise AZeeError(*mistakes)
    rules = by_name(_namespace(program, name))
    if not rules:
        raise AZeeError(Diagnostic("library-not-found", f"`{library}` defines no rule", None))
    found = ((rule, _expression(rule, program)) for rule in rules)
    texts = [
        Text(
            rule.name,
            Source(f"{name}:{rule.name}", f"use '{name}\n{expression}\n"),
            folder,
            given={"library": name, "rule": rule.name, "meaning": rule.entry("meaning")},
        )
        for rule, expression in found
        if expression is not None
    ]
    return texts, len(rules) - len(texts)


def _namespace(program: Program, name: str) -> Namespace:
    if name == CORE:
        return shipped_library(CORE).namespace
    return next(found for found in program.scope.libraries if found.name == name)


def _expression(rule: Rule, program: Program) -> str | None:
    """Return what signs a rule; none if nothing does."""
    if own := rule.entry("example"):
        return own
    if any(mandatory for _, mandatory in rule.parameters):
        return None
    try:
        kind = program.value(f":{rule.name}").kind
    except AZeeError:
        return f":{rule.name}"
    if kind is Kind.CONSTRAINTS:
        return f"key(1, :#{rule.name})"
    return f":{rule.name}" if kind is Kind.SCORE else None
