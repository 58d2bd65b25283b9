"""The folder of outputs, which one batch at a time writes to."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from azee.formats import writing
from azee_grammar.diagnostic import AZeeError, Diagnostic

LOCK = ".lock"


@contextmanager
def opened(out: Path) -> Iterator[Path]:
    """Make the folder of outputs if need be, keep others out, and give its absolute path.

    The system lets go of the lock when this process ends, however it ends.

    Raises: AZeeError: cannot-write, also if another batch is writing to it.
    """
    with writing(out):
        out.mkdir(parents=True, exist_ok=True)
    with writing(out / LOCK):
        file = (out / LOCK).open("ab")
    with file:
        if not _locked(file):
            message = f"another `azee batch` is writing to `{out}`"
            help_ = "wait for it, or stop it; the same command then goes on"
            raise AZeeError(Diagnostic("cannot-write", message, None, help=help_))
        yield out.resolve()


def _locked(file: BinaryIO) -> bool:
    """Lock a file if nobody has."""
    try:
        if os.name == "nt":
            import msvcrt

            file.seek(0)
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined]
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True
