"""Compiles every example to every format, through the command that a reader would type.

An example is an .azee file in a folder here. Its outputs go to OUT/FOLDER; with --keep-pictures
the PNG is also kept in the example's folder, beside its source.
"""

from __future__ import annotations

import argparse
import os
import shlex
import shutil
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from azee.cli.main import run
from azee.formats import SUFFIXES

HERE = Path(__file__).parent


def examples() -> Iterator[Path]:
    """Yield the sources of all examples, by folder and name."""
    return iter(sorted(HERE.glob("*/*.azee")))


PRECISE = {"tree"}
"""Examples that meet everything that can be met, as the paper that they show does."""


def command(source: Path, out: Path) -> list[str]:
    """Return the arguments of `azee` that write an example in every format, and its report."""
    folder = out / source.parent.name
    names = [folder / f"{source.stem}{suffix}" for suffix in SUFFIXES]
    outputs = [argument for name in names for argument in ("-o", str(name))]
    return [
        "compile",
        os.path.relpath(source),
        *outputs,
        *(["--precise"] if source.stem in PRECISE else []),
        "--report",
        str(folder / f"{source.stem}.report.json"),
    ]


def asking(about: str | None) -> argparse.ArgumentParser:
    """Return a parser of what all scripts of this folder are asked."""
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("--out", type=Path, required=True, help="where the outputs go")
    parser.add_argument("--only", metavar="FOLDER", help="only the examples of one folder")
    return parser


def chosen(parser: argparse.ArgumentParser, options: argparse.Namespace) -> list[Path]:
    """Return the examples that are asked for; leaves with a message where there are none."""
    found = [source for source in examples() if options.only in (None, source.parent.name)]
    if not found:
        parser.error(f"there is no example `{options.only}`")
    return found


def typed(arguments: list[str], folder: Path) -> int:
    """Run a command that writes into a folder, and tell it; returns its exit code."""
    folder.mkdir(parents=True, exist_ok=True)
    print(f"$ azee {shlex.join(arguments)}", flush=True)
    began = time.perf_counter()
    code = run(arguments)
    if not code:
        print(f"  took {time.perf_counter() - began:.1f} s\n", flush=True)
    return code


def main() -> int:
    """Build what is asked for; returns the first exit code that is not zero."""
    parser = asking(__doc__)
    parser.add_argument(
        "--keep-pictures", action="store_true", help="refresh the folders' pictures"
    )
    options = parser.parse_args()
    for source in chosen(parser, options):
        folder = options.out / source.parent.name
        if code := typed(command(source, options.out), folder):
            return code
        if options.keep_pictures:
            name = source.with_suffix(".png").name
            shutil.copyfile(folder / name, source.with_suffix(".png"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
