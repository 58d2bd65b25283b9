"""Reads HamNoSys: a sign from its symbols, or a diagnostic that marks the first one amiss."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedInput, VisitError

from azee.lexicon.hamnosys_builder import Builder
from azee.lexicon.hamnosys_symbols import NAMES, NOT_READ, is_symbol, title
from azee.lexicon.model import Manual, NotationFault, Sign
from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.source import Source, Span

MOST_SYMBOLS = 300
"""The most symbols of a sign; more are no notation of one."""
_PLAIN = frozenset(" \t\r\n,.!?;{}|\u200b\ufeff")
"""Punctuation, which has no meaning for the form of a sign."""


def is_hamnosys(text: str) -> bool:
    """Whether a text has symbols of HamNoSys."""
    return any(is_symbol(c) for c in text)


def read_symbols(text: str, gloss: str) -> Sign:
    """Read the symbols of one sign.

    Raises: AZeeError: bad-hamnosys, with the place in a text of the symbols' names.
    """
    faults: dict[NotationFault, None] = {}
    symbols = []
    for character in text:
        if character in NAMES and NAMES[character] not in NOT_READ:
            symbols.append(character)
        elif character not in _PLAIN:
            detail = (
                f"`{title(character)}` is not read"
                if is_symbol(character)
                else (f"`{character}` is no symbol of HamNoSys")
            )
            faults[NotationFault("not-read", detail)] = None
    if not symbols:
        message = f"`{gloss}` has no symbols of HamNoSys"
        raise AZeeError(Diagnostic("bad-hamnosys", message, None))
    if len(symbols) > MOST_SYMBOLS:
        message = f"`{gloss}` has {len(symbols)} symbols; a sign has no more than {MOST_SYMBOLS}"
        raise AZeeError(Diagnostic("size-limit", message, None))
    manual = _manual("".join(symbols), gloss)
    return Sign(gloss, (manual,), faults=tuple(faults))


def _manual(symbols: str, gloss: str) -> Manual:
    try:
        tree: Tree[Token] = _parser().parse(symbols)
    except UnexpectedInput as problem:
        at = getattr(problem, "pos_in_stream", None)
        if not isinstance(at, int) or at < 0:
            at = len(symbols)
        raise AZeeError(_amiss(symbols, at, gloss)) from None
    try:
        manual = Builder().transform(tree)
    except VisitError as problem:  # only a fault of ours
        raise problem.orig_exc from None
    assert isinstance(manual, Manual)
    return manual


def _amiss(symbols: str, at: int, gloss: str) -> Diagnostic:
    """Mark a symbol in the names of all."""
    names = [title(symbol) for symbol in symbols]
    source = Source(gloss, " ".join(names))
    starts = [sum(len(name) + 1 for name in names[:i]) for i in range(len(names) + 1)]
    if at >= len(names):
        end = len(source.text)
        return Diagnostic(
            "bad-hamnosys",
            f"the notation of `{gloss}` ends before it is complete",
            Span(source, end, end),
        )
    return Diagnostic(
        "bad-hamnosys",
        f"`{names[at]}` cannot stand here in the notation of `{gloss}`",
        Span(source, starts[at], starts[at] + len(names[at])),
    )


@cache
def _parser() -> Lark:
    """Return the parser. Brackets open hands, places and movements alike, so it is Earley's."""
    grammar = (Path(__file__).parent / "hamnosys.lark").read_text(encoding="utf-8")
    return Lark(grammar, parser="earley", lexer="basic", propagate_positions=False)
