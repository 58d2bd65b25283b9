"""An import of 500 BVH files by two commands, killed at 50 random moments while four read."""

from __future__ import annotations

import os
import random
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import closing, suppress
from pathlib import Path

import numpy as np
import pytest

from azee.clip.clip import Clip
from azee.clips import save_clip
from azee.signs.database import SignDatabase
from azee.signs.integrity import problems
from azee_rig.rig import Rig

FILES, KILLS, READERS = 500, 50, 4
READ = """
import sys, time
from pathlib import Path
from azee.signs.database import SignDatabase
from azee.signs.query import Query
stop, slowest, seen = Path(sys.argv[2]), 0.0, 0
with SignDatabase.open(sys.argv[1]) as signs:
    while not stop.exists():
        began = time.monotonic()
        found = signs.find(Query(prefix="S"))
        took = time.monotonic() - began
        slowest = max(slowest, took)
        assert len(found) >= seen, "a sign went away"
        seen = len(found)
        for sign in found[-2:]:
            signs.motion(sign)
        time.sleep(max(0.2, 4 * took))  # readers leave the processors to the writers
print(slowest, seen)
"""
IMPORT = """
import os, sys
from azee.cli.main import run
place, warm, *folders = sys.argv[1:]
assert run(["db", "create", "--db", warm, "--quiet"]) == 0
assert run(["db", "add", folders[0] + "/S0000.bvh", "--db", warm, "--quiet"]) == 0
print("ready", flush=True)
for line in sys.stdin:
    children = []
    for folder in folders:
        child = os.fork()
        if not child:
            os._exit(run(["db", "add", folder, "--db", place, "--quiet"]))
        children.append(child)
    print(*children, flush=True)
    codes = [os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) for child in children]
    print(*codes, flush=True)
"""
"""Starts imports, one a folder, for every line that it reads; all is loaded before."""


def started(*command: str) -> subprocess.Popen[str]:
    """A process of its own, which can be killed."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    return subprocess.Popen(
        [sys.executable, *command],
        env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        text=True,
    )  # fmt: skip


def count(place: str) -> int:
    """How many signs there are, asked as quickly as can be."""
    with closing(sqlite3.connect(f"file:{place}?mode=ro", uri=True)) as connection:
        (found,) = connection.execute("SELECT count(*) FROM sign").fetchone()
    return int(found)


def recordings(folder: Path, signer: Rig, names: range) -> None:
    """Short recordings of the signer's own skeleton, which no two have alike."""
    folder.mkdir()
    for number in names:
        q = np.tile(signer.coordinates.idle, (3, 1))
        q[:, signer.coordinates.index["arm_R.flexion"]] += 0.001 * number + 0.01 * np.arange(3)
        clip = Clip(np.arange(3) / 30, q, (), np.zeros((3, 0)))
        save_clip(clip, signer, folder / f"S{number:04}.bvh")


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGKILL")
def test_an_import_killed_fifty_times_ends_with_all_signs_whole(
    tmp_path: Path, signer: Rig
) -> None:
    place, stop = str(tmp_path / "signs.db"), tmp_path / "stop"
    SignDatabase.create(place)[0].store.close()
    folders = [tmp_path / "a", tmp_path / "b"]
    for half, folder in enumerate(folders):
        recordings(folder, signer, range(half, FILES, 2))
    readers = [started("-c", READ, place, str(stop)) for _ in range(READERS)]
    writers = started("-c", IMPORT, place, str(tmp_path / "warm.db"), *map(str, folders))
    assert writers.stdin is not None
    assert writers.stdout is not None
    assert writers.stdout.readline() == "ready\n"

    def begin() -> list[int]:
        print(file=writers.stdin, flush=True)
        return [int(child) for child in writers.stdout.readline().split()]  # type: ignore[union-attr]

    chance, kills, before = random.Random(50), 0, 0
    while kills < KILLS:
        children = begin()
        waited = time.monotonic() + 30.0
        while count(place) == before < FILES and time.monotonic() < waited:
            time.sleep(0.1)
        time.sleep(chance.uniform(0.0, 0.1))
        for child in children:
            with suppress(ProcessLookupError):
                os.kill(child, signal.SIGKILL)
            kills += 1
        writers.stdout.readline()
        with SignDatabase.open(place) as signs:
            assert list(problems(signs)) == []
            before = len(signs.find())
    begin()
    assert writers.stdout.readline() == "0 0\n"
    assert writers.communicate()[1] == ""
    stop.touch()
    for reader in readers:
        out, err = reader.communicate()
        assert err == ""
        slowest, seen = map(float, out.split())
        assert slowest < 1.0
        assert seen > 0
    with SignDatabase.open(place) as signs:
        assert [s.identity.name for s in signs.find()] == [f"S{n:04}" for n in range(FILES)]
        assert list(problems(signs)) == []
