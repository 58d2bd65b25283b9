"""What is wrong with a database of signs, in the words of its users."""

from __future__ import annotations


class SignsError(Exception):
    """A request to a database of signs cannot be fulfilled; nothing of it was done.

    code: stable, as docs/language/errors.md lists it. remedy: what probably helps.
    """

    def __init__(self, code: str, message: str, remedy: str | None = None) -> None:
        super().__init__(message)
        self.code, self.message, self.remedy = code, message, remedy
