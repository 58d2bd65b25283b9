"""Measures a database of signs: storing, opening, looking up.

`python benchmarks/run.py signs-db [--count N] [--db DB]`. N small signs with made-up bytes are
stored, a transaction each. Then signs are looked up by name, beginning and tag, as users do: the
database is open, and its file is in the memory of the system. `--db` names an empty database, such
as one of PostgreSQL; by default it is SQLite in a folder of its own.
"""

from __future__ import annotations

import argparse
import random
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from azee.signs.database import SignDatabase
from azee.signs.query import Query
from azee.signs.sign import Identity, Motion, SignFacts, Timing
from azee.signs.skeleton import StoredSkeleton

LOOK_UP_S, OPEN_S = 0.010, 0.2
"""Goals."""
LOOKS = 200
TAGS = 500
CLIP_BYTES = 2_000
SKELETON = StoredSkeleton("stick", "0" * 64, ("root",), ("root.flexion",))


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table; leave with 1 where a goal is missed."""
    parser = argparse.ArgumentParser(prog="signs-db", description=__doc__)
    parser.add_argument("--count", type=int, default=10_000, help="signs; default 10,000")
    parser.add_argument("--db", help="an empty database")
    options = parser.parse_args(arguments)
    with TemporaryDirectory() as folder:
        place = options.db or str(Path(folder) / "signs.db")
        if not measured(place, options.count):
            raise SystemExit(1)


def measured(place: str, count: int) -> bool:
    """Fill and measure a database; returns whether all goals are met."""
    chance = random.Random(1)
    names = [f"{chance.choice('ABCDEFGHIJKLMNOPQRSTUVWXYZ')}{n:05}" for n in range(count)]
    database, _ = SignDatabase.create(place)
    with database:
        began = time.perf_counter()
        for name in names:
            _store(database, name, chance)
        each_s = (time.perf_counter() - began) / count
    print(f"{count} signs stored, {1e3 * each_s:.2f} ms each, a transaction each")
    met = [_row("opening, with the library loaded", _opening(place), OPEN_S)]
    with SignDatabase.open(place) as database:
        some = [chance.choice(names) for _ in range(LOOKS)]
        tags = [f"t{chance.randrange(TAGS)}" for _ in range(LOOKS)]
        for what, queries in (
            ("by name", [Query(name=name) for name in some]),
            ("by beginning, 3 letters", [Query(prefix=name[:4]) for name in some]),
            ("by tag", [Query(tag=tag) for tag in tags]),
            ("by beginning or tag", [Query(word=word) for word in (*some, *tags)]),
        ):
            found = [len(database.find(query)) for query in queries]
            looks = [partial(database.find, query) for query in queries]
            met.append(_row(f"{what}, {statistics.mean(found):.0f} found", looks, LOOK_UP_S))
        signs = [database.one(name) for name in some]
        met.append(
            _row("its motion", [partial(database.motion, sign) for sign in signs], LOOK_UP_S)
        )
    print(f"the command, from its start: {1e3 * _command_s(place, names[0]):.0f} ms")
    return all(met)


def _store(database: SignDatabase, name: str, chance: random.Random) -> None:
    tags = tuple(f"t{chance.randrange(TAGS)}" for _ in range(3))
    facts = SignFacts(Identity(name, "lsf"), Timing.of(2.0, 61, 30.0), tags=tags)
    clip = chance.randbytes(CLIP_BYTES)
    database.add(facts, Motion(clip, clip, f"{name}.bvh"), SKELETON)


def _opening(place: str) -> list[Callable[[], object]]:
    def opened() -> None:
        with SignDatabase.open(place):
            pass

    return [opened] * 20


def _row(what: str, actions: Sequence[Callable[[], object]], goal_s: float) -> bool:
    """Print median and 95th percentile; returns whether the latter is within the goal."""
    times = []
    for action in actions:
        began = time.perf_counter()
        action()
        times.append(time.perf_counter() - began)
    high = statistics.quantiles(times, n=20)[-1]
    cells = f"{1e3 * statistics.median(times):8.2f} ms{1e3 * high:8.2f} ms"
    verdict = "" if high <= goal_s else "  missed"
    print(f"{what:<40}{cells}   goal {1e3 * goal_s:.0f} ms{verdict}")
    return high <= goal_s


def _command_s(place: str, name: str) -> float:
    """How long `azee db show` takes, the start of Python and all."""
    began = time.perf_counter()
    command = [sys.executable, "-m", "azee", "db", "show", name, "--db", place]
    subprocess.run(command, check=True, capture_output=True)
    return time.perf_counter() - began


if __name__ == "__main__":
    main()
