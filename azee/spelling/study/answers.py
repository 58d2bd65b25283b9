"""Answers, kept in one SQLite file: what a participant has sent is on disk before the next page."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from azee.spelling.study.design import Design
from azee.spelling.study.questions import Choice

_TABLES = """
CREATE TABLE IF NOT EXISTS study (design TEXT NOT NULL);

CREATE TABLE IF NOT EXISTS participant (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  key TEXT NOT NULL UNIQUE,
  age TEXT NOT NULL,
  fluency TEXT NOT NULL,
  name TEXT NOT NULL,
  mail TEXT NOT NULL,
  finished INTEGER NOT NULL DEFAULT 0
);

CREATE TABLE IF NOT EXISTS choice (
  participant INTEGER NOT NULL REFERENCES participant,
  page INTEGER NOT NULL,
  choice TEXT NOT NULL CHECK (choice IN ('first', 'second', 'none')),
  PRIMARY KEY (participant, page)
);

CREATE TABLE IF NOT EXISTS remark (
  participant INTEGER NOT NULL REFERENCES participant,
  question INTEGER NOT NULL,
  text TEXT NOT NULL,
  PRIMARY KEY (participant, question)
);
""".strip().split("\n\n")


class AnswersError(ValueError):
    """A file holds no answers, or those of another study."""


@dataclass(frozen=True, slots=True)
class Participant:
    """Who takes part. number: from 1. key: what the browser is known by."""

    number: int
    key: str
    age: str
    fluency: str
    finished: bool


class Answers:
    """The file of a study's answers.

    Every change is one transaction that is on disk when the method returns.
    """

    def __init__(self, path: Path, design: Design) -> None:
        self._path, self.design = path, design

    @classmethod
    def create(cls, path: str | Path, design: Design) -> Answers:
        """Make the file, or go on with the one that is there.

        Raises: AnswersError: it is something else, or belongs to another study. OSError.
        """
        answers = cls(Path(path), design)
        with answers._open() as database:
            for statement in _TABLES:
                database.execute(statement)
            known = database.execute("SELECT design FROM study").fetchone()
            if known is None:
                database.execute("INSERT INTO study VALUES (?)", (design.to_text(),))
            elif known[0] != design.to_text():
                raise AnswersError(
                    f"`{path}` holds answers to another study: types, words or seed differ"
                )
        return answers

    @classmethod
    def open(cls, path: str | Path) -> Answers:
        """Open the file of a study. Raises: AnswersError: it holds no answers. OSError."""
        with Path(path).open("rb"):
            pass  # SQLite would make a file that is not there
        answers = cls(Path(path), Design(("a", "b"), ("c", "d")))
        try:
            with answers._open() as database:
                row = database.execute("SELECT design FROM study").fetchone()
            return cls(Path(path), Design.from_text(row[0]))
        except (sqlite3.OperationalError, TypeError, KeyError, ValueError) as error:
            raise AnswersError(f"`{path}` holds no answers") from error

    @contextmanager
    def _open(self) -> Iterator[sqlite3.Connection]:
        try:
            database = sqlite3.connect(self._path, timeout=30)
        except sqlite3.Error as error:
            raise OSError(None, str(error), str(self._path)) from error
        try:
            database.execute("PRAGMA journal_mode = WAL")
            database.execute("PRAGMA synchronous = FULL")
            database.execute("PRAGMA foreign_keys = ON")
            with database:
                yield database
        except sqlite3.DatabaseError as error:
            if isinstance(error, sqlite3.OperationalError | sqlite3.IntegrityError):
                raise
            raise AnswersError(f"`{self._path}` holds no answers") from error
        finally:
            database.close()

    def begin(self, key: str, age: str, fluency: str, name: str, mail: str) -> Participant:
        """Take a participant in."""
        with self._open() as database:
            cursor = database.execute(
                "INSERT INTO participant (key, age, fluency, name, mail) VALUES (?, ?, ?, ?, ?)",
                (key, age, fluency, name, mail),
            )
            number = cursor.lastrowid
        assert number is not None
        return Participant(number, key, age, fluency, finished=False)

    def participant(self, key: str) -> Participant | None:
        """Return the participant with a key, if there is one."""
        return next((one for one in self.participants() if one.key == key), None)

    def participants(self) -> Sequence[Participant]:
        """Return all participants, in the order in which they came."""
        with self._open() as database:
            rows = database.execute(
                "SELECT number, key, age, fluency, finished FROM participant ORDER BY number"
            ).fetchall()
        return [
            Participant(number, key, age, fluency, bool(finished))
            for number, key, age, fluency, finished in rows
        ]

    def choose(self, participant: Participant, page: int, choice: Choice) -> None:
        """Keep the choice on a page, counted from 1; a later one replaces it."""
        with self._open() as database:
            database.execute(
                "INSERT INTO choice VALUES (?, ?, ?) "
                "ON CONFLICT (participant, page) DO UPDATE SET choice = excluded.choice",
                (participant.number, page, choice),
            )

    def choices(self, participant: Participant) -> Mapping[int, Choice]:
        """Return what a participant chose, by page."""
        with self._open() as database:
            return dict(
                database.execute(
                    "SELECT page, choice FROM choice WHERE participant = ? ORDER BY page",
                    (participant.number,),
                ).fetchall()
            )

    def finish(self, participant: Participant, remarks: Sequence[str]) -> None:
        """Keep the answers to the open questions, and that the participant is done."""
        with self._open() as database:
            database.executemany(
                "INSERT OR REPLACE INTO remark VALUES (?, ?, ?)",
                [(participant.number, i, text) for i, text in enumerate(remarks) if text],
            )
            database.execute(
                "UPDATE participant SET finished = 1 WHERE number = ?", (participant.number,)
            )

    def remarks(self) -> Sequence[tuple[int, int, str]]:
        """Return participant, question and answer of all open questions."""
        with self._open() as database:
            return database.execute(
                "SELECT participant, question, text FROM remark ORDER BY question, participant"
            ).fetchall()
