"""What was typed, kept beside the files: drafts that are not saved yet, and earlier versions.

One SQLite file for a folder. What a method was given is in the file when it returns, so that
neither a killed server nor a killed browser loses more than what was not sent yet.
"""

from __future__ import annotations

import sqlite3
import threading
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

EVERY_S = 60
"""While someone types, a version is kept this often; every saved text is one too."""
MOST_VERSIONS = 500
"""Of one file; older ones go."""
_TABLES = """
CREATE TABLE IF NOT EXISTS draft (
  file TEXT PRIMARY KEY, text TEXT NOT NULL, digest TEXT, at REAL NOT NULL);
CREATE TABLE IF NOT EXISTS version (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  file TEXT NOT NULL, text TEXT NOT NULL, at REAL NOT NULL, saved INTEGER NOT NULL);
CREATE INDEX IF NOT EXISTS version_file ON version (file, number);
"""


@dataclass(frozen=True, slots=True)
class Draft:
    """A text that is not in its file. digest: of the file it was made of. at: seconds, epoch."""

    text: str
    digest: str | None
    at: float


@dataclass(frozen=True, slots=True)
class Version:
    """An earlier text, without the text itself. characters: how long it is."""

    number: int
    at: float
    saved: bool
    characters: int


class History:
    """Drafts and versions of the texts of one folder. Several threads may use it.

    Args: path: the SQLite file; made with its folder where there is none.
    Raises: OSError: it cannot be made, or is something else.
    """

    def __init__(self, path: Path) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        self._lock = threading.Lock()
        try:
            self._database = sqlite3.connect(path, timeout=10, check_same_thread=False)
            try:
                self._database.execute("PRAGMA journal_mode = WAL")
                self._database.execute("PRAGMA synchronous = NORMAL")
                self._database.executescript(_TABLES)
            except BaseException:
                self._database.close()
                raise
        except sqlite3.Error as error:
            raise OSError(None, str(error), str(path)) from error

    def close(self) -> None:
        """Close the file."""
        with self._lock:
            self._database.close()

    def keep(self, file: str, text: str, digest: str | None, at: float) -> None:
        """Keep a draft; once a minute it becomes a version too."""
        with self._lock, self._database as database:
            database.execute(
                "INSERT OR REPLACE INTO draft VALUES (?, ?, ?, ?)", (file, text, digest, at)
            )
            last = database.execute(
                "SELECT at, text FROM version WHERE file = ? ORDER BY number DESC LIMIT 1", (file,)
            ).fetchone()
            if last is None or (at - last[0] >= EVERY_S and last[1] != text):
                self._add(file, text, at, saved=False)

    def saved(self, file: str, text: str, at: float) -> None:
        """Keep a saved text as a version; its draft goes."""
        with self._lock, self._database as database:
            database.execute("DELETE FROM draft WHERE file = ?", (file,))
            self._add(file, text, at, saved=True)

    def _add(self, file: str, text: str, at: float, *, saved: bool) -> None:
        self._database.execute(
            "INSERT INTO version (file, text, at, saved) VALUES (?, ?, ?, ?)",
            (file, text, at, int(saved)),
        )
        self._database.execute(
            "DELETE FROM version WHERE file = ? AND number NOT IN "
            "(SELECT number FROM version WHERE file = ? ORDER BY number DESC LIMIT ?)",
            (file, file, MOST_VERSIONS),
        )

    def drop(self, file: str) -> None:
        """Forget the draft of a file."""
        with self._lock, self._database as database:
            database.execute("DELETE FROM draft WHERE file = ?", (file,))

    def draft(self, file: str) -> Draft | None:
        """Return the draft of a file, if there is one."""
        with self._lock:
            row = self._database.execute(
                "SELECT text, digest, at FROM draft WHERE file = ?", (file,)
            ).fetchone()
        return Draft(*row) if row else None

    def drafts(self) -> Sequence[str]:
        """Return the names of all files with drafts."""
        with self._lock:
            rows = self._database.execute("SELECT file FROM draft ORDER BY file").fetchall()
        return [name for (name,) in rows]

    def versions(self, file: str) -> Sequence[Version]:
        """Return the versions of a file, the newest first."""
        with self._lock:
            rows = self._database.execute(
                "SELECT number, at, saved, length(text) FROM version "
                "WHERE file = ? ORDER BY number DESC",
                (file,),
            ).fetchall()
        return [Version(number, at, bool(saved), length) for number, at, saved, length in rows]

    def version(self, file: str, number: int) -> str | None:
        """Return the text of a version."""
        with self._lock:
            row = self._database.execute(
                "SELECT text FROM version WHERE file = ? AND number = ?", (file, number)
            ).fetchone()
        return row[0] if row else None
