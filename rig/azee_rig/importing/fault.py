"""What keeps a body from being taken in."""

from __future__ import annotations

from azee_rig.load import RigError


class BodyError(RigError):
    """A body that cannot be taken in. Message, notes and help are for the user.

    code: `body-unreadable` (no glTF, or a damaged one), `body-unsupported` (sound, but needs what
    is not read here), `body-incomplete` (lacks what no signing body can lack) or `body-map` (the
    user's own bones-map does not fit).
    """

    def __init__(self, code: str, message: str, *notes: str, help_: str | None = None) -> None:
        super().__init__(message)
        self.code, self.message, self.notes, self.help = code, message, notes, help_


def unreadable(message: str, *notes: str) -> BodyError:
    """Fault of a file that is no glTF or breaks its rules."""
    return BodyError("body-unreadable", message, *notes)
