"""A sheet of signs: each at one moment, from the front, with its name."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from azee.clip.clip import Clip
from azee.export.files import replace_path
from azee_rig.rig import Rig

SIZE = (300, 340)
COLUMNS = 6


@dataclass(frozen=True, slots=True)
class Shown:
    """A clip to be shown at a moment, in seconds on its time line."""

    title: str
    clip: Clip
    rig: Rig
    moment_s: float


def write_sheet(shown: Sequence[Shown], path: str | Path) -> None:
    """Draw clips beside each other.

    Raises: OSError: the file cannot be written.
    """
    from azee.export.pictures.picture import contact_sheet, picture

    pictures = []
    for one in shown:
        clip = one.clip
        frame = int(abs(clip.times - one.moment_s).argmin())
        units = dict(zip(clip.units, clip.unit_weights[frame], strict=True))
        image = picture(one.rig, clip.coordinates[frame], "front", units, SIZE)
        pictures.append((one.title, image))
    with replace_path(path) as part:
        contact_sheet(pictures, columns=min(COLUMNS, len(pictures))).save(part, "PNG")
