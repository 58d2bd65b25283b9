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
SAME_RAD = np.radians(3.0)
SAME_WEIGHT = 0.2
"""Up to which postures and faces look the same."""


def write_png(clip: Clip, rig: Rig, path: str | Path, moments: Sequence[float]) -> None:
    """Draw a clip at some moments (seconds, on its time line): a column each, a row per view.

    Raises: OSError: the file cannot be written.
    """
    from azee.export.picture import contact_sheet, picture

    frames = sorted({int(np.abs(clip.times - moment).argmin()) for moment in moments})
    chosen = even_choice(_different(clip, frames), MOST)
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


def _different(clip: Clip, frames: Sequence[int]) -> list[int]:
    """Leave out frames that show what the frame before showed: a posture that is held."""
    chosen: list[int] = []
    for frame in frames:
        if chosen:
            turned = np.abs(clip.coordinates[frame] - clip.coordinates[chosen[-1]]).max()
            shaped = np.abs(clip.unit_weights[frame] - clip.unit_weights[chosen[-1]])
            if turned < SAME_RAD and shaped.max(initial=0) < SAME_WEIGHT:
                continue
        chosen.append(frame)
    return chosen


def even_choice(frames: Sequence[int], most: int) -> list[int]:
    """Return at most `most` of the frames, first and last among them, evenly spread."""
    if len(frames) <= most:
        return list(frames)
    places = np.linspace(0, len(frames) - 1, most).round().astype(int)
    return [frames[i] for i in places]
