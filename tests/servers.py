"""Servers that tests start: a PostgreSQL of our own."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_BINARIES = ("", *map(str, sorted(Path("/usr/lib/postgresql").glob("*/bin"), reverse=True)))


class NoServerError(Exception):
    """A server is not installed, or does not start."""


@contextmanager
def postgresql_server() -> Iterator[str]:
    """Start a PostgreSQL that listens on a socket in a folder of its own; remove both at the end.

    Yields: its URL, with {} for the name of a database. Raises: NoServerError.
    """
    found = next((w for p in _BINARIES if (w := shutil.which("initdb", path=p or None))), None)
    if found is None:
        raise NoServerError("PostgreSQL is not installed: Debian's postgresql")
    binaries = Path(found).resolve().parent
    folder = Path(tempfile.mkdtemp(prefix="azee-pg-"))
    owner = "postgres" if os.geteuid() == 0 else None  # a server does not run as root
    if owner:
        shutil.chown(folder, owner)
    data, settings = str(folder / "data"), f"-k {folder} -c listen_addresses='' -c fsync=off"
    made = ("initdb", "-D", data, "-U", "azee", "-A", "trust", "-E", "UTF8")
    begun = ("pg_ctl", "-D", data, "-w", "-l", str(folder / "log"), "-o", settings, "start")
    try:
        for program, *options in (made, begun):
            done = subprocess.run(
                [str(binaries / program), *options],
                cwd=folder,
                user=owner,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                check=False,
            )
            if done.returncode:
                raise NoServerError(f"PostgreSQL does not start: {done.stderr.decode()[-200:]}")
        yield f"postgresql://azee@/{{}}?host={folder}"
    finally:
        stop = [str(binaries / "pg_ctl"), "-D", data, "-m", "immediate", "stop"]
        subprocess.run(stop, user=owner, cwd="/", capture_output=True, check=False)
        shutil.rmtree(folder, ignore_errors=True)
