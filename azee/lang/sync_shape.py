"""The structure of a `sync` in the text: blocks, rule words, numbers of operands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from azee.lang.fault import did_you_mean
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.syntax import Application, Expr, Symbol

PATTERN = "sync 'NAME SCORE 'NAME SCORE 'RULE OPERAND … …"


@dataclass(frozen=True, slots=True)
class SyncRule:
    """How a block is placed: the rule word and its operands."""

    word: str
    operands: tuple[str, ...]
    """Each `start` or `end` (a ref), `duration` (a number) or `block` (a name)."""
    meaning: str
    published: bool = False


RULES: Mapping[str, SyncRule] = {
    rule.word: rule
    for rule in (
        SyncRule("start/end", ("start", "end"), "stretched between the two", published=True),
        SyncRule("start", ("start",), "starts there, natural length"),
        SyncRule("end", ("end",), "ends there, natural length"),
        SyncRule("start/dur", ("start", "duration"), "starts there and lasts that many seconds"),
        SyncRule("end/dur", ("end", "duration"), "ends there and lasts that many seconds"),
        SyncRule("with", ("block",), "the bounds of that block"),
    )
}


class ShapeReader:
    """Reads the operands of a `sync` from left to right."""

    def __init__(self, expr: Application, operands: tuple[Expr, ...]) -> None:
        self._head = expr.head.span
        self._operands = operands
        self._at = 0
        self.problems: list[Diagnostic] = []
        self.cut_short: Expr | None = None
        """A score whose operands stand beside it instead of inside it."""

    def blocks(self) -> list[tuple[Symbol, Expr, SyncRule | None, tuple[Expr, ...]]]:
        """Return name, score, rule and the rule's operands for each block; stop at a mistake."""
        found: list[tuple[Symbol, Expr, SyncRule | None, tuple[Expr, ...]]] = []
        if not self._operands:
            message = "`sync` lacks its blocks"
            hint = f"it is written `{PATTERN}`"
            self.problems.append(Diagnostic("missing-argument", message, self._head, help=hint))
        while self._at < len(self._operands) and not self.problems:
            name = self._name(first=not found)
            score = self._score(name) if name else None
            if name is None or score is None:
                break
            if not found:
                found.append((name, score, None, ()))
                continue
            rule = self._rule(name)
            if rule is None:
                break
            count = len(rule.operands)
            operands = self._operands[self._at : self._at + count]
            if len(operands) < count:
                message = f"the rule `'{rule.word}` of `{name.name}` takes {_counted(rule)}"
                self._problem("missing-argument", message, name)
                break
            self._at += count
            found.append((name, score, rule, operands))
        return found

    def _name(self, first: bool) -> Symbol | None:
        name = self._operands[self._at]
        if not isinstance(name, Symbol):
            message = "the name of a block, such as `'SIG`, is expected here"
            self.problems.append(Diagnostic("bad-block-name", message, name.span))
            return None
        if name.name in RULES:
            message = f"`'{name.name}` is a rule; the name of a block is expected here"
            if not first and self._at == 2:
                message = "the first block of a `sync` takes no rule: the others are placed by it"
            self._problem("bad-block-name", message, name)
            return None
        if ":" in name.name or "/" in name.name:
            message = f"a block cannot be called `{name.name}`: `:` and `/` have a meaning in refs"
            self._problem("bad-block-name", message, name)
            return None
        self._at += 1
        return name

    def _score(self, name: Symbol) -> Expr | None:
        if self._at >= len(self._operands):
            self._problem("missing-value", f"the block `{name.name}` has no score", name)
            return None
        self._at += 1
        return self._operands[self._at - 1]

    def _rule(self, name: Symbol) -> SyncRule | None:
        listed = ", ".join(f"`'{word}`" for word in RULES)
        score = self._operands[self._at - 1]
        if self._at >= len(self._operands):
            message = f"the block `{name.name}` has no rule that says when it stands"
            self._problem("missing-argument", message, name, f"the rules are {listed}")
            return None
        word = self._operands[self._at]
        if isinstance(word, Symbol) and word.name in RULES:
            self._at += 1
            return RULES[word.name]
        if isinstance(word, Symbol):
            message = f"there is no sync rule `'{word.name}`"
            hint = did_you_mean(word.name, tuple(RULES), "'") or f"the rules are {listed}"
        elif isinstance(score, Application) and not score.operands and not score.called:
            self.cut_short = score
            message = f"this does not belong to `{score.span.text}`"
            hint = (
                f"after the name of a block write `{score.span.text}(…)` with commas, or the "
                "operands one level deeper"
            )
        else:
            message = f"the rule of the block `{name.name}` is expected here"
            hint = f"the rules are {listed}"
        self.problems.append(Diagnostic("unknown-sync-rule", message, word.span, help=hint))
        return None

    def _problem(self, code: str, message: str, at: Symbol, hint: str | None = None) -> None:
        self.problems.append(Diagnostic(code, message, at.span, help=hint))


def _counted(rule: SyncRule) -> str:
    words = {"start": "a ref", "end": "a ref", "duration": "a duration", "block": "a block"}
    return " and ".join(words[role] for role in rule.operands)
