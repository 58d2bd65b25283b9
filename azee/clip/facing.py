"""Turns head and trunk of a clip to the viewer (Gürel 2010, sections 3.2.3 and 5.1.2).

The thesis puts the root of every recording into the origin. A `Clip` has no root; what is left of a
signer who stood askew is a trunk or head that is turned or bent all the time. That mean is taken
away; movements about it stay.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from azee.clip.clip import Clip
from azee_rig.coordinates import Coordinates

TURNED = ("back_", "neck", "head")
"""Beginnings of the coordinates of trunk and head."""


def facing_viewer(
    clip: Clip, coordinates: Coordinates, start_s: float, end_s: float
) -> tuple[Clip, float]:
    """Return a clip in which trunk and head face the viewer on average, and the largest turn, rad.

    Args: start_s, end_s: of the part whose mean counts: what the sign means, without its ways.
    """
    inside = (clip.times >= start_s) & (clip.times <= end_s)
    if not inside.any():
        inside[int(np.abs(clip.times - (start_s + end_s) / 2).argmin())] = True
    turned = [v for v, name in enumerate(coordinates.names) if name.startswith(TURNED)]
    q = np.array(clip.coordinates)
    mean = q[inside][:, turned].mean(axis=0) - np.asarray(coordinates.idle)[turned]
    q[:, turned] = np.clip(
        q[:, turned] - mean, coordinates.lower[turned], coordinates.upper[turned]
    )
    return replace(clip, coordinates=q), float(np.abs(mean).max(initial=0.0))
