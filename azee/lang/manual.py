"""The manual's page of operators, generated from their declarations.

`python -m azee.lang.manual` prints docs/language/operators.md; a test compares the two.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence

from azee.lang.constants import CONSTANTS
from azee.lang.native import Group, Native, Operand
from azee.lang.registry import NATIVES
from azee.lang.sync_shape import RULES
from azee.lang.values import Kind

_HEAD = """# Operators and constants

This page describes every operator of the language and its operands. It is generated from the
declarations that also check operands. Forms marked **(P)** are printed in theses, papers or
posters, without their options. If the mark is **(P, name)**, only the name is printed there.
Forms marked **(O)** are this project's own design. [syntax.md](syntax.md) explains how operands
are written, [sync.md](sync.md) the rules of `sync`, and [evaluation.md](evaluation.md) values
and names.

In a pattern, `…` repeats the part before it, and brackets enclose optional parts. A site may
stand for a point, and a single constraint for constraints. An option is written `'word value`
after the operands.
"""


def operators() -> str:
    """Return docs/language/operators.md."""
    parts = [_HEAD]
    for group in Group:
        parts.append(f"## {group.value}\n")
        parts += [_operator(native) for native in NATIVES.values() if native.group is group]
    parts.append(_constants())
    parts.append(_sync_rules())
    return "\n".join(parts)


def _operator(native: Native) -> str:
    mark = "(P, name)" if native.only_name_published else _mark(native.published)
    lines = [f"### `{native.signature}` {mark}\n", f"{native.meaning}\n"]
    described = [*_operands(native.operands)]
    for option in native.options:
        meaning = option.meaning
        kinds = f", {option.operand.wanted}" if option.operand is not None else ""
        described.append(f"- `'{option.word}`{kinds}: {meaning}")
    if described:
        lines.append("\n".join(described) + "\n")
    result = native.result.value if native.result else _dependent(native)
    if result:
        lines.append(f"Gives {result}.\n")
    if native.example:
        lines.append(f"```azee\n{native.example}\n```\n")
    return "\n".join(lines)


def _operands(operands: Sequence[Operand]) -> Iterator[str]:
    for operand in operands:
        wanted = operand.wanted
        if operand.rest:
            least = f", {operand.least} or more" if operand.least else ", any number"
            wanted += least
        elif operand.optional:
            wanted += ", may be left out"
        meaning = "" if operand.meaning == wanted else f": {operand.meaning}"
        yield f"- `{operand.name.upper()}`, {wanted}{meaning}"


def _dependent(native: Native) -> str:
    """Describe the result of an operator if it depends on the operands."""
    if native.name in ("def", "use", "places"):
        return ""
    if native.name in ("mirror", "with-dominant", "relocate"):
        return f"{Kind.SCORE.value} or {Kind.CONSTRAINTS.value}, like its content"
    return "a value of the kind that its operands make"


def _constants() -> str:
    rows = [f"| `^{c.name}` | {c.meaning} | {_mark(c.published)} |" for c in CONSTANTS.values()]
    head = (
        "## Constants\n\nA parameter of the same name hides a constant.\n\n| | | |\n|---|---|---|\n"
    )
    return head + "\n".join(rows) + "\n"


def _sync_rules() -> str:
    words = {"start": "REF", "end": "REF", "duration": "SECONDS", "block": "BLOCK"}
    rows = [
        f"| `'{rule.word} {' '.join(words[role] for role in rule.operands)}` "
        f"| {rule.meaning} | {_mark(rule.published)} |"
        for rule in RULES.values()
    ]
    return "## Rules of `sync`\n\n| | the block is | |\n|---|---|---|\n" + "\n".join(rows) + "\n"


def _mark(published: bool) -> str:
    return "(P)" if published else "(O)"


if __name__ == "__main__":
    sys.stdout.write(operators())
