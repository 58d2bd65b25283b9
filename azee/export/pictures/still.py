"""Stills of a clip: some moments side by side, or a sheet of its key postures."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from PIL import Image

from azee.clip.clip import Clip
from azee.clip.resample import sampled
from azee.export.files import replace_file
from azee.export.pictures.picture import CAPTION_LEFT, CAPTION_PX, contact_sheet
from azee.export.pictures.scene import Look, Scene
from azee.export.pictures.storyboard import telling_frames
from azee.export.pictures.typeface import fitted, typeface
from azee_rig.rig import Rig

MOST = 12
"""The most key postures on a sheet; of more, those that differ most from each other are shown."""
SECOND_RAD = 1.5
"""The turn that a second counts as, so that the sheet has postures of all times."""
UPRIGHT = 0.8
"""Width by height of a picture on a sheet."""
WIDEST = 1800
"""Pixels in a row of a sheet, unless one picture alone is wider."""


def write_moments(
    clip: Clip, rig: Rig, path: str | Path, look: Look, moments: Sequence[float]
) -> None:
    """Draw a clip at some times, seconds, side by side, each as large as the look says.

    Raises: KeyError: no such camera. OSError.
    """
    images = _drawn(clip, rig, look, moments)
    width, height = look.size
    whole = Image.new(images[0].mode, (width * len(images), height))
    for i, image in enumerate(images):
        whole.paste(image, (i * width, 0))
    _write(whole, path)


def write_sheet(
    clip: Clip, rig: Rig, path: str | Path, look: Look, key_times: Sequence[float] | None = None
) -> None:
    """Draw the key postures, and the postures half-way between them, as rows of upright pictures.

    The idle postures in which a score begins and ends, and the ways from and to them, are left out.

    Args: look: gives the cameras, and twice the height of a picture. key_times: of the key
        postures; without any, both ends and the moments of least movement are taken.
    Raises: KeyError: no such camera. OSError.
    """
    keys = key_times or resting_times(clip)
    chosen = [float(clip.times[i]) for i in telling_frames(clip, keys, MOST, SECOND_RAD)]
    between = [(a + b) / 2 for a, b in pairwise(chosen)]
    times = sorted({*chosen, *between})
    height = max(160, look.size[1] // 2)
    size = round(UPRIGHT * height) * len(look.shots), height
    small = replace(look, size=size, transparent=False, captions=False)
    images = _drawn(clip, rig, small, times)
    captions = [
        f"{'key' if time in chosen else 'then'} {time:.2f} s  {running(clip, time)}"
        for time in times
    ]
    font, room = typeface(CAPTION_PX), size[0] - 2 * CAPTION_LEFT
    pictures = [
        (fitted(caption, font, room), image)
        for caption, image in zip(captions, images, strict=True)
    ]
    _write(contact_sheet(pictures, min(len(pictures), max(1, WIDEST // size[0]))), path)


def running(clip: Clip, time_s: float) -> str:
    """Name the innermost blocks that run at a time."""
    found = [x for x in clip.labels if x.start_s <= time_s < x.end_s]
    outer = {x.path[:n] for x in found for n in range(1, len(x.path))}
    return ", ".join(x.text for x in found if x.path not in outer)


def resting_times(clip: Clip) -> list[float]:
    """Return both ends, and the times between with less movement than around them."""
    if len(clip.times) < 3:
        return [float(time) for time in clip.times]
    speed = np.abs(np.gradient(clip.coordinates, clip.times, axis=0)).max(axis=1)
    inner = (speed[1:-1] <= speed[:-2]) & (speed[1:-1] < speed[2:])
    return [float(t) for t in clip.times[[0, *(np.flatnonzero(inner) + 1), -1]]]


def _drawn(clip: Clip, rig: Rig, look: Look, times: Sequence[float]) -> list[Image.Image]:
    """Return pictures at some times, in their order; cameras follow as in the film."""
    inside = np.clip(times, clip.times[0], clip.times[-1])
    whole = sampled(clip, np.union1d(clip.times, inside), rig.coordinates)
    scene = Scene(whole, rig, look)
    at = np.searchsorted(whole.times, inside)
    return [Image.fromarray(pixels) for pixels in scene.frames([int(i) for i in at])]


def _write(image: Image.Image, path: str | Path) -> None:
    data = io.BytesIO()
    image.save(data, "PNG", optimize=True)
    with replace_file(path) as file:
        file.write(data.getvalue())
