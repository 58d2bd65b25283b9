"""Draws the pictures of pictures-and-films.md and motion.md, through the commands they show."""

from __future__ import annotations

import sys
from pathlib import Path

from azee.cli.main import run

HERE = Path(__file__).parent
SOURCE = HERE.parent / "examples" / "not-but" / "not-but.azee"


def main() -> int:
    """Draw them; returns the first exit code that is not zero."""
    sheet, tracks, flat = (
        str(HERE / "pictures" / f"not-but-{name}.png") for name in ("sheet", "tracks", "flat")
    )
    score = ["score", str(SOURCE), "--tracks"]
    return (
        run(["render", str(SOURCE), "-o", sheet, "--sheet", "--size", "500x400"])
        or run([*score, "-o", tracks])
        or run([*score, "-o", flat, "--mode", "flat"])
    )


if __name__ == "__main__":
    sys.exit(main())
