"""A clip as one picture: the signer at its key postures, from the front and from the side."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.export.files import replace_file
from azee_rig.rig import Rig

VIEWS = ("front", "side")
MOST = 8
"""The most moments in a picture; of more, those that differ most from each other are shown."""
SIZE = (360, 450)
SAME_RAD = np.radians(3.0)
"""Up to this difference in any one joint, postures look the same."""
FACE_RAD = np.radians(15.0)
"""The turn of a joint that counts as much as a face unit of full weight."""


def write_png(clip: Clip, rig: Rig, path: str | Path, moments: Sequence[float]) -> None:
    """Draw a clip at some moments (seconds, on its time line): a column each, a row per view.

    Raises: OSError: the file cannot be written.
    """
    from azee.export.pictures.picture import contact_sheet, picture

    chosen = telling_frames(clip, moments, MOST)
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


def telling_frames(
    clip: Clip, moments: Sequence[float], most: int, second_rad: float = 0.0
) -> list[int]:
    """Choose, of the frames at some moments (seconds), those that differ most from each other.

    Of all frames where there are no moments, as in a text that only shakes a head.

    Args: second_rad: the turn that a second between two postures counts as.
    """
    frames = sorted({int(np.abs(clip.times - moment).argmin()) for moment in moments})
    frames = frames or [*range(len(clip.times))]
    late = second_rad * clip.times[:, None]
    shapes = np.hstack([clip.coordinates, FACE_RAD * clip.unit_weights, late])[frames]
    return [frames[i] for i in telling(shapes, most)]


def telling(shapes: NDArray[np.float64], most: int) -> list[int]:
    """Choose the first posture, then again and again the one least like those chosen.

    Args: shapes: (n, D) radians, in order of time. Returns: at most `most` indices, in order; of
        postures that look the same only the first.
    """
    chosen = [0]
    unlike = np.abs(shapes - shapes[0]).max(axis=1, initial=0.0)
    while len(chosen) < most and unlike.max() > SAME_RAD:
        chosen.append(int(unlike.argmax()))
        unlike = np.minimum(unlike, np.abs(shapes - shapes[chosen[-1]]).max(axis=1))
    return sorted(chosen)
