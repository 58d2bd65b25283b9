"""Films every example, through the command that a reader would type, and draws its key postures.

The film shows the signer from the front and from the side; the sheet beside it has the key
postures and what is half-way between them, for looking at what the film is too quick for.
"""

from __future__ import annotations

import argparse
import os
import shlex
import sys
import time
from pathlib import Path

from build import examples

from azee.cli.main import run


def command(source: Path, out: Path) -> list[str]:
    """Return the arguments of `azee` that film an example."""
    film = out / source.parent.name / f"{source.stem}.mp4"
    cameras = ["--camera", "front", "--camera", "side"]
    outputs = ["-o", str(film), "-o", str(film.with_suffix(".png")), "--sheet"]
    return ["render", os.path.relpath(source), *cameras, *outputs]


def main() -> int:
    """Film what is asked for; returns the first exit code that is not zero."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="where the films go")
    parser.add_argument("--only", metavar="FOLDER", help="only the examples of one folder")
    options = parser.parse_args()
    chosen = [source for source in examples() if options.only in (None, source.parent.name)]
    if not chosen:
        parser.error(f"there is no example `{options.only}`")
    for source in chosen:
        (options.out / source.parent.name).mkdir(parents=True, exist_ok=True)
        arguments = command(source, options.out)
        print(f"$ azee {shlex.join(arguments)}", flush=True)
        began = time.perf_counter()
        if code := run(arguments):
            return code
        print(f"  took {time.perf_counter() - began:.1f} s\n", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
