"""The error of a command that is impossible."""

from __future__ import annotations


class Refusal(Exception):  # noqa: N818 - no error of ours: the user is told
    """A command that cannot be carried out, with what to do instead."""

    def __init__(self, message: str, hint: str | None = None) -> None:
        super().__init__(message)
        self.message, self.hint = message, hint
