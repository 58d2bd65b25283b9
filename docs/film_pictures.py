"""Draws the pictures of pictures-and-films.md, through the commands that the page shows."""

from __future__ import annotations

import sys
from pathlib import Path

from azee.cli.main import run

HERE = Path(__file__).parent
SOURCE = HERE.parent / "examples" / "not-but" / "not-but.azee"


def main() -> int:
    """Draw them; returns the first exit code that is not zero."""
    sheet, tracks = (HERE / "pictures" / f"not-but-{name}.png" for name in ("sheet", "tracks"))
    size = ["--size", "500x400"]
    return run(["render", str(SOURCE), "-o", str(sheet), "--sheet", *size]) or run(
        ["score", str(SOURCE), "-o", str(tracks), "--tracks"]
    )


if __name__ == "__main__":
    sys.exit(main())
