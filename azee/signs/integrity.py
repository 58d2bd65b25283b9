"""Looks for what is wrong in a database of signs: the file, references, digests, clips."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from sqlalchemy import select, text

from azee.signs.database import SignDatabase
from azee.signs.fault import SignsError
from azee.signs.tables import MOTION, SIGN, TAG

if TYPE_CHECKING:
    from azee.signs.sign import Sign

SHOWN = 10
"""Damages of the file itself that are told."""


def problems(
    database: SignDatabase, progress: Callable[[int, int], None] | None = None
) -> Iterator[SignsError]:
    """Yield all that is wrong, sign by sign.

    Args: progress: called with the signs that were looked at, and all of them.
    """
    yield from _of_the_file(database)
    yield from _of_references(database)
    signs = database.find()
    for number, sign in enumerate(signs, 1):
        yield from _of(database, sign)
        if progress:
            progress(number, len(signs))


def _of_the_file(database: SignDatabase) -> Iterator[SignsError]:
    """SQLite's own check of its pages and indexes; PostgreSQL keeps checksums by itself."""
    if database.store.engine.dialect.name != "sqlite":
        return
    with database.store.reading() as connection:
        told = connection.execute(text(f"PRAGMA integrity_check({SHOWN})")).scalars().all()
    if told != ["ok"]:
        for line in told:
            yield SignsError("sign-database", f"`{database.store.name}`: {line}")


def _of_references(database: SignDatabase) -> Iterator[SignsError]:
    with database.store.reading() as connection:
        bare = select(SIGN.c.name).where(SIGN.c.id.not_in(select(MOTION.c.sign)))
        halves = connection.execute(bare).scalars().all()
        lone = [
            connection.execute(select(t.c.sign).where(t.c.sign.not_in(select(SIGN.c.id)))).all()
            for t in (MOTION, TAG)
        ]
    for name in halves:
        yield SignsError("damaged-sign", f"the sign `{name}` has no movement")
    if count := sum(map(len, lone)):
        yield SignsError("damaged-sign", f"{count} movements and tags belong to no sign")


def _of(database: SignDatabase, sign: Sign) -> Iterator[SignsError]:
    from azee.clip.archive import ClipFileError, frames_of

    try:
        motion = database.motion(sign)
    except SignsError as error:
        if error.code != "unknown-sign":  # removed by another program, or told above
            yield error
        return
    try:
        frames = frames_of(motion.clip, str(sign.identity))
    except ClipFileError as error:
        yield SignsError("damaged-sign", str(error))
        return
    if frames != sign.facts.timing.frames:
        message = f"`{sign.identity}` has {frames} frames, not {sign.facts.timing.frames}"
        yield SignsError("damaged-sign", message)
