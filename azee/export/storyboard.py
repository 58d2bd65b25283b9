"""A clip as one picture: the signer at its key postures, from the front and from the side."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from azee.export.files import replace_file
from azee.motion.clip import Clip
from azee_rig.rig import Rig

VIEWS = ("front", "side")
MOST = 8
"""Moments in one picture; of more, an even choice is shown."""
SIZE = (360, 450)


def write_png(clip: Clip, rig: Rig, path: str | Path, moments: Sequence[float]) -> None:
    """Draw a clip at some moments (seconds, on its time line): a column each, a row per view.

    Raises: OSError: the file cannot be written.
    """
    from azee.export.picture import contact_sheet, picture

    chosen = even_choice(sorted({_frame(clip, moment) for moment in moments}), MOST)
    pictures = []
    for view in VIEWS:
        for frame in chosen:
            units = dict(zip(clip.units, clip.unit_weights[frame], strict=True))
            image = picture(rig, clip.coordinates[frame], view, units, SIZE)
            pictures.append((f"{clip.times[frame]:.2f} s, {view}", image))
    data = io.BytesIO()
    contact_sheet(pictures, columns=len(chosen)).save(data, "PNG", optimize=True)
    with replace_file(path) as file:
        file.write(data.getvalue())


def _frame(clip: Clip, moment: float) -> int:
    return int(np.abs(clip.times - moment).argmin())


def even_choice(frames: Sequence[int], most: int) -> list[int]:
    """Return at most `most` of the frames, first and last among them, evenly spread."""
    if len(frames) <= most:
        return list(frames)
    places = np.linspace(0, len(frames) - 1, most).round().astype(int)
    return [frames[i] for i in places]
