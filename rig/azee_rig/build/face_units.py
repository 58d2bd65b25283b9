"""Face units that AZee's morphs need and the source body lacks, and lids that avoid the eyes.

The source has one unit for the tongue, out, and one that puffs both cheeks. The others are made
here on the same mesh: the tongue lifted, lowered, widened or pressed into a cheek, and the muscle
that a clenched jaw shows (the masseter, between cheekbone and corner of the jaw).

Units that raise a cheek or narrow an eye move skin through the eyeball, in particular if several
add up: a smile that reaches the eyes has three of them. Here the skin slides over the eyeball.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.clothes import smooth_step
from azee_rig.build.makehuman import Body

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

TIP_UP_M, TIP_BACK_M = 0.015, 0.0
TIP_DOWN_M = 0.014
BACK_UP_M = 0.014
WIDER = 0.45
"""Share of its width by which the tongue widens."""
BULGE_M, BULGE_RADIUS_M = 0.009, 0.015
CHEEK = (0.72, -0.98, 0.1)
MASSETER = (1.1, -1.12, -0.72)
"""From the middle between the eyes to the left, up and forward, in distances between the eyes."""
CLENCH_M, CLENCH_RADIUS_M = 0.0055, 0.016

SLIDING = ("cheekSquint", "eyeSquint", "mouthSmile", "noseSneer", "mh_mouth-corner-puller")
"""Prefixes of units that must not move skin into an eye."""
LID_M, ROUND_EYE_M = 0.004, 0.03
"""Skin within this distance of the eyeball comes no nearer; skin farther off is not examined."""


def made_units(body: Body, eyes: Floats) -> Mapping[str, tuple[Ints, Floats]]:
    """Return units as vertex indices and displacements in metres, like those of the body.

    Args: eyes: (2, 3) places of the eyes, left first.
    """
    tongue = body.vertices_of("helper-tongue")
    at = body.vertices[tongue]
    forward = (at[:, 2] - at[:, 2].min()) / np.ptp(at[:, 2])
    tip = smooth_step(0.45, 1.0, forward)
    hump = smooth_step(0.0, 0.35, forward) * smooth_step(0.85, 0.4, forward)
    up, ahead, aside = np.eye(3)[1], np.eye(3)[2], np.eye(3)[0]
    units = {
        "tongueUp": (tongue, tip[:, None] * (TIP_UP_M * up - TIP_BACK_M * ahead)),
        "tongueDown": (tongue, smooth_step(0.2, 0.8, forward)[:, None] * (-TIP_DOWN_M * up)),
        "tongueBackUp": (tongue, hump[:, None] * (BACK_UP_M * up)),
        "tongueWide": (tongue, (WIDER * tip * at[:, 0])[:, None] * aside),
    }
    skin = body.vertices_of("body")
    sides = (("Left", 1.0), ("Right", -1.0))
    for name, sign in sides:
        out = np.array([0.85 * sign, 0.0, 0.53])
        units[f"cheekBulge{name}"] = _swelling(
            body, skin, _place(eyes, CHEEK, sign), BULGE_RADIUS_M, BULGE_M * out
        )
    clench = [
        _swelling(
            body, skin, _place(eyes, MASSETER, sign), CLENCH_RADIUS_M, CLENCH_M * sign * aside
        )
        for _, sign in sides
    ]
    units["jawClench"] = (
        np.concatenate([rows for rows, _ in clench]),
        np.concatenate([moved for _, moved in clench]),
    )
    return units


def over_eyes(body: Body, eyes: Floats) -> Mapping[str, tuple[Ints, Floats]]:
    """Return the body's shapes, some of them bent around the eyes.

    Each place of skin ends no nearer to the middle of the eyeball than it began. Sums of such moves
    stay outside too, since they add up along the tangent.
    """
    shapes = dict(body.shapes)
    for name in [unit for unit in shapes if unit.startswith(SLIDING)]:
        rows, moved = shapes[name]
        at = body.vertices[rows]
        for eye, ball in zip(eyes, ("helper-l-eye", "helper-r-eye"), strict=True):
            surface = body.vertices[body.vertices_of(ball)]
            radius = float(np.linalg.norm(surface - eye, axis=1).max())
            before = np.linalg.norm(at - eye, axis=1)
            least = np.where(before < ROUND_EYE_M, np.minimum(before, radius + LID_M), 0.0)
            after = np.linalg.norm(at + moved - eye, axis=1)
            out = np.maximum(after, least) / after
            moved = eye + (at + moved - eye) * out[:, None] - at
        shapes[name] = rows, moved
    return shapes


def _place(eyes: Floats, steps: tuple[float, float, float], sign: float) -> Floats:
    apart = float(np.linalg.norm(eyes[0] - eyes[1]))
    return np.asarray(eyes.mean(axis=0) + apart * np.array(steps) * (sign, 1.0, 1.0))


def _swelling(
    body: Body, skin: Ints, near: Floats, radius_m: float, moved: Floats
) -> tuple[Ints, Floats]:
    """Return skin that swells around its place nearest to `near`, whose middle moves by `moved`."""
    at = body.vertices[skin]
    middle = at[np.linalg.norm(at - near, axis=1).argmin()]
    apart = np.linalg.norm(at - middle, axis=1)
    share = np.exp(-((apart / radius_m) ** 2))
    rows = np.flatnonzero(share > 0.01)
    return skin[rows], share[rows, None] * moved
