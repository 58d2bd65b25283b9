"""What must hold of any bytes whatever; the fuzzer looks for some of which it does not."""

from __future__ import annotations

from collections.abc import Iterable

from azee.lang.machine import Limits
from azee.lang.program import load
from azee.lang.template import Template
from azee_grammar.diagnostic import AZeeError, Diagnostic, Severity
from azee_grammar.files import decode
from azee_grammar.format import format_file
from azee_grammar.parser import parse, parse_expression
from azee_grammar.render import render, to_json
from azee_grammar.source import Source
from azee_grammar.syntax import Utterance

SMALL = Limits(depth=40, steps=5_000, size=2_000)
"""So small that no text takes long, and so large that the examples run."""


def examine(data: bytes) -> None:
    """Read, lay out, search, check and evaluate; raises where anything but a diagnostic comes."""
    try:
        source = decode(data, "fuzz.azee")
    except AZeeError as error:
        _show(error.diagnostics)
        return
    _layout_keeps_the_tree(source)
    _show(parse_expression(source, template=True)[1])
    program = load(source, limits=SMALL)
    for item in program.file.items:
        if isinstance(item, Utterance):
            match = Template(item.expr).match(item.expr, program.scope)
            assert match is not None, f"{item.expr.span.text!r} does not match itself"
    found = program.check()
    _show(found)
    if not any(d.severity is Severity.ERROR for d in found):
        assert all(utterance.score.duration >= 0 for utterance in program.utterances)


def _layout_keeps_the_tree(source: Source) -> None:
    parsed = parse(source, template=True)
    _show(parsed.diagnostics)
    if parsed.diagnostics:
        return
    for published in (False, True):
        once = Source("formatted", format_file(source, published=published))
        again = parse(once, template=True)
        assert not again.diagnostics, f"{once.text!r} is no longer AZee"
        if not published:
            assert again.file == parsed.file, f"{once.text!r} says something else"
        assert format_file(once, published=published) == once.text, f"{once.text!r} goes on moving"


def _show(diagnostics: Iterable[Diagnostic]) -> None:
    for diagnostic in diagnostics:
        render(diagnostic)
        to_json(diagnostic)
