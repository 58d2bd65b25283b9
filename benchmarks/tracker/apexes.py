"""The facial rules at their apex, seen at several angles."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from azee.compilation import perform
from azee.export.pictures.camera import VIEWS, camera, from_direction
from azee.export.pictures.picture import render
from azee.lang.library import shipped_library
from azee.lang.program import evaluate_expression
from azee_rig.rig import Rig

Pictures = NDArray[np.uint8]

FILES = ("core/aspects.azee", "core/attitudes.azee")
APEX_S = 0.75
"""Half-way through a sign of a second, which begins .25 s after its face."""
ANGLES_DEG = ((0.0, 0.0), (-18.0, 0.0), (18.0, 0.0), (0.0, 12.0), (0.0, -12.0))
"""From where a face is seen, as if the head were turned: to its left and from above, degrees."""
SIZE = (384, 384)
"""Pixels."""
SAMPLES = 1


def facial_rules() -> Iterator[str]:
    """Yield the facial rules in the order of their names."""
    rules = shipped_library("core").namespace.rules.values()
    yield from sorted(r.name for r in rules if r.definition.span.source.name in FILES)


def apex(rig: Rig, name: str) -> dict[str, float]:
    """Return the weights of a facial rule at its strongest, over a sign that asks nothing."""
    score = evaluate_expression(f":{name}(blank(1))").score
    made = perform(score, rig, fps=30, life=False)
    frame = int(np.abs(made.clip.times - made.animation.lead_s - APEX_S).argmin())
    weights = made.clip.unit_weights[frame]
    return {unit: float(w) for unit, w in zip(made.clip.units, weights, strict=True)}


def seen_at_angles(rig: Rig, face: Mapping[str, float]) -> Pictures:
    """Draw a face, by weights, on a head that looks ahead, from `ANGLES_DEG`: (5, H, W, 3)."""
    q = rig.coordinates.idle
    weights = {unit: float(w) for unit, w in rig.lid_weights(q).items()}
    for unit, weight in face.items():
        weights[unit] = weights.get(unit, 0.0) + weight
    skin = rig.skin(rig.pose(q), weights)
    target, half_height = camera(rig, q, "face").target, VIEWS["face"][2]
    drawn = []
    for left, above in np.radians(ANGLES_DEG):
        towards = np.array(
            [np.sin(left) * np.cos(above), np.sin(above), np.cos(left) * np.cos(above)]
        )
        eye = from_direction(target, towards, half_height)
        drawn.append(np.asarray(render(skin, rig.mesh, eye, SIZE, samples=SAMPLES)))
    return np.stack(drawn)
