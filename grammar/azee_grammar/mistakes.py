"""Messages for words that the grammar does not allow at their place."""

from __future__ import annotations

from collections.abc import Sequence

from azee_grammar.diagnostic import Diagnostic, Related
from azee_grammar.misspelt import decimal_comma, shortened
from azee_grammar.source import Source, Span
from azee_grammar.tables import State
from azee_grammar.token import HEADS, Token

_LAYOUT = frozenset({"_NEWLINE", "_INDENT", "_DEDENT"})
_ATOMS = frozenset({"NUMBER", "TEXT", "SYMBOL", "PARAMETER", "HOLE", "SIDE"})
_OPERANDS = HEADS | _ATOMS | {"_OPEN"}
_KIND = {
    "NUMBER": "the number",
    "TEXT": "the text",
    "SYMBOL": "the symbol",
    "PARAMETER": "the parameter",
    "HOLE": "the hole",
    "SIDE": "the side",
}


class Mistakes:
    """Explains the mistakes in the tokens of one item."""

    def __init__(self, source: Source, tokens: Sequence[Token]) -> None:
        self._source = source
        self._tokens = tokens
        self._frame_is_wrong = False

    def at(self, index: int, state: State) -> Diagnostic | None:
        """Explain why the token at an index cannot follow the tokens before it.

        `state` is that of the automaton; its keys are the tokens that could follow. Returns: None
        if an earlier mistake is the likely reason.
        """
        if self._tokens[0].kind == "DEF" and (found := self._in_definition(index, state)):
            follows = self._frame_is_wrong and found.code == "syntax"
            self._frame_is_wrong = True
            return None if follows else found
        if self._tokens[0].kind == "USE":
            return self._in_use(index)
        token = self._tokens[index]
        explain = {
            "_INDENT": self._deeper,
            "_CALL": self._called,
            "_COMMA": self._comma,
            "_EQUALS": self._equals,
            "CLOSE": self._close,
            "USE": self._keyword,
            "DEF": self._keyword,
        }.get(token.kind, self._follows)
        return explain(index)

    # Words after something complete

    def _follows(self, index: int) -> Diagnostic:
        """Report a word after something that takes no operands."""
        token, before = self._tokens[index], self._tokens[index - 1]
        if self._inside_call(index):
            return Diagnostic(
                "syntax",
                f"a comma is missing before `{self._shown(token)}`",
                self._span(token),
                help="the operands of a call are separated by commas",
            )
        if before.kind == "SYMBOL":
            return self._takes_none(
                index,
                label="nothing may follow it here",
                advice="an utterance is one expression: is the line of its rule missing above?"
                if self._is_first_line(index)
                else "in parentheses a single expression stands",
            )
        return self._takes_none(index, label="nothing may follow on its line")

    def _deeper(self, index: int) -> Diagnostic:
        """Report deeper lines below a line that takes none."""
        last = self._tokens[index - 2]  # the word before NEWLINE
        first = next(t for t in self._tokens[index:] if t.kind not in _LAYOUT)
        complete, help_ = self._complete(index - 2)
        if last.kind == "SYMBOL":
            help_ = (
                f"write the value of `{self._shown(last)}` behind it, "
                "or on the next line with the same indentation"
            )
        return Diagnostic(
            "takes-no-operands",
            f"{complete} takes no operands",
            self._span(first),
            label="this line is indented below it",
            help=help_,
            related=(Related(f"{complete} stands", self._span(last)),),
        )

    def _called(self, index: int) -> Diagnostic:
        """Report a parenthesis directly behind something that cannot be called."""
        complete, help_ = self._complete(index - 1)
        before = self._tokens[index - 1]
        if before.kind == "PARAMETER":
            help_ = f"`apply {self._shown(before)}` applies the rule that a parameter holds"
        elif before.kind in _ATOMS:
            help_ = "a space before the parenthesis makes it an operand of its own"
        return Diagnostic(
            "takes-no-operands",
            f"{complete} takes no operands",
            self._span(self._tokens[index]),
            label="this parenthesis opens a call",
            help=help_,
        )

    def _takes_none(self, index: int, *, label: str, advice: str | None = None) -> Diagnostic:
        complete, hint = self._complete(index - 1)
        return Diagnostic(
            "takes-no-operands",
            f"{complete} takes no operands",
            self._span(self._tokens[index]),
            label=label,
            help=advice or hint,
        )

    def _complete(self, index: int) -> tuple[str, str]:
        """Describe the complete expression that ends at an index, and how to continue it."""
        token = self._tokens[index]
        if token.kind != "CLOSE":
            shown = self._shown(token)
            return f"{_KIND[token.kind]} `{shown}`", "give it a line of its own below this one"
        opened = self._opening(index)
        if self._tokens[opened].kind == "_CALL":
            head = self._shown(self._tokens[opened - 1])
            return (
                f"the complete call `{head}(…)`",
                "write all operands between the parentheses, or all of them without any",
            )
        return (
            "an expression in parentheses",
            "write what belongs to it between the parentheses",
        )

    # Punctuation

    def _comma(self, index: int) -> Diagnostic:
        tokens = self._tokens
        before, comma, after = tokens[index - 1], tokens[index], tokens[index + 1]
        if before.kind == "_EQUALS":
            return self._no_value(index)
        if before.kind in ("_CALL", "_COMMA"):
            return Diagnostic(
                "syntax", "an operand is missing before this comma", self._span(comma)
            )
        if (
            before.kind == after.kind == "NUMBER"
            and before.end == comma.start
            and comma.end == after.start
        ):
            return decimal_comma(Span(self._source, before.start, after.end))
        if self._inside(index) is not None:
            return Diagnostic(
                "syntax",
                "these parentheses hold one expression, without a comma",
                self._span(comma),
                help="a call opens its parenthesis directly behind a name, "
                "as in `list(a, b)`; operands without one are separated by spaces",
            )
        return Diagnostic(
            "syntax",
            "a comma stands only between the operands of a call",
            self._span(comma),
            help="outside of parentheses operands are separated by spaces, or stand on lines of "
            "their own",
        )

    def _equals(self, index: int) -> Diagnostic:
        tokens = self._tokens
        span = self._span(tokens[index])
        before = tokens[index - 1]
        message = "`=` stands only between the name of an argument and its value, inside a call"
        if self._inside_call(index) and before.kind == "OPERATOR":
            return Diagnostic(
                "syntax",
                "the name of an argument begins with an apostrophe",
                self._span(before),
                help=f"write `'{before.text} = …`",
            )
        if before.kind == "SYMBOL" and self._inside(index) is None:
            return Diagnostic(
                "syntax", message, span, help="here the value follows its name without `=`"
            )
        return Diagnostic("syntax", message, span)

    def _close(self, index: int) -> Diagnostic:
        before = self._tokens[index - 1]
        if before.kind == "_EQUALS":
            return self._no_value(index)
        if before.kind == "_COMMA":
            return Diagnostic(
                "syntax", "an operand is missing after this comma", self._span(before)
            )
        return Diagnostic(
            "syntax",
            "these parentheses hold nothing",
            self._span(before).to(self._span(self._tokens[index])),
            help="a call without operands has no space before its parentheses, as in `tree()`",
        )

    def _no_value(self, index: int) -> Diagnostic:
        name = self._tokens[index - 2]
        return Diagnostic(
            "missing-value",
            f"the argument `{self._shown(name)}` has no value",
            self._span(name).to(self._span(self._tokens[index - 1])),
            label="nothing follows the `=`",
        )

    # Items

    def _keyword(self, index: int) -> Diagnostic:
        token = self._tokens[index]
        return Diagnostic(
            "syntax",
            f"`{token.text}` stands only at the start of a line without indentation",
            self._span(token),
            help=f"a rule of that name is applied as `:{token.text}`",
        )

    def _in_use(self, index: int) -> Diagnostic:
        token, use = self._tokens[index], self._tokens[0]
        if index > 1 and self._tokens[1].kind == "SYMBOL":
            first = next(t for t in self._tokens[index:] if t.kind not in _LAYOUT)
            return Diagnostic(
                "syntax",
                "`use` takes one library",
                self._span(first),
                label="nothing may follow it",
                help="write one `use` line for each library",
            )
        if token.kind == "_NEWLINE":
            return Diagnostic(
                "syntax", "`use` names no library", self._span(use), help="write `use 'lsf`"
            )
        name = token.text if token.kind in HEADS | {"TEXT", "PARAMETER"} else "lsf"
        return Diagnostic(
            "syntax",
            "the name of a library begins with an apostrophe",
            self._span(token),
            help=f"write `'{name}`",
        )

    def _in_definition(self, index: int, state: State) -> Diagnostic | None:
        """Explain a mistake in a definition: entries, then one body."""
        name = self._tokens[1]
        if index == len(self._tokens) or self._tokens[index].kind == "_DEDENT":
            return Diagnostic(
                "syntax",
                f"the definition of `{shortened(name.text)}` has no body",
                self._span(name),
                help="write its expression below it, indented; parameters are declared by `azop`",
            )
        token, before = self._tokens[index], self._tokens[index - 1]
        if set(state) == {"_DEDENT"}:
            return Diagnostic(
                "syntax",
                f"the body of `{shortened(name.text)}` is already complete",
                self._span(token),
                label="this would be a second one",
                help="a definition has one body; `sync` and `seq` join scores",
            )
        if "TEXT" in state and not state.keys() & {"NUMBER", "OPERATOR"}:
            symbol = before if before.kind == "SYMBOL" else self._tokens[index - 2]
            return Diagnostic(
                "missing-value",
                f"`{self._shown(symbol)}` is not followed by a text",
                self._span(symbol),
                help='before the body of a definition stand entries such as `\'meaning "…"`; '
                "arguments are declared below `azop`",
            )
        return None

    # Reading the tokens around the mistake

    def _inside(self, index: int) -> int | None:
        """Return the index of the innermost parenthesis open before an index, on its line."""
        depth = 0
        for at in range(index - 1, -1, -1):
            kind = self._tokens[at].kind
            if kind == "CLOSE":
                depth += 1
            elif kind in ("_OPEN", "_CALL"):
                if depth == 0:
                    return at
                depth -= 1
            elif kind in _LAYOUT:
                return None
        return None

    def _inside_call(self, index: int) -> bool:
        opened = self._inside(index)
        return opened is not None and self._tokens[opened].kind == "_CALL"

    def _opening(self, close: int) -> int:
        opened = self._inside(close)
        return 0 if opened is None else opened

    def _is_first_line(self, index: int) -> bool:
        return all(t.kind not in _LAYOUT for t in self._tokens[:index]) and (
            self._inside(index) is None
        )

    def _shown(self, token: Token) -> str:
        return shortened(self._source.text[token.start : token.end])

    def _span(self, token: Token) -> Span:
        return Span(self._source, token.start, token.end)


def hole_outside_template(span: Span) -> Diagnostic:
    """Report `?name` in a text that is not a template."""
    return Diagnostic(
        "template-hole",
        f"`{shortened(span.text)}` is a hole, and this text is not a template",
        span,
        help="holes stand in the templates of `azee find`; a parameter is written "
        f"`^{shortened(span.text[1:])}`",
    )


def more_than_one(span: Span) -> Diagnostic:
    """Report a second item where one expression is expected."""
    return Diagnostic(
        "syntax",
        "a second expression begins here, where only one is wanted",
        span,
        help="indent the line if it belongs to the expression above",
    )


def no_expression(word: Span, name: str) -> Diagnostic:
    """Report a definition or `use`, with what it names, where an expression is expected."""
    if word.text.startswith("use"):
        message = "`use` is no expression: it brings a library into the scope of a text"
        line = f"use {name}" if name.startswith("'") else f"use '{name or 'lsf'}"
        hint = f"write `{line}` in a file, and give the file beside the expression"
    else:
        message = "`def` is no expression: it defines a rule in a text"
        hint = "write the definition in a file, and give the file beside the expression"
        if name:
            hint += f" `:{name}`"
    return Diagnostic("syntax", message, word, help=hint)


def too_many(span: Span, most: int) -> Diagnostic:
    """Report a text that seems not to be AZee."""
    return Diagnostic(
        "size-limit",
        f"this text has more than {most:,} mistakes; the rest of it is not read",
        span,
    )


def nothing_here(span: Span) -> Diagnostic:
    """Report an empty expression."""
    return Diagnostic("syntax", "there is no expression in this text", span)
