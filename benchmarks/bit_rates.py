"""Measures how many bytes a frame of motion takes in each format (Gürel 2010, section 6).

`python benchmarks/run.py bit-rates`. The thesis counts 123 parameters of 8 bytes, 984 bytes a
frame, and 606,144 bit/s at 77 frames a second, 157,440 at 20, beside a video of 400 × 600 pixels
with 24 bits each at 20 frames a second, 115,200,000 bit/s. Here one text is compiled and written
to every format of a clip, and the film that the same clip is.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import azee
from azee.formats import CLIP_WRITERS, FILM_SUFFIXES

TEXT = "seq(list(:bonjour, :bien, :arbre))"
PUBLISHED_B, PUBLISHED_HZ = 984, (77, 20)
VIDEO_BITS = 400 * 600 * 24 * 20


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    made = azee.compile(expression=TEXT)
    frames, lasts_s = len(made.clip.times), made.clip.duration_s
    print(f"{frames} frames, {lasts_s:.1f} s at {made.report.fps:g} frames/s")
    print(f"{'':<34}{'byte/frame':>11}{'bit/s':>13}")
    for hz in PUBLISHED_HZ:
        _row(f"thesis, 123 parameters at {hz} Hz", PUBLISHED_B, PUBLISHED_B * 8 * hz)
    _row("thesis, raw video at 20 Hz", VIDEO_BITS / 8 / 20, VIDEO_BITS)
    numbers = made.clip.coordinates.shape[1] + len(made.clip.units)
    raw = 8 * numbers
    _row(f"ours, {numbers} numbers of 8 bytes", raw, raw * 8 * made.report.fps)
    with TemporaryDirectory() as folder:
        for suffix in (*CLIP_WRITERS, *FILM_SUFFIXES):
            path = Path(folder) / f"x{suffix}"
            made.save(path)
            size = path.stat().st_size
            _row(f"ours, {suffix}", size / frames, 8 * size / lasts_s)


def _row(what: str, frame_b: float, bits: float) -> None:
    print(f"{what:<34}{frame_b:>11,.0f}{bits:>13,.0f}")


if __name__ == "__main__":
    main()
