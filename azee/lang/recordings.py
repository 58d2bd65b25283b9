"""Where a text finds the recorded signs that it names."""

from __future__ import annotations

from typing import Protocol

from azee.score.score import Recorded


class Recordings(Protocol):
    """Recorded signs by name, such as those of a database."""

    def find(self, name: str, language: str | None, variant: str | None) -> Recorded:
        """Return the one sign that is meant, as long as it was recorded.

        Raises: RecordingError: there is none, several are meant, or they cannot be read.
        """
