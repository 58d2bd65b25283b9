"""The LALR(1) automaton that azee.lark describes, with recovery line by line."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import compress
from typing import Any

from azee_grammar.tables import Production, State, tables
from azee_grammar.token import BAD, Token

END = "$END"


class UnparsableError(Exception):
    """The item cannot be parsed; all its mistakes have been reported."""


class _Parts(list[Any]):
    """What a rule passes to the rule that contains it; the values may be parts again."""


class Automaton:
    """Parses the tokens of one item; `builder` makes its nodes, `mistaken` receives its mistakes.

    After a mistake, the line is skipped together with its deeper lines, and the grammar's BROKEN
    takes its place. For this, the state before each line is kept. So each wrong line is reported
    once, and no line is reported because of a mistake in another.
    """

    def __init__(
        self, tokens: Sequence[Token], builder: object, mistaken: Callable[[int, State], None]
    ) -> None:
        self._table = tables()
        self._tokens = tokens
        self._builder = builder
        self._mistaken = mistaken
        self._end = -1
        self._states: list[int] = []
        self._values: list[Any] = []

    def run(self, start: str) -> Any:
        """Return the value of a start symbol of the grammar.

        Raises: UnparsableError: a mistake is in a line that BROKEN cannot replace.
        """
        self._end = self._table.ends[start]
        self._states, self._values = [self._table.starts[start]], []
        tokens = self._tokens
        before_line = (list(self._states), list(self._values))
        at = 0
        line_begins = True
        while at < len(tokens):
            token = tokens[at]
            if line_begins and token.kind not in ("_INDENT", "_DEDENT"):
                before_line = (list(self._states), list(self._values))
                line_begins = False
            if self._feed(token):
                line_begins = line_begins or token.kind in ("_NEWLINE", "_INDENT", "_DEDENT")
                at += 1
                continue
            if token.kind != BAD:
                self._mistaken(at, self._table.states[self._states[-1]])
            if token.kind == "_DEDENT":
                raise UnparsableError
            if token.kind == "_INDENT":
                at = self._after_block(at)
            else:
                self._states, self._values = before_line
                at = self._after_line(at)
                if not self._feed(Token("BROKEN", token.start, token.start)):
                    raise UnparsableError
            line_begins = True
        end = tokens[-1].end
        if not self._feed(Token(END, end, end)):
            self._mistaken(len(tokens), self._table.states[self._states[-1]])
            raise UnparsableError
        return self._values[-1]

    def _feed(self, token: Token) -> bool:
        """Reduce as far as a token allows, then shift it; False if the grammar does not allow it.

        The end of the item is not shifted: it is accepted once the start symbol is reduced.
        """
        table = self._table
        states, values = self._states, self._values
        kind = token.kind
        while True:
            if kind == END and states[-1] == self._end:
                return True
            action = table.states[states[-1]].get(kind)
            if action is None:
                return False
            if action >= 0:
                states.append(action)
                values.append(token)
                return True
            rule = table.productions[-1 - action]
            size = rule.size
            if rule.unit and (rule.action is None or not isinstance(values[-1], _Parts)):
                states[-1] = table.states[states[-2]][rule.origin]
                continue
            value = self._reduce(rule, values[-size:])
            del states[-size:]
            del values[-size:]
            states.append(table.states[states[-1]][rule.origin])
            values.append(value)

    def _reduce(self, rule: Production, values: list[Any]) -> Any:
        parts = _Parts(compress(values, rule.keep))
        if rule.action is None:
            return parts
        flat = _flat(parts)
        if rule.expand and len(flat) == 1:
            return flat[0]
        return getattr(self._builder, rule.action)(flat)

    def _after_line(self, at: int) -> int:
        """Return the index after the line of a token and its deeper lines."""
        tokens = self._tokens
        while at < len(tokens) and tokens[at].kind != "_NEWLINE":
            at += 1
        at += 1
        if at < len(tokens) and tokens[at].kind == "_INDENT":
            return self._after_block(at)
        return at

    def _after_block(self, at: int) -> int:
        """Return the index after the DEDENT that belongs to the INDENT at an index."""
        depth = 0
        while at < len(self._tokens):
            kind = self._tokens[at].kind
            depth += (kind == "_INDENT") - (kind == "_DEDENT")
            at += 1
            if depth == 0:
                break
        return at


def _flat(parts: _Parts) -> list[Any]:
    """Unfold parts of parts, without recursion: a repetition of n parts is n deep on its left."""
    if _Parts not in map(type, parts):
        return parts
    out: list[Any] = []
    stack: list[Any] = [parts]
    while stack:
        part = stack.pop()
        if isinstance(part, _Parts):
            stack.extend(reversed(part))
        else:
            out.append(part)
    return out
