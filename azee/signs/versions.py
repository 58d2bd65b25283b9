"""The version of a database: it is made, brought up to date, or refused."""

from __future__ import annotations

from pathlib import Path

from sqlalchemy import Connection, Inspector, inspect, text

from azee.signs.connection import Store
from azee.signs.fault import SignsError
from azee.signs.tables import METADATA, VERSION, VERSION_TABLE


def migrate(store: Store) -> str | None:
    """Make the tables, or bring those of an older azee up to date, in one transaction.

    Returns: the version before; None if there were no tables.
    Raises: SignsError: sign-database: the tables are another program's, or of a newer azee.
    """
    from alembic import command
    from alembic.config import Config

    with store.writing() as connection:
        before = version(connection)
        if before is None and set(inspect(connection).get_table_names()) & set(METADATA.tables):
            raise _foreign(store)
        if before is not None and before > VERSION:
            raise _newer(store, before)
        config = Config()
        config.set_main_option("script_location", str(Path(__file__).parent / "migrations"))
        config.attributes["connection"] = connection
        command.upgrade(config, "head")
    return before


def check_version(store: Store) -> None:
    """Refuse a database that is not of this azee's version.

    Raises: SignsError: sign-database.
    """
    with store.reading() as connection:
        found = version(connection)
        names = set(inspect(connection).get_table_names()) if found is None else set()
    if found == VERSION:
        return
    if found is not None and found > VERSION:
        raise _newer(store, found)
    if found is not None:
        raise SignsError(
            "sign-database",
            f"`{store.name}` is a database of version {found}; this azee needs version {VERSION}",
            "`azee db create` brings it up to date; all signs stay",
        )
    if names:
        raise _foreign(store)
    raise SignsError(
        "sign-database",
        f"the database `{store.name}` has no tables for signs",
        "`azee db create` makes them",
    )


def version(connection: Connection) -> str | None:
    """Return the version of the tables; None if there are none."""
    inspector: Inspector = inspect(connection)
    if not inspector.has_table(VERSION_TABLE):
        return None
    found = connection.execute(text(f"SELECT version_num FROM {VERSION_TABLE}")).scalar()
    return None if found is None else str(found)


def _newer(store: Store, found: str) -> SignsError:
    return SignsError(
        "sign-database",
        f"`{store.name}` is a database of version {found}; this azee reads version {VERSION}",
        "a newer azee made it: update azee",
    )


def _foreign(store: Store) -> SignsError:
    return SignsError(
        "sign-database",
        f"`{store.name}` is the database of another program",
        "choose another file or database with --db",
    )
