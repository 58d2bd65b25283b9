"""Texts that programs may put in the place that a diagnostic marks.

The remedy of a diagnostic is a sentence for people. Two kinds of it name what should stand in the
marked place: "did you mean `X` or `Y`?" and "write `X`", where a reason or a choice may follow.
"""

from __future__ import annotations

import re

from azee_grammar.diagnostic import Diagnostic

_MEANT = re.compile(r"did you mean (`[^`]+`(?: or `[^`]+`)*)\?")
_WRITE = re.compile(r"(?:`[^`]+` is a rule: )?write `([^`]+)`(?:[,;:] (?!or ).*)?")
_CODE = re.compile(r"`([^`]+)`")
_GAP = re.compile(r"…|\b[A-Z]{5}\b")
"""What the writer has to choose: `…`, or `BLOCK`."""


def fixes(diagnostic: Diagnostic) -> tuple[str, ...]:
    """Return texts for the marked place, the most probable first; none if there is no such text."""
    remedy = diagnostic.help or ""
    if diagnostic.span is None:
        return ()
    if meant := _MEANT.fullmatch(remedy):
        return tuple(_CODE.findall(meant[1]))
    written = _WRITE.fullmatch(remedy)
    if written is None or _GAP.search(written[1]):
        return ()
    return (written[1],)
