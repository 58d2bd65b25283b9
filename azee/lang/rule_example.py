"""An expression that shows what a rule does, for those who go over all rules."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from azee.lang.library import CORE, DEFAULT
from azee.lang.program import load
from azee.lang.values import Kind
from azee_grammar.source import Source

if TYPE_CHECKING:
    from azee.lang.rule import Rule


def example_of(rule: Rule, libraries: Sequence[Path] = ()) -> str:
    """Return the rule's own example, else its application, as a score.

    Where the rule has no example and must be given arguments, they are written `…`: then it is a
    pattern, which cannot be evaluated.

    Args: libraries: folders that `use` looks in for the rule's library.
    """
    if own := rule.entry("example"):
        return own
    given = ", ".join(f"'{name} = …" for name, mandatory in rule.parameters if mandatory)
    if given:
        return f":{rule.name}({given})"
    return f"key(1, :#{rule.name})" if _is_posture(rule, libraries) else f":{rule.name}"


def example_text(rule: Rule, libraries: Sequence[Path] = ()) -> str:
    """Return a text that shows a rule: its example, after the `use` that it may need.

    Args: libraries: folders that `use` looks in for the rule's library.
    """
    example = example_of(rule, libraries)
    seen_anyway = rule.library in (CORE, DEFAULT)
    return example if seen_anyway else f"use '{rule.library}\n{example}"


def _is_posture(rule: Rule, libraries: Sequence[Path]) -> bool:
    """Whether the rule's result is a set of constraints, which a key makes a score of."""
    program = load(Source("<none>", f"use '{rule.library}\n"), libraries)
    return program.value(f":{rule.name}").kind is Kind.CONSTRAINTS
