"""The exceptions that carry diagnostics during evaluation."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from azee_grammar.diagnostic import AZeeError, Diagnostic, Related
from azee_grammar.nearest import nearest
from azee_grammar.source import Span


class Fault(AZeeError):  # noqa: N818 - the text's, not ours
    """Evaluation stops here. Siblings are still evaluated, so that their faults are found too.

    Without diagnostics, it means that the mistake was reported before.
    """

    def through(self, rule: str, span: Span) -> Fault:
        """Return it with one more rule call on the stack of every diagnostic."""
        call = Related(f"while evaluating {rule}, called", span)
        return type(self)(*(replace(d, related=(*d.related, call)) for d in self.diagnostics))


class Exhausted(Fault):
    """A limit is exceeded: evaluation of the whole utterance ends at once."""


def fault(
    code: str,
    message: str,
    span: Span,
    *,
    label: str = "",
    help: str | None = None,  # noqa: A002 - the word of the diagnostic
    notes: tuple[str, ...] = (),
) -> Fault:
    """Return a fault with one diagnostic."""
    return Fault(Diagnostic(code, message, span, label=label, notes=notes, help=help))


def together(faults: Sequence[Fault]) -> Fault:
    """Return one fault with the diagnostics of all, each once.

    A rule that is applied twice has the same mistake twice. Reported each time, its messages would
    double with every rule around it.
    """
    distinct: dict[tuple[str, str, Span | None], Diagnostic] = {}
    for problem in faults:
        for diagnostic in problem.diagnostics:
            key = (diagnostic.code, diagnostic.message, diagnostic.span)
            distinct.setdefault(key, diagnostic)
    return Fault(*distinct.values())


def did_you_mean(name: str, known: Iterable[str], sigil: str = "") -> str | None:
    """Return a help line with the nearest known names, or none if none is near."""
    found = [f"`{sigil}{candidate}`" for candidate in nearest(name, dict.fromkeys(known))]
    if not found:
        return None
    return f"did you mean {' or '.join(found)}?"
