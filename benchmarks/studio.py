"""Measures the studio: from an edit to the moving picture, frames, drags, memory under load.

`python benchmarks/run.py studio [--minutes N] [--seconds N]`. A sentence of two signs is edited on
the page in headless Chromium, with packages of `make node`; times are the page's own, from the edit
to the first picture of the new movement. Then hands are dragged, and 8 clients send texts for some
minutes while the memory of server and worker is printed. Every part ends: what a busy machine does
not finish in time is told, and counts as missed. The page draws by software where there is no
graphics card, and takes the processor away from the worker meanwhile.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import re
import shutil
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from websockets.sync.client import ClientConnection

from benchmarks.memory import different

ROOT = Path(__file__).parents[1]
EDIT_S = 0.3
"""Goal: from an edit of a sentence of two signs to the moving picture, warm."""
DRAGS = 300
DRAG_S = 1 / 30
"""Goal: from a drag to its posture."""
CLIENTS = 8
GROWTH_MB = 50
"""Goal: the most that memory grows in the second half of the load."""
PAGE_S, DRAGS_S, ANSWER_S = 300.0, 60.0, 60.0
"""The longest that the page, all drags over the connection, and one answer are waited for."""
CLOSING_S = 30.0
"""The longest that the browser may take to close."""
WORDS = ("arbre", "âge", "personne", "bonjour")


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the figures; leave with 1 where a goal is missed."""
    parser = argparse.ArgumentParser(prog="studio", description=__doc__)
    parser.add_argument("--minutes", type=float, default=1,
                        help="how long 8 clients send texts; default 1, 0: not at all")  # fmt: skip
    parser.add_argument("--seconds", type=float, default=PAGE_S,
                        help="how long the page is measured at most, 0: not at all")  # fmt: skip
    options = parser.parse_args(arguments)
    sys.path.insert(0, str(ROOT / "tests" / "studio"))
    from studio_server import Studio

    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}", flush=True)
    with TemporaryDirectory() as folder:
        (Path(folder) / "texts").mkdir()
        studio = Studio(Path(folder) / "texts", Path(folder) / "kept.sqlite")
        try:
            met = [_page(studio.url, options.seconds), _drags(studio)]
            met += [_load(studio, 60 * options.minutes)] if options.minutes else []
        finally:
            studio.kill()
    if not all(met):
        raise SystemExit(1)


def _page(url: str, seconds: float) -> bool:
    """Measure the page; return whether edits are quick enough."""
    chromium = next(filter(None, map(shutil.which, ("chromium", "google-chrome"))), None)
    if chromium is None or not seconds:
        print("the page is not measured" + ("" if chromium else ": there is no Chromium"))
        return True
    told = _told(url, chromium, seconds)
    if told is None:
        return False
    if told["during"] is not None:
        why = told["failure"] or f"more than {seconds:g} s are over"
        print(f"the page was not done, while {told['during']}: {why}")
    met = bool(told["edits"]) and _edits(told["edits"])
    for name, times in (
        ("a frame", "frames_ms"),
        ("a drag to its posture on the page", "drags_ms"),
    ):
        if found := told[times]:
            print(f"{name}: {statistics.median(found):.1f} ms median of {len(found)}, "
                  f"{max(found):.1f} at most ({told['device']})", flush=True)  # fmt: skip
    return met and told["during"] is None


def _told(url: str, chromium: str, seconds: float) -> dict[str, Any] | None:
    """Return what the page tells of itself; none, and a message, where it says nothing."""
    with subprocess.Popen(
        ["node", "studio_page.mjs", "times", url, "", "times.azee", str(seconds)],
        cwd=ROOT / "tests" / "node", env=os.environ | {"CHROMIUM": chromium},
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    ) as page:  # fmt: skip
        try:
            out, complaint = page.communicate(timeout=seconds + CLOSING_S)
        except subprocess.TimeoutExpired:
            page.terminate()  # it closes its browser
            print(f"the browser did not answer in {seconds + CLOSING_S:g} s")
            return None
    if page.returncode != 0:
        print(f"the page failed: {complaint.strip()}")
        return None
    told: dict[str, Any] = json.loads(out)
    return told


def _edits(edits: Sequence[dict[str, Any]]) -> bool:
    """Print how long edits took and where the time went; return whether they are quick enough."""
    met = True
    for kind in dict.fromkeys(edit["kind"] for edit in edits):
        some = [edit for edit in edits if edit["kind"] == kind]
        taken = [edit["drawn"] / 1000 for edit in some]
        half = statistics.median(taken)
        met &= half <= EDIT_S
        print(f"edit to moving picture, {kind}: {half:.2f} s median of {len(taken)}, "
              f"{min(taken):.2f} to {max(taken):.2f}; goal {EDIT_S}")  # fmt: skip
        steps: dict[str, list[float]] = {"until the text is sent": [edit["sent"] for edit in some]}
        for name in ("evaluate", "perform", "encode"):
            steps[name] = [edit["worker"][name] for edit in some]
        steps["way and wait"] = [
            edit["came"] - edit["sent"] - sum(edit["worker"][name] for name in list(steps)[1:4])
            for edit in some
        ]
        steps["draw"] = [edit["drawn"] - edit["came"] for edit in some]
        print("  " + ", ".join(f"{name} {statistics.median(ms):.0f}" for name, ms in steps.items())
              + " ms; the worker's processor "
              f"{statistics.median(edit['worker']['processor'] for edit in some):.0f} ms",
              flush=True)  # fmt: skip
    return met


def _drags(studio: object) -> bool:
    """Drag a hand over the connection as a page does, each after the answer to the one before."""
    from studio_server import Studio, until

    assert isinstance(studio, Studio)
    text = "key 1\n    place @I_TIP(s) ^Mssp\n"
    taken: list[float] = []
    solved: list[float] = []
    end = time.monotonic() + DRAGS_S
    with studio.live() as socket:
        for n in range(DRAGS + 1):
            ask: dict[str, object] = {"kind": "pose", "session": 1, "serial": n}
            if n == 0:
                ask |= {"act": "open", "at_s": 0.5, "number": 1, "file": "a.azee", "text": text}
            else:
                turn = 2 * math.pi * n / DRAGS
                place = [0.1 * math.sin(turn), 1.2 + 0.08 * math.sin(2 * turn), 0.3]
                ask |= {"act": "drag", "handle": "@I_TIP(s)", "target": place}
            began = time.perf_counter()
            socket.send(json.dumps(ask))
            try:
                answer, _ = until(socket, "posed", serial=n)
            except TimeoutError:
                print("drags over the connection: one is not answered")
                break
            if n > 0:
                taken.append(time.perf_counter() - began)
                solved.append(answer["solve_ms"])
            if time.monotonic() > end:
                print(f"drags over the connection: not done in {DRAGS_S:g} s")
                break
    half = statistics.median(taken or [math.inf])
    late = sum(t > DRAG_S for t in taken) / max(1, len(taken))
    print(f"a drag over the connection: {1e3 * half:.1f} ms median of {len(taken)}, "
          f"{1e3 * max(taken, default=0):.0f} at most, "
          f"{late:.1%} later than {1e3 * DRAG_S:.0f} ms; solving "
          f"{statistics.median(solved or [0]):.1f} ms of the processor, "
          f"{max(solved, default=0):.0f} at most", flush=True)  # fmt: skip
    return half <= DRAG_S and len(taken) == DRAGS


def _load(studio: object, seconds: float) -> bool:
    from studio_server import Studio

    assert isinstance(studio, Studio)
    end = time.monotonic() + seconds
    counts, unanswered = [0] * CLIENTS, [0] * CLIENTS
    clients = [
        threading.Thread(target=_client, args=(studio, i, end, counts, unanswered), daemon=True)
        for i in range(CLIENTS)
    ]
    for client in clients:
        client.start()
    memory = []
    while time.monotonic() < end:
        time.sleep(min(seconds / 8, 60))
        server, *worker = _memory_mb(studio.process.pid)
        memory.append(server + sum(worker))
        print(f"  {(time.monotonic() - end + seconds) / 60:4.1f} min: server {server:.0f} MB, "
              f"worker {sum(worker):.0f} MB, {sum(counts)} movements", flush=True)  # fmt: skip
    for client in clients:
        client.join(ANSWER_S)
    grown = memory[-1] - memory[len(memory) // 2]
    print(f"memory of server and worker in the second half: {grown:+.0f} MB; goal {GROWTH_MB}; "
          f"{sum(counts)} movements, {sum(unanswered)} not in {ANSWER_S:g} s")  # fmt: skip
    return grown <= GROWTH_MB and sum(counts) > 0


def _client(
    studio: object, number: int, end: float, counts: list[int], unanswered: list[int]
) -> None:
    """Send texts like a page, each when the one before is signed, or given up."""
    from studio_server import Studio

    assert isinstance(studio, Studio)
    with studio.live() as socket:
        for n in range(10**6):
            if time.monotonic() > end:
                return
            words = [WORDS[(n + number + i) % len(WORDS)] for i in range(2)]
            text = f":info-about(:{words[0]}, :{words[1]})\n# {n}\n"
            if n % 2:  # a place that nobody has asked for before
                text = different(CLIENTS * n + number)
            job = {"kind": "compile", "number": n, "file": f"{number}.azee", "text": text}
            socket.send(json.dumps(job | {"tempo": 1 + n % 7 / 10}))
            draft = {"kind": "draft", "file": f"{number}.azee", "text": text, "number": n}
            socket.send(json.dumps(draft | {"digest": None}))
            if _ended(socket, n):
                counts[number] += 1
            else:
                unanswered[number] += 1


def _ended(socket: ClientConnection, number: int) -> bool:
    """Whether a text was signed; false where it was given up, or not answered in time."""
    from studio_server import received

    limit = time.monotonic() + ANSWER_S
    while (left := limit - time.monotonic()) > 0:
        try:
            header, _ = received(socket, left)
        except TimeoutError:
            return False
        if header.get("number") == number and header["kind"] in ("done", "stopped", "refused"):
            return bool(header["kind"] == "done")
    return False


def _memory_mb(process: int) -> list[float]:
    """Return the memory of a process, and of each that it started."""
    children = Path(f"/proc/{process}/task/{process}/children").read_text().split()
    found = []
    for pid in (str(process), *children):
        status = Path(f"/proc/{pid}/status").read_text()
        resident = re.search(r"VmRSS:\s+(\d+)", status)
        found.append(int(resident[1]) / 1000 if resident else 0.0)
    return found


if __name__ == "__main__":
    main()
