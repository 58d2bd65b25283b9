"""The rules that a text may use, as a page lists and searches them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from azee.assist.description import rule_signature
from azee.assist.knowledge import Knowledge
from azee.lang.program import load
from azee.lang.rule import Rule
from azee_grammar.source import Source

MOST_RULES = 5_000


def palette(text: str, path: Path, libraries: Sequence[Path]) -> list[dict[str, Any]]:
    """Return the rules in scope of a text, by name.

    Each has `name`, `signature`, `meaning`, `library` (none for a rule of the text itself),
    `status`, `gives` (the kind of its result, if its body shows it) and `arguments`: `name`,
    and `default`, its text, none where the argument is mandatory.
    """
    program = load(Source(str(path), text), libraries, place=path)
    knowledge = Knowledge(program.scope, (path.parent, *libraries))
    rules = sorted(knowledge.rules(), key=lambda rule: rule.name)[:MOST_RULES]
    return [_row(rule, knowledge) for rule in rules]


def _row(rule: Rule, knowledge: Knowledge) -> dict[str, Any]:
    kind = knowledge.gives(rule)
    return {
        "name": rule.name,
        "signature": rule_signature(rule),
        "meaning": rule.entry("meaning") or "",
        "source": rule.entry("source") or "",
        "library": rule.library,
        "status": rule.status,
        "gives": kind.value if kind else None,
        "arguments": [
            {"name": p.name, "default": None if p.default is None else p.default.span.text}
            for p in rule.defaults
        ],
    }
