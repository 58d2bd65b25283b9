"""Draws the moving picture of README.md: "not a tree but a wardrobe", as an animated WebP.

The picture repeats without a jump: over the last half second, the clip approaches its first
posture, from which breathing and swaying have moved it by then.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from PIL import Image

import azee
from azee.clip.clip import Clip
from azee.clip.resample import at_rate
from azee.export.files import replace_path
from azee.export.pictures.scene import Look, Scene

HERE = Path(__file__).parent
SOURCE = HERE.parent / "examples" / "not-but" / "inline.azee"
PICTURE = HERE / "pictures" / "readme.webp"
FPS = 15.0
CLOSING_S = 0.5
"""How long before its end the clip begins to approach its first posture."""
LOOK = Look(size=(440, 500), shots=("front",), samples=3)


def closed(clip: Clip) -> Clip:
    """Return a clip whose last frame is its first one; the way there is by minimum jerk."""
    u = np.clip(1.0 - (clip.times[-1] - clip.times) / CLOSING_S, 0.0, 1.0)[:, None]
    share = u**3 * (10.0 - 15.0 * u + 6.0 * u**2)
    coordinates, weights = (
        values + share * (values[0] - values[-1])
        for values in (clip.coordinates, clip.unit_weights)
    )
    return replace(clip, coordinates=coordinates, unit_weights=weights)


def main() -> None:
    """Compile the sentence and write the picture."""
    made = azee.compile(SOURCE)
    clip = closed(at_rate(made.clip, FPS, made.rig.coordinates))
    scene = Scene(clip, made.rig, LOOK)
    # The last frame is the first one again: it is left out.
    shown = range(len(clip.times) - 1)
    first, *others = [Image.fromarray(pixels) for pixels in scene.frames(shown)]
    starts_ms = np.rint(1e3 * np.arange(len(shown) + 1) / FPS).astype(int)
    with replace_path(PICTURE) as part:
        first.save(
            part,
            format="WEBP",
            save_all=True,
            append_images=others,
            duration=[int(after - before) for before, after in pairwise(starts_ms)],
            loop=0,
            quality=80,
            method=6,
        )


if __name__ == "__main__":
    main()
