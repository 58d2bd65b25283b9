"""A connection to SQLite or PostgreSQL, its transactions, and its errors in words.

SQLite keeps one file with a write-ahead log (WAL): readers never wait for a writer, and a
transaction is on the disk before it counts as done (synchronous = FULL). A transaction that writes
says so at once (BEGIN IMMEDIATE), so that two writers wait for each other and never fail half-way.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from json import JSONDecodeError
from pathlib import Path
from typing import Any

from sqlalchemy import URL, Connection, Engine, create_engine, event, make_url
from sqlalchemy.exc import ArgumentError, DBAPIError, NoSuchModuleError

from azee.signs.fault import SignsError

WAIT_S = 30.0
"""For how long a writer waits for another."""
_FULL = ("SQLITE_FULL", "53100", "SQLITE_IOERR_WRITE")
_READ_ONLY = ("SQLITE_READONLY", "SQLITE_PERM", "25006", "42501")
_DAMAGED = ("SQLITE_CORRUPT", "XX001", "XX002")
_NO_DATABASE = ("SQLITE_NOTADB",)
_BUSY = ("SQLITE_BUSY", "SQLITE_LOCKED", "55P03")
_UNREACHABLE = ("SQLITE_CANTOPEN", "08", "28", "3D000", "57P")


def place_of(database: str) -> URL:
    """Return where a database is: a URL, or the path of a file of SQLite.

    Raises: SignsError: sign-database: it is a URL of neither SQLite nor PostgreSQL.
    """
    if "://" not in database:
        return URL.create("sqlite", database=str(Path(database)))
    try:
        url = make_url(database)
    except ArgumentError as error:
        raise SignsError("sign-database", f"`{database}` is no URL of a database") from error
    kind = url.get_backend_name()
    if kind not in ("sqlite", "postgresql"):
        raise SignsError(
            "sign-database",
            f"signs are kept in SQLite or PostgreSQL, not in {kind}",
            "name a file, or a URL such as postgresql://user@host/signs",
        )
    if kind == "sqlite" and url.database in (None, "", ":memory:"):
        raise SignsError("sign-database", "a database of signs in memory is gone at once")
    return url.set(drivername="sqlite" if kind == "sqlite" else "postgresql+psycopg")


def shown(url: URL) -> str:
    """Return a place as users know it: a file by its path, a URL without its password."""
    if url.get_backend_name() == "sqlite":
        return str(url.database)
    plain = url.set(drivername="postgresql")
    return plain.render_as_string(hide_password=True)


def file_of(url: URL) -> Path | None:
    """Return the file of a database of SQLite; None for PostgreSQL, and for SQLite's own URIs."""
    if url.get_backend_name() != "sqlite" or str(url.database).startswith("file:"):
        return None
    return Path(str(url.database))


class Store:
    """Transactions on one database."""

    def __init__(self, url: URL) -> None:
        self.name = shown(url)
        try:
            self.engine = _engine(url)
        except (ImportError, NoSuchModuleError) as error:
            raise SignsError(
                "not-installed",
                "the driver of PostgreSQL is not installed",
                "install it with: pip install 'azee[postgresql]'",
            ) from error

    def close(self) -> None:
        """Let go of all connections."""
        self.engine.dispose()

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """Give one state of the database. Raises: SignsError: sign-database."""
        with self._in_words(), self.engine.connect() as connection, connection.begin():
            yield connection

    @contextmanager
    def writing(self) -> Iterator[Connection]:
        """Give a transaction: all of it is kept, or nothing. Raises: SignsError: sign-database."""
        with self._in_words(), self.engine.connect() as connection:
            connection.execution_options(azee_writes=True)
            with connection.begin():
                yield connection

    def write_ahead(self) -> None:
        """Have SQLite keep a write-ahead log, from now on. Raises: SignsError: sign-database."""
        if self.engine.dialect.name != "sqlite":
            return
        with self._in_words():
            connection = self.engine.raw_connection()
            try:
                connection.cursor().execute("PRAGMA journal_mode = WAL").fetchall()
            except Exception as error:
                if hasattr(error, "sqlite_errorname"):
                    raise DBAPIError("PRAGMA journal_mode", None, error) from error
                raise
            finally:
                connection.close()

    @contextmanager
    def _in_words(self) -> Iterator[None]:
        try:
            yield
        except DBAPIError as error:
            if _code(error.orig) in ("23505", "SQLITE_CONSTRAINT_UNIQUE"):
                raise
            raise self._worded(error) from error
        except (UnicodeDecodeError, JSONDecodeError) as error:  # a text that nobody wrote
            raise self._damaged() from error

    def _worded(self, error: DBAPIError) -> SignsError:
        code, name = _code(error.orig), self.name
        if code.startswith(_FULL):
            return SignsError(
                "sign-database",
                f"the disk of `{name}` is full: what was stored before is kept, nothing is added",
                "make room, and run the same command again",
            )
        if code.startswith(_READ_ONLY):
            return SignsError("sign-database", f"`{name}` may only be read")
        if code.startswith(_NO_DATABASE):
            return SignsError("sign-database", f"`{name}` is no database")
        if code.startswith(_DAMAGED):
            return self._damaged()
        if code.startswith(_BUSY):
            return SignsError(
                "sign-database",
                f"another program has been writing to `{name}` for more than {WAIT_S:.0f} s",
            )
        said = str(error.orig).strip().partition("\n")[0]
        if not code or code.startswith(_UNREACHABLE):
            return SignsError("sign-database", f"cannot open the database `{name}`: {said}")
        return SignsError("sign-database", f"the database `{name}` refuses: {said}")

    def _damaged(self) -> SignsError:
        return SignsError(
            "sign-database",
            f"the database `{self.name}` is damaged",
            "`azee db copy NAME… --to DB` saves the signs that can be read",
        )


def _code(error: BaseException | None) -> str:
    """Return SQLite's name of an error, or the SQLSTATE of one of PostgreSQL."""
    found = getattr(error, "sqlite_errorname", None) or getattr(error, "sqlstate", None)
    return str(found or "")


def _engine(url: URL) -> Engine:
    if url.get_backend_name() == "postgresql":
        return create_engine(url)
    engine = create_engine(url, connect_args={"timeout": WAIT_S})

    @event.listens_for(engine, "connect")
    def prepare(connection: Any, _: object) -> None:
        connection.isolation_level = None  # transactions begin where `begin` says, not by guesses
        for pragma in ("foreign_keys = ON", "synchronous = FULL"):
            connection.execute(f"PRAGMA {pragma}")

    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        writes = connection.get_execution_options().get("azee_writes", False)
        connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")

    return engine
