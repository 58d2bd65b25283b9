"""The rules of the libraries that ship, for those who look for one, and as data for programs."""

from __future__ import annotations

import unicodedata
from typing import Any

from azee.lang.library import shipped_library
from azee.lang.rule import Rule
from azee.lang.scope import Namespace
from azee_grammar.library import shipped_names


def shipped_rules() -> dict[str, list[Rule]]:
    """Return the rules of every library that ships, by its name."""
    return {library: by_name(shipped_library(library).namespace) for library in shipped_names()}


def by_name(namespace: Namespace) -> list[Rule]:
    """Return the rules of a library in the order of their names."""
    return sorted(namespace.rules.values(), key=lambda rule: rule.name)


def speaks_of(rule: Rule, text: str) -> bool:
    """Whether a text is in a rule's name, meaning, source or arguments, whatever its accents."""
    entries = (rule.entry("meaning") or "", rule.entry("source") or "")
    whole = " ".join((rule.name, *entries, *(name for name, _ in rule.parameters)))
    return _plain(text) in _plain(whole)


def rule_as_json(rule: Rule) -> dict[str, Any]:
    """Return a rule as docs/formats.md describes it."""
    return {
        "name": rule.name,
        "library": rule.library,
        "meaning": rule.entry("meaning"),
        "source": rule.entry("source"),
        "status": rule.entry("status"),
        "arguments": [
            {
                "name": parameter.name,
                "mandatory": parameter.default is None,
                "default": None
                if parameter.default is None
                else " ".join(parameter.default.span.text.split()),
            }
            for parameter in rule.defaults
        ],
    }


def _plain(text: str) -> str:
    """Without case and accents, so that `age` finds `âge`."""
    apart = unicodedata.normalize("NFKD", text.casefold())
    return "".join(c for c in apart if not unicodedata.combining(c))
