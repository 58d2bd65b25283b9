"""What a tracker trained on people sees in our films, beside people: `make bench-tracker`.

Films every example and two longer texts (or what is named) into out/tracker, runs MediaPipe
Holistic over them in an environment of its own, and prints how often each hand that is in view is
found, and the speeds and stillness of wrists, head and shoulders: by the tracker's landmarks, by
our own joints in the same pictures, and of people by the same tracker and the same code.
"""

from __future__ import annotations

import argparse
import csv
import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path

from azee.compilation import score_of
from azee.lang.program import load
from azee.quality.signing_dynamics import SigningDynamics, WristSpeeds
from azee_rig.load import load_rig
from benchmarks.ik.elsewhere import NotThere
from benchmarks.likeness import PAGE, rewrite, texts
from benchmarks.penetration import EXAMPLES
from benchmarks.tracker.environment import OUT, interpreter, track
from benchmarks.tracker.filmed import filmed
from benchmarks.tracker.marks import draw
from benchmarks.tracker.seen import Seen, seen

PEOPLE = Path(__file__).with_name("people.csv")
FILMS = OUT / "tracker"
BEGIN, END = "<!-- table: written by `benchmarks.tracker --page` -->", "<!-- end of the table -->"
LONGER = ("brief", "greetings")
HEAD = (
    f"{'':<24}{'found':>9}{'':>6}{'apart':>7}{'':>6}{'wrist R':>10}{'':>6}{'wrist L':>10}{'':>6}"
    f"{'stopped':>10}{'head':>7}{'still':>7}{'shoulders':>11}\n"
    f"{'':<24}{'R':>5}{'L':>5}{'face':>6}{'R':>6}{'L':>6}{'median':>10}{'p95':>6}"
    f"{'median':>10}{'p95':>6}{'share':>9}{'cm/s':>8}{'s':>7}{'cm/s':>11}"
)


def all_found(names: Sequence[str]) -> Iterator[Seen]:
    """Film and track what is named, by default all examples and the longer texts.

    Raises: NotThere: there is no tracker.
    """
    wanted = names or [*(p.stem for p in sorted(EXAMPLES.glob("*/*.azee"))), *LONGER]
    python, rig = interpreter(), load_rig()
    for name, source in texts():
        if name not in wanted:
            continue
        stem = FILMS / name.strip(":")
        film = filmed(score_of(load(source), None, None), rig, stem.with_suffix(".mp4"))
        track(python, film.film, stem.with_suffix(".npz"))
        draw(film.film, stem.with_suffix(".npz"), stem.with_suffix(".png"))
        yield seen(name, film, stem.with_suffix(".npz"))


def _n(value: float | None, width: int, digits: int = 2) -> str:
    return f"{'–' if value is None else f'{value:.{digits}f}':>{width}}"


def _wrist(w: WristSpeeds | None) -> str:
    median, p95 = (None, None) if w is None else (w.median_m_s, w.p95_m_s)
    return f"{_n(median, 10)}{_n(p95, 6)}"


def _dynamics(d: SigningDynamics) -> str:
    return (
        f"{_wrist(d.right_wrist)}{_wrist(d.left_wrist)}{_n(d.both_stopped_share, 9)}"
        f"{_n(d.head_mean_cm_s, 8, 1)}{_n(d.head_longest_still_s, 7)}"
        f"{_n(d.shoulders_mean_cm_s, 11, 1)}"
    )


def lines(found: Sequence[Seen]) -> Iterator[str]:
    """Yield the lines of the table."""
    yield HEAD
    for s in found:
        hands = f"{_n(s.found['R'], 5)}{_n(s.found['L'], 5)}{_n(s.face, 6)}"
        apart = f"{_n(s.apart_cm['R'], 6, 1)}{_n(s.apart_cm['L'], 6, 1)}"
        yield f"{s.name:<24}{hands}{apart}{_dynamics(s.tracked)}"
        yield f"{'  by its joints':<24}{'':<28}{_dynamics(s.own)}"
    yield from people()


def people() -> Iterator[str]:
    """Yield the lines of recordings of people."""
    with PEOPLE.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            v = {k: float(text) if text else None for k, text in row.items() if k != "recording"}
            yield (
                f"{'person ' + row['recording']:<24}{'':<28}"
                f"{_n(v['wrist_R_median'], 10)}{_n(v['wrist_R_p95'], 6)}"
                f"{_n(v['wrist_L_median'], 10)}{_n(v['wrist_L_p95'], 6)}"
                f"{_n(v['both_stopped'], 9)}{_n(v['head_mean_cm_s'], 8, 1)}"
                f"{_n(v['head_still_s'], 7)}{_n(v['shoulders_cm_s'], 11, 1)}"
            )


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; 1 if there is no tracker."""
    parser = argparse.ArgumentParser(prog="bench-tracker", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="as of `run.py likeness --case`")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE.json", help="everything")
    parser.add_argument("--page", action="store_true", help=f"write the table into {PAGE.name}")
    options = parser.parse_args(arguments)
    try:
        found = [*all_found(options.names)]
    except NotThere as error:
        print(f"no tracker: {error}", file=sys.stderr)
        return 1
    told = "\n".join(lines(found))
    print(told)
    if options.page:
        rewrite(PAGE, BEGIN, END, f"```\n{told}\n```")
    if options.output:
        options.output.write_text(json.dumps([asdict(s) for s in found], indent=1), "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
