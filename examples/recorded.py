"""The examples of recorded signs: a database is made, and played, by the commands on their pages.

`python examples/recorded.py --out OUT [--only FOLDER] [--film] [--keep-pictures]`.
"""

from __future__ import annotations

import argparse
import os
import re
import shlex
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

from build import HERE, typed

FOLDERS = ("recorded-tree", "letters-l-j")


def commands(folder: str) -> Iterator[list[str]]:
    """Yield the arguments of `azee` on the page of an example, in order."""
    page = (HERE / folder / "README.md").read_text(encoding="utf-8")
    for line in re.findall(r"^    azee (.*)$", page, re.M):
        yield shlex.split(line)


def main() -> int:
    """Run what is asked for; returns the first exit code that is not zero."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="where the outputs go")
    parser.add_argument("--only", choices=FOLDERS, help="only one example")
    parser.add_argument("--film", action="store_true", help="also make a film of each")
    parser.add_argument("--keep-pictures", action="store_true", help="refresh their pictures")
    options = parser.parse_args()
    for folder in [options.only] if options.only else FOLDERS:
        out = (options.out / folder).resolve()
        out.mkdir(parents=True, exist_ok=True)
        for left in out.glob("*.db*"):
            left.unlink()
        os.chdir(out)
        if not Path("examples").exists():
            Path("examples").symlink_to(HERE.resolve())
        for arguments in commands(folder):
            film = ["-o", f"{folder}.mp4"] if options.film and "-o" in arguments else []
            if code := typed([*arguments, *film], out):
                return code
        if options.keep_pictures:
            shutil.copyfile(out / f"{folder}.png", HERE.resolve() / folder / f"{folder}.png")
        os.chdir(HERE.resolve().parent)
    return 0


if __name__ == "__main__":
    sys.exit(main())
