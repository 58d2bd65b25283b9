"""Why a body cannot be posed, or a posture not be written."""

from __future__ import annotations

from azee_grammar.diagnostic import Diagnostic


def cannot_pose(reason: str, advice: str | None = None) -> Diagnostic:
    """Return the message that something about a drag is impossible."""
    return Diagnostic("cannot-pose", reason, None, help=advice)
