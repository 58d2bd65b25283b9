"""Films every example, through the command that a reader would type, and draws its key postures.

The film shows the signer from the front and from the side; the sheet beside it has the key
postures and what is half-way between them, for looking at what the film is too quick for.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

from build import asking, chosen, typed


def command(source: Path, out: Path) -> list[str]:
    """Return the arguments of `azee` that film an example."""
    film = out / source.parent.name / f"{source.stem}.mp4"
    cameras = ["--camera", "front", "--camera", "side"]
    outputs = ["-o", str(film), "-o", str(film.with_suffix(".png")), "--sheet"]
    return ["render", os.path.relpath(source), *cameras, *outputs]


def main() -> int:
    """Film what is asked for; returns the first exit code that is not zero."""
    parser = asking(__doc__)
    options = parser.parse_args()
    for source in chosen(parser, options):
        if code := typed(command(source, options.out), options.out / source.parent.name):
            return code
    return 0


if __name__ == "__main__":
    sys.exit(main())
