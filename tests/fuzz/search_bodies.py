"""Looks for files of bodies that break what must hold of any: `make fuzz-bodies`.

Small bodies of several makers are damaged at random places, over and over. One file is kept of
every distinct place that raised, in out/fuzz/bodies, with its traceback; a shortened one goes into
tests/fuzz/regressions/bodies. Exit code 1 means that something was found.
"""

from __future__ import annotations

import random
import sys
import time
import traceback
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT / "tests" / "rig")]

import body_families  # noqa: E402
from any_body import damaged, examine  # noqa: E402
from body_families import declare, make_body  # noqa: E402
from drawn_faces import drawn  # noqa: E402
from joint_names import FAMILIES  # noqa: E402
from search import place  # noqa: E402

FOUND = ROOT / "out" / "fuzz" / "bodies"
SLOW_S = 10.0
UNITS = {"jawOpen": "jawOpen", "browInnerUp": "browInnerUp"}


def seeds() -> list[bytes]:
    """Bodies to start from, small ones."""
    body_families.CELL_M, body_families.FINE_M = 0.06, 0.02
    made = [make_body(FAMILIES[name]) for name in ("mixamo", "makehuman", "motive", "vroid")]
    files = [body.file(units=UNITS) for body in made]
    files.append(drawn(made[-1]).file(unit=0.01, up="z"))
    files.append(declare(made[-1].file(), made[-1], 0))
    files.append(declare(made[-1].file(units=UNITS), made[-1], 1))
    return [file.data() for file in files]


def main(seconds: float, seed: int) -> int:
    """Search for so long; returns 1 where something was found."""
    FOUND.mkdir(parents=True, exist_ok=True)
    chance, started, found = random.Random(seed), seeds(), set[str]()
    end, said = time.monotonic() + seconds, Counter[str]()
    while time.monotonic() < end:
        data = damaged(chance.choice(started), chance)
        start = time.process_time()
        try:
            said["refused" if examine(data) else "taken in"] += 1
        except Exception as problem:
            found.add(keep(data, place(problem), traceback.format_exc()))
        if (spent := time.process_time() - start) > SLOW_S:
            found.add(keep(data, f"slow-{spent:.0f}s", f"{spent:.1f} s of processor time"))
    for name in sorted(found):
        print(f"found {FOUND.relative_to(ROOT) / name}.glb")
    print(f"{sum(said.values())} bodies, {dict(said)}; {len(found)} findings; seed {seed}")
    return 1 if found else 0


def keep(data: bytes, name: str, reason: str) -> str:
    """Keep the shortest file of each name, with why it was kept; return the name."""
    file = FOUND / f"{name}.glb"
    if not file.exists() or file.stat().st_size > len(data):
        file.write_bytes(data)
        file.with_suffix(".txt").write_text(reason, encoding="utf-8", errors="replace")
    return name


if __name__ == "__main__":
    sys.exit(main(float(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else time.time_ns()))
