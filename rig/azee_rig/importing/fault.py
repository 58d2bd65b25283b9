"""The error of a body that cannot be imported."""

from __future__ import annotations

from azee_rig.load import RigError


class BodyError(RigError):
    """A body cannot be imported. Message, notes and help are for the user.

    code: `body-unreadable` (not glTF, or damaged), `body-unsupported` (not damaged, but it needs
        something unsupported), `body-incomplete` (lacks a mandatory part) or `body-map` (the user's
        own bones-map does not fit).
    """

    def __init__(self, code: str, message: str, *notes: str, help_: str | None = None) -> None:
        super().__init__(message)
        self.code, self.message, self.notes, self.help = code, message, notes, help_


def unreadable(message: str, *notes: str) -> BodyError:
    """Return the fault of a file that is not glTF or breaks its rules."""
    return BodyError("body-unreadable", message, *notes)
