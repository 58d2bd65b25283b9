"""Which ways from letter to letter lead a finger into another: `benchmarks.spelled_pairs`.

Spells the pairs of letters of ASL that Wheatland (2016, appendix B) has recorded: K, M, N, P, R and
T with every letter, in both orders, and the pairs inside the words of objectives 3 to 5. On every
frame of the way it measures on the skin how deep each finger is in another one. What two fingers
have in one of the letters themselves, where they may touch, is not counted: tests/spelling has the
letters.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee.compilation import perform, score_of
from azee.lang.program import load
from azee.spelling.timing.published import FOUR, LONGER, THREE
from azee_grammar.source import Source
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver.penetration import mesh_penetration

ALPHABET = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
CLOSED = "KMNPRT"
"""Complex and closed handshapes, as appendix B has them."""
WAYS_S = (0.2, 0.083)
HOLD_S = 0.3
FPS = 60.0
SEEN_M = 0.003
"""Fingers that are deeper in each other than this are told."""
ROUNDING_M = 0.0005
DIGITS = ("thumb", "index", "middle", "ring", "little")


def pairs() -> tuple[str, ...]:
    """Return the pairs of appendix B, each once."""
    closed = [pair for c in CLOSED for x in ALPHABET for pair in (c + x, x + c)]
    inside = [a + b for word in (*THREE, *FOUR, *LONGER) for a, b in pairwise(word)]
    return tuple(dict.fromkeys((*closed, *inside)))


@dataclass(frozen=True, slots=True)
class Way:
    """A way from letter to letter: which fingers are deepest in each other, and how deep."""

    pair: str
    way_s: float
    fingers: str
    depth_mm: float


def spelled(pair: str, way_s: float, rig: Rig) -> tuple[NDArray[np.float64], slice]:
    """Spell a pair; return its postures (T, V), and those from the first letter to the second."""
    times = f"list(list({HOLD_S}, {way_s}), list({HOLD_S}, 0))"
    text = f":fingerspelling('text = \"{pair}\", 'language = 'asl, 'times = {times})"
    made = perform(score_of(load(Source(pair, text)), None, None), rig, life=False, fps=FPS)
    first = made.report.lead_s + HOLD_S
    last = made.report.lead_s + float(made.score.duration) - HOLD_S
    rows = np.flatnonzero((made.clip.times > first - 0.1) & (made.clip.times < last + 0.1))
    return made.clip.coordinates, slice(int(rows[0]), int(rows[-1]) + 1)


def depths(rig: Rig, q: NDArray[np.float64]) -> Mapping[tuple[str, str], float]:
    """Return how deep fingers of the strong hand are in each other in a posture, metres."""
    fingers = {f"{digit}_R" for digit in DIGITS}
    out: dict[tuple[str, str], float] = {}
    for found in mesh_penetration(rig, q, (), fingers):
        key = (min(found.limb, found.body), max(found.limb, found.body))
        out[key] = max(out.get(key, 0.0), found.depth_m)
    return out


def measured(pair: str, way_s: float, rig: Rig) -> Way:
    """Spell a pair and measure its way."""
    q, way = spelled(pair, way_s, rig)
    held = [depths(rig, q[way.start]), depths(rig, q[way.stop - 1])]
    worst, fingers = 0.0, ""
    for posture in q[way]:
        for key, depth in depths(rig, posture).items():
            touch = max(letter.get(key, 0.0) for letter in held)
            if depth > max(worst, touch + ROUNDING_M):
                worst, fingers = depth, f"{key[0][:-2]} {key[1][:-2]}"
    return Way(pair, way_s, fingers, 1000.0 * worst)


def ways(chosen: Sequence[str], times_s: Sequence[float], rig: Rig) -> Iterator[Way]:
    """Yield what is measured of pairs with ways of some lengths."""
    for way_s in times_s:
        for pair in chosen:
            yield measured(pair, way_s, rig)


def main(arguments: Sequence[str] | None = None) -> None:
    """Print how many ways lead fingers into fingers, and which."""
    parser = argparse.ArgumentParser(prog="spelled_pairs", description=__doc__)
    parser.add_argument("pairs", nargs="*", help="pairs such as AM; by default all")
    parser.add_argument("--way", type=float, nargs="*", default=WAYS_S, help="lengths, seconds")
    parser.add_argument("--every", type=int, default=1, help="measure every N-th pair only")
    parser.add_argument("--rig", default="signer")
    parser.add_argument("-o", dest="output", type=Path, metavar="FILE.json")
    options = parser.parse_args(arguments)
    chosen = options.pairs or pairs()[:: options.every]
    found = [*ways(chosen, options.way, load_rig(options.rig))]
    for way_s in options.way:
        own = [way for way in found if way.way_s == way_s]
        deep = sorted(
            (way for way in own if way.depth_mm > 1000.0 * SEEN_M), key=lambda way: -way.depth_mm
        )
        print(f"{way_s:g} s: {len(deep)} of {len(own)} ways deeper than {1000 * SEEN_M:g} mm")
        for way in deep:
            print(f"  {way.pair}  {way.fingers}: {way.depth_mm:.1f} mm")
    if options.output:
        rows = [asdict(way) for way in found]
        options.output.write_text(json.dumps(rows, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
