"""Copies signs from one database to another; what cannot be copied is told, the rest goes on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from azee.signs.database import SignDatabase
from azee.signs.fault import SignsError
from azee.signs.query import Query
from azee.signs.sign import Sign


@dataclass(frozen=True, slots=True)
class Copied:
    """How many signs were copied, how many were there with the same bytes, and what failed."""

    copied: int
    there: int
    failed: tuple[SignsError, ...]


def copy_all(
    database: SignDatabase,
    signs: Sequence[Sign],
    other: SignDatabase,
    progress: Callable[[int, int], None] | None = None,
) -> Copied:
    """Copy signs, a transaction each.

    Args: progress: called with the signs that are done, and all of them.
    Raises: SignsError: sign-database: one of the databases can no longer be used.
    """
    copied, there, failed = 0, 0, []
    for number, sign in enumerate(signs, 1):
        identity = sign.identity
        query = Query(
            name=identity.name,
            language=identity.language,
            variant=identity.variant,
            skeleton=sign.skeleton_digest,
        )
        if any(each.digest == sign.digest for each in other.find(query)):
            there += 1
        else:
            try:
                database.copy(sign, other)
                copied += 1
            except SignsError as error:
                if error.code == "sign-database":
                    raise
                failed.append(error)
        if progress:
            progress(number, len(signs))
    return Copied(copied, there, tuple(failed))
