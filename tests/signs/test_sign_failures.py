"""Killed writers, many at once, full disks, flipped bytes: whole signs only, and one message."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from made_signs import STICK, facts, motion
from sqlalchemy import event, text

from azee.signs.copying import copy_all
from azee.signs.database import SignDatabase
from azee.signs.fault import SignsError
from azee.signs.integrity import problems

IMPORT = """
import sys
from made_signs import STICK, facts, motion
from azee.signs.database import SignDatabase
place, who, count = sys.argv[1], sys.argv[2], int(sys.argv[3])
with SignDatabase.open(place) as signs:
    for number in range(count):
        name = f"{who}{number:04}"
        if not signs.made_from(motion(name, 200).original, STICK):
            signs.add(facts(name, "t1", "t2"), motion(name, 200), STICK)
        print(name, flush=True)
"""
READ = """
import sys, time
from azee.signs.database import SignDatabase
from azee.signs.query import Query
slowest, seen, looks = 0.0, 0, 0
with SignDatabase.open(sys.argv[1]) as signs:
    end = time.monotonic() + float(sys.argv[2])
    while time.monotonic() < end or not seen:
        start = time.monotonic()
        found = signs.find(Query(prefix="a"))
        slowest = max(slowest, time.monotonic() - start)
        assert len(found) >= seen, "a sign went away"
        seen, looks = len(found), looks + 1
        for sign in found[-3:]:
            assert sign.facts.tags == ("t1", "t2")
            signs.motion(sign)
print(slowest, seen, looks)
"""


def started(script: str, *arguments: str) -> subprocess.Popen[str]:
    """Run a script in a process of its own, which can be killed."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    return subprocess.Popen(
        [sys.executable, "-c", script, *arguments],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def whole(place: str) -> set[str]:
    """Names of the signs of a database, each of which is whole."""
    with SignDatabase.open(place) as signs:
        found = signs.find()
        for sign in found:
            assert signs.motion(sign) == motion(sign.identity.name, 200)
            assert sign.facts.tags == ("t1", "t2")
        damages = [p for p in problems(signs) if "is not a clip" not in str(p)]
        assert damages == []  # but that these bytes are no clips
        return {sign.identity.name for sign in found}


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGKILL")
def test_a_killed_import_leaves_whole_signs_and_goes_on(database_place: str) -> None:
    SignDatabase.create(database_place)[0].store.close()
    chance = random.Random(19)
    counts = []
    for _ in range(10):
        process = started(IMPORT, database_place, "a", "500")
        assert process.stdout is not None
        told = {process.stdout.readline().strip()}  # it writes
        time.sleep(chance.uniform(0.0, 0.15))
        process.send_signal(signal.SIGKILL)
        told |= {line for line in process.communicate()[0].split("\n") if len(line) == 5}
        assert process.returncode == -signal.SIGKILL
        there = whole(database_place)
        assert told - {""} <= there  # what was said to be stored is
        counts.append(len(there))
    assert counts == sorted(counts)
    assert 0 < counts[0] < counts[-1]
    process = started(IMPORT, database_place, "a", "500")
    assert (process.communicate()[1], process.returncode) == ("", 0)
    assert len(whole(database_place)) == 500


@pytest.mark.slow
def test_two_write_while_four_read_and_no_reader_waits(database_place: str) -> None:
    SignDatabase.create(database_place)[0].store.close()
    writers = [started(IMPORT, database_place, who, "150") for who in ("ab", "ac")]
    readers = [started(READ, database_place, "3") for _ in range(4)]
    for process in writers:
        assert (process.communicate()[1], process.returncode) == ("", 0)
    for process in readers:
        out, err = process.communicate()
        assert err == ""
        slowest, seen, looks = map(float, out.split())
        assert slowest < 1.0
        assert seen > 0
        assert looks > 1
    assert len(whole(database_place)) == 300


def test_sqlite_keeps_a_write_ahead_log_and_writes_through(tmp_path: Path) -> None:
    signs, _ = SignDatabase.create(str(tmp_path / "signs.db"))
    with signs, signs.store.reading() as connection:
        for pragma, value in (("journal_mode", "wal"), ("synchronous", 2), ("foreign_keys", 1)):
            assert connection.execute(text(f"PRAGMA {pragma}")).scalar() == value


def test_a_full_disk_keeps_what_is_there(tmp_path: Path) -> None:
    signs, _ = SignDatabase.create(str(tmp_path / "signs.db"))
    with signs:
        signs.add(facts("A"), motion("a"), STICK)

        def cramped(connection: object, *_: object) -> None:
            connection.execute("PRAGMA max_page_count = 40")  # type: ignore[attr-defined]

        signs.store.close()
        event.listen(signs.store.engine, "connect", cramped)
        with pytest.raises(SignsError, match="is full: what was stored before is kept"):
            signs.add(facts("B"), motion("b", 50_000), STICK)
        assert [str(sign.identity) for sign in signs.find()] == ["A"]
        signs.add(facts("C"), motion("c"), STICK)
        assert signs.motion(signs.one("C")) == motion("c")


def test_a_database_that_may_only_be_read_is_read(tmp_path: Path) -> None:
    path = tmp_path / "signs.db"
    signs, _ = SignDatabase.create(str(path))
    with signs:
        signs.add(facts("A"), motion("a"), STICK)
    with SignDatabase.open(f"sqlite:///file:{path}?mode=ro&uri=true") as signs:
        sign = signs.one("A")
        assert signs.motion(sign) == motion("a")
        for change in (
            lambda: signs.add(facts("B"), motion("b"), STICK),
            lambda: signs.remove(sign),
            lambda: signs.tag(sign, ["x"]),
        ):
            with pytest.raises(SignsError, match="may only be read"):
                change()


def test_what_is_no_database_is_told(tmp_path: Path) -> None:
    prose = tmp_path / "text.db"
    prose.write_text("not a database " * 100, encoding="utf-8")
    empty = tmp_path / "empty.db"
    empty.touch()
    for place, said in (
        (str(tmp_path / "none.db"), "no such file"),
        (str(tmp_path), "a directory"),
        (str(prose), "is no database"),
        (str(empty), "has no tables for signs"),
        ("mysql://x/y", "not in mysql"),
        ("no url://", "is no URL of a database"),
        ("sqlite://", "in memory"),
        ("postgresql://nobody:secret@/none?host=/nowhere", "cannot open the database"),
    ):
        with pytest.raises(SignsError, match=said) as caught:
            SignDatabase.open(place)
        assert caught.value.code == "sign-database"
        assert "secret" not in str(caught.value)
    with pytest.raises(SignsError, match="there is no folder"):
        SignDatabase.create(str(tmp_path / "none" / "signs.db"))
    assert not (tmp_path / "none.db").exists()


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The file of a database of three signs."""
    path = tmp_path_factory.mktemp("stored") / "signs.db"
    signs, _ = SignDatabase.create(str(path))
    with signs:
        for name in "ABC":
            signs.add(facts(name, "t"), motion(name), STICK)
    return path.read_bytes()


@pytest.mark.slow
@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_flipped_bytes_give_a_message_and_never_another_sign(
    data: st.DataObject, stored: bytes, tmp_path: Path
) -> None:
    damaged = bytearray(stored)
    for place in data.draw(st.lists(st.integers(0, len(stored) - 1), min_size=1, max_size=8)):
        damaged[place] ^= data.draw(st.integers(1, 255))
    for left in tmp_path.iterdir():
        left.unlink()
    path = tmp_path / "signs.db"
    path.write_bytes(damaged)
    other, _ = SignDatabase.create(str(tmp_path / "other.db"))
    with other:
        with suppress(SignsError), SignDatabase.open(str(path)) as signs:
            for sign in signs.find():
                try:
                    blobs = signs.motion(sign)
                except SignsError:
                    continue
                assert blobs.clip in {motion(name).clip for name in "ABC"}
            copy_all(signs, signs.find(), other)
            list(problems(signs))
        for sign in other.find():
            assert other.motion(sign).clip in {motion(name).clip for name in "ABC"}
