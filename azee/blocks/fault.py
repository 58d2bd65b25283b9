"""Why an edit cannot be made."""

from __future__ import annotations

from azee_grammar.diagnostic import Diagnostic


def cannot_edit(reason: str, text: str = "", advice: str | None = None) -> Diagnostic:
    """Return the message that an edit is impossible.

    Args: text: what was to be brought in.
    """
    shown = f": `{text.splitlines()[0][:60]}`" if text.strip() else ""
    return Diagnostic("cannot-edit", f"{reason}{shown}", None, help=advice)
