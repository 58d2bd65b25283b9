"""The database that `--db` names, opened; what is wrong with it as a diagnostic."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar

import click

from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.score.recorded_motion import RecordingError
    from azee.signs.database import SignDatabase
    from azee.signs.fault import SignsError

Command = TypeVar("Command", bound=Callable[..., Any])

db_option = click.option(
    "--db",
    "place",
    metavar="DB",
    envvar="AZEE_DB",
    help="The database: a file, or a URL such as postgresql://user@host/signs. By default that of "
    "AZEE_DB, or `signs.db` in your folder for data.",
)


def sign_options(command: Command) -> Command:
    """Add what tells signs of one name apart."""
    for option in reversed(
        (
            click.option("--language", metavar="L", help="The language of the sign meant."),
            click.option("--variant", metavar="V", help="The variant of the sign meant."),
        )
    ):
        command = option(command)
    return command


@contextmanager
def in_words() -> Iterator[None]:
    """Turn what is wrong with signs into diagnostics, and a missing library too.

    Raises: AZeeError: not-installed, and the codes of `SignsError`.
    """
    from azee.score.recorded_motion import RecordingError

    try:
        from azee.signs.fault import SignsError

        import_signs()
    except ImportError as error:
        raise AZeeError(
            Diagnostic(
                "not-installed",
                "what keeps databases of signs is not installed",
                None,
                help="install it with: pip install 'azee[signs]'",
            )
        ) from error
    try:
        yield
    except (SignsError, RecordingError) as error:
        raise AZeeError(as_diagnostic(error)) from error


def import_signs() -> None:
    """Load what only the extra `signs` installs. Raises: ImportError."""
    import platformdirs  # noqa: F401
    import sqlalchemy  # noqa: F401


def as_diagnostic(error: SignsError | RecordingError) -> Diagnostic:
    """Return what is wrong as a diagnostic."""
    return Diagnostic(error.code, error.message, None, help=error.remedy)


@contextmanager
def opened(place: str | None) -> Iterator[SignDatabase]:
    """Give an open database. Raises: AZeeError: not-installed, and the codes of `SignsError`."""
    with in_words():
        from azee.signs.database import SignDatabase

        with SignDatabase.open(place or usual_place()) as database:
            yield database


def usual_place() -> str:
    """Return the path of the database in the user's folder for data."""
    from platformdirs import user_data_path

    return str(user_data_path("azee", appauthor=False) / "signs.db")
