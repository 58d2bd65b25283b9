"""How fast signs of the lexicon become files, and how large: `benchmarks/run.py formats`.

Evenly chosen signs of the archive of NGT are compiled once. Then each format is written of each,
and its rate and size are printed, and what the whole lexicon would take.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import azee
from azee.clip.clip import Clip
from azee.clips import save_clip
from azee.lexicon.reading import read_bytes
from azee.lexicon.rule_text import rule_text
from azee_grammar.diagnostic import AZeeError
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from benchmarks.lexicon import ARCHIVE, signs_of

FORMATS = (".pose", ".vrma", ".glb", ".npz")


def clips(count: int, rig: Rig) -> tuple[list[Clip], int]:
    """Compile signs; returns their clips and the number of signs of the archive."""
    made: list[Clip] = []
    texts = signs_of(ARCHIVE)
    names = sorted(texts)
    for name in names[:: max(1, len(names) // count)][:count]:
        sign = next(read_bytes(texts[name], f"{name}.sigml")).sign
        if sign is None:
            continue
        rule = rule_text(sign, "sign", "benchmark").text
        try:
            made.append(azee.compile(f"{rule}\n:sign\n", rig).clip)
        except AZeeError as error:
            print(f"{name}: {error}")
    return made, len(names)


def main(arguments: Sequence[str]) -> None:
    """Print a line per format."""
    parser = argparse.ArgumentParser(prog="formats", description=__doc__)
    parser.add_argument("--sample", type=int, default=20, help="signs that are compiled")
    options = parser.parse_args(arguments)
    rig = load_rig()
    start = time.perf_counter()
    signs, whole = clips(options.sample, rig)
    took = time.perf_counter() - start
    seconds = sum(clip.duration_s for clip in signs)
    print(f"{len(signs)} signs, {seconds:.0f} s of signing, compiled in {took:.0f} s")
    with tempfile.TemporaryDirectory() as folder:
        for suffix in FORMATS:
            path, size, start = Path(folder) / f"sign{suffix}", 0, time.perf_counter()
            for clip in signs:
                save_clip(clip, rig, path)
                size += path.stat().st_size
            each = (time.perf_counter() - start) / len(signs)
            print(
                f"{suffix:6} {1.0 / each:6.1f} files a second, {size / len(signs) / 1e3:7.0f} kB "
                f"each; all {whole}: {each * whole:.0f} s, {size / len(signs) * whole / 1e6:.0f} MB"
            )


if __name__ == "__main__":
    main([])
