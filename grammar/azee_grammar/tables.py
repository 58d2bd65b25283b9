"""The LALR(1) tables of azee.lark, available when the package is imported.

Loading Lark and computing the tables takes a tenth of a second, a fifth of the time that a whole
`azee check` may take. So the tables are stored in data/azee.tables.json, with the digest of their
grammar. After a change of the grammar, Lark computes them again, and `python -m
azee_grammar.tables` writes the file again.
"""

from __future__ import annotations

import json
from collections import deque
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, TypeAlias
from zlib import crc32

_HERE = Path(__file__).parent
GRAMMAR = _HERE / "azee.lark"
TABLES = _HERE / "data" / "azee.tables.json"
STARTS = ("item", "standalone")

State: TypeAlias = dict[str, int]
"""Actions per symbol: n >= 0 shifts (or goes) to state n, n < 0 reduces by rule -n - 1."""


@dataclass(frozen=True, slots=True)
class Production:
    """A rule of the grammar for the parser.

    origin: symbol it reduces to. size: symbols it takes. action: builder method, or None if the
        parts are passed on. keep: per symbol, whether it leaves a part. expand: a single part
        stands for itself. No production is empty.
    """

    origin: str
    size: int
    action: str | None
    keep: tuple[bool, ...]
    expand: bool
    unit: bool = field(init=False)
    """Whether a value passes unchanged, unless it is parts that must be joined."""

    def __post_init__(self) -> None:
        unit = self.size == 1 and self.keep[0] and (self.action is None or self.expand)
        object.__setattr__(self, "unit", unit)


@dataclass(frozen=True, slots=True)
class Tables:
    """States, productions, and the first and the accepting state for each start symbol."""

    states: tuple[State, ...]
    productions: tuple[Production, ...]
    starts: dict[str, int]
    ends: dict[str, int]


@cache
def tables() -> Tables:
    """Return the tables of azee.lark, from the committed file where it is up to date."""
    grammar = GRAMMAR.read_text(encoding="utf-8")
    data = json.loads(TABLES.read_text(encoding="utf-8")) if TABLES.exists() else {}
    if data.get("grammar") != digest(grammar):
        data = generate(grammar)
    return Tables(
        states=tuple(data["states"]),
        productions=tuple(
            Production(o, s, a, tuple(k), e) for o, s, a, k, e in data["productions"]
        ),
        starts=data["starts"],
        ends=data["ends"],
    )


def digest(grammar: str) -> str:
    """Return the digest that distinguishes one state of the grammar from another."""
    return f"{crc32(grammar.encode()):08x}"


def generate(grammar: str) -> dict[str, Any]:
    """Let Lark compute the tables; any conflict is an error.

    States are numbered in the order in which they are reached, so that the same grammar always
    gives the same file.
    """
    from lark import Lark
    from lark.lexer import Lexer
    from lark.parsers.lalr_analysis import Shift

    class Elsewhere(Lexer):
        """Placeholder for a lexer: words.py and layout.py make the tokens."""

        def __init__(self, conf: Any) -> None:
            pass

        def lex(self, lexer_state: Any, parser_state: Any) -> Any:
            raise NotImplementedError

    parser = Lark(grammar, parser="lalr", lexer=Elsewhere, start=list(STARTS), strict=True)
    table = parser.parser.parser._parse_table  # Lark has no public access to them

    number: dict[int, int] = {}
    queue: deque[int] = deque()

    def numbered(state: int) -> int:
        if state not in number:
            number[state] = len(number)
            queue.append(state)
        return number[state]

    rules: dict[Any, int] = {}
    starts = {name: numbered(table.start_states[name]) for name in STARTS}
    states: list[State] = []
    while queue:
        actions = table.states[queue.popleft()]
        state: State = {}
        for symbol in sorted(actions):
            kind, argument = actions[symbol]
            if kind is Shift:
                state[symbol] = numbered(argument)
            else:
                state[symbol] = -1 - rules.setdefault(argument, len(rules))
        states.append(state)
    return {
        "grammar": digest(grammar),
        "starts": starts,
        "ends": {name: number[table.end_states[name]] for name in STARTS},
        "productions": [_production(rule) for rule in rules],
        "states": states,
    }


def serialized(data: dict[str, Any]) -> str:
    """Return tables in the form of the committed file: a line for each state and production."""
    lines = [f"  {json.dumps(key)}: {_pretty(value)}" for key, value in data.items()]
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _production(rule: Any) -> list[Any]:
    origin = rule.origin.name
    action = rule.alias or (None if origin.startswith("_") else origin)
    keep = [not (symbol.is_term and symbol.name.startswith("_")) for symbol in rule.expansion]
    return [
        origin,
        len(rule.expansion),
        action,
        keep,
        bool(rule.options.expand1 and not rule.alias),
    ]


def main() -> None:
    """Write the committed file again."""
    text = serialized(generate(GRAMMAR.read_text(encoding="utf-8")))
    TABLES.write_text(text, encoding="utf-8", newline="\n")


def _pretty(value: Any) -> str:
    if isinstance(value, list):
        rows = ",\n".join(f"    {json.dumps(row)}" for row in value)
        return f"[\n{rows}\n  ]"
    return json.dumps(value)


if __name__ == "__main__":
    main()
