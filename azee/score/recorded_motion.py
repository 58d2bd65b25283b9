"""What a score knows of a recorded sign: its name, and who can play it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from azee.clip.clip import Clip
    from azee_rig.rig import Rig


class RecordingError(Exception):
    """A recorded sign cannot be had.

    code: stable, as docs/language/errors.md lists it. remedy: what probably helps.
    """

    def __init__(self, code: str, message: str, remedy: str | None = None) -> None:
        super().__init__(message)
        self.code, self.message, self.remedy = code, message, remedy


class RecordedMotion(Protocol):
    """The movement of a recorded sign. Two with the same digest are equal."""

    @property
    def name(self) -> str:
        """The sign's name, with language and variant where it has any."""

    @property
    def digest(self) -> str:
        """SHA-256 of what is played."""

    def clip(self, rig: Rig) -> Clip:
        """Return it on a body, its frames counted from 0. Raises: RecordingError."""
