"""Makes a data set by one command: `python examples/dataset/make.py -o OUT`.

The 200 texts of `texts.py` × 4 bodies × 3 cameras × 2 speeds, by `azee batch`, with a data card.
Options after `--` are handed to `azee batch`, such as `--scheduler ADDRESS`. The same command goes
on where it was stopped.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2]))

from azee.cli.main import run
from azee.formats import CAMERA_WRITERS
from dataset.card import data_card
from dataset.texts import texts

BODIES = "signer,child,game,heavy"
CAMERAS = "front,three-quarter,side"
SPEEDS = "1,0.8"


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the data set; returns the exit code of `azee batch`."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-o", "--out", type=Path, required=True, help="the folder of the data set")
    parser.add_argument("--count", type=int, help="only the first texts")
    parser.add_argument("--bodies", default=BODIES)
    parser.add_argument("--cameras", default=CAMERAS)
    parser.add_argument("--speeds", default=SPEEDS)
    parser.add_argument("--formats", default="pose,bvh", help="by default %(default)s")
    parser.add_argument("more", nargs="*", help="options of azee batch, after --")
    chosen = parser.parse_args(arguments)
    chosen.out.mkdir(parents=True, exist_ok=True)
    source = chosen.out / "texts.jsonl"
    lines = [json.dumps(text, ensure_ascii=False) for text in texts()[: chosen.count]]
    source.write_text("\n".join(lines) + "\n", encoding="utf-8")
    varied = ["--bodies", chosen.bodies, "--speeds", chosen.speeds, "--formats", chosen.formats]
    if any(f".{name}" in CAMERA_WRITERS for name in chosen.formats.split(",")):
        varied += ["--cameras", chosen.cameras]
    code = run(["batch", str(source), "-o", str(chosen.out), *varied, *chosen.more])
    manifest = chosen.out / "manifest.jsonl"
    if manifest.exists():
        (chosen.out / "README.md").write_text(data_card(manifest), encoding="utf-8")
    return code


if __name__ == "__main__":
    sys.exit(main())
