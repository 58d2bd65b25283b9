"""Faces of the facial rules at their apex: lids and lips never fold through each other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.lang.library import shipped_library
from azee.lang.program import evaluate_expression
from azee.motion.overlay.saturation import saturated
from azee.score.score import Key, leaves
from azee_rig.rig import Rig
from azee_solver.constraint import Morph

Floats = NDArray[np.float64]
Pairs = NDArray[np.int64]
FACES = sorted(
    rule.name
    for rule in shipped_library("core").namespace.rules.values()
    if rule.definition.span.source.name.endswith(("aspects.azee", "attitudes.azee"))
)
PUBLISHED = 23
OVERLAP_M = 1.2e-3
"""Lids that close a little farther than shut."""
PRESSED_M = 0.5e-3
"""Lips that overlap a little more than when pressed."""

each = pytest.mark.parametrize("face", FACES)


def _apex(face: str) -> dict[str, float]:
    """Every morph that a face asks for, at its largest weight."""
    out: dict[str, float] = {}
    for leaf in leaves(evaluate_expression(f":{face}(blank(1))").score):
        if isinstance(leaf.score, Key):
            for constraint in leaf.score.constraints:
                if isinstance(constraint, Morph):
                    weights = out.get(constraint.name, 0.0), constraint.weight
                    out[constraint.name] = max(weights, key=abs)
    assert out
    return out


def _shaped(rig: Rig, morphs: Mapping[str, float]) -> Floats:
    """Vertices of a body with a face as it is shown, (N, 3)."""
    weights = np.zeros((1, len(rig.units)))
    for morph, weight in morphs.items():
        for unit, share in rig.face_morphs[morph].items():
            weights[0, rig.units.index(unit)] += weight * share
    return rig.mesh.shaped(saturated(np.clip(weights, -1.0, 1.0), rig)[0])


def _skin(rig: Rig) -> NDArray[np.bool_]:
    (part,) = (p for p in rig.mesh.parts if p.name == "skin")
    out = np.zeros(len(rig.mesh.vertices), dtype=np.bool_)
    out[rig.mesh.triangles[part.start : part.stop]] = True
    return out


def _nearest(places: Floats, upper: Pairs, lower: Pairs, within_m: float) -> Pairs:
    apart = np.linalg.norm(places[upper, None] - places[None, lower], axis=2)
    near = apart.min(axis=1) < within_m
    return np.column_stack([upper[near], lower[apart.argmin(axis=1)[near]]])


def _lids(rig: Rig) -> Iterator[tuple[Pairs, Floats]]:
    """Edges of the upper lid and of the lower, and the height between them when shut."""
    for morph in ("AU43_L", "AU43_R"):
        shut = _shaped(rig, {morph: 1.0})
        down = np.where(_skin(rig), (shut - rig.mesh.vertices)[:, 1], 0.0)
        upper = np.nonzero(down < 0.8 * down.min())[0]
        still = np.nonzero(_skin(rig) & (down > 0.1 * down.min()))[0]
        pairs = _nearest(shut, upper, still, 6e-3)
        assert len(pairs) > 4
        yield pairs, _height(shut, pairs)


def _lips(rig: Rig) -> Pairs:
    parting = np.where(_skin(rig), (_shaped(rig, {"AU25_a": 1.0}) - rig.mesh.vertices)[:, 1], 0.0)
    upper = np.nonzero(parting > 0.5 * parting.max())[0]
    lower = np.nonzero(parting < 0.5 * parting.min())[0]
    pairs = _nearest(rig.mesh.vertices, upper, lower, 3e-3)
    assert len(pairs) > 10
    return pairs


def _height(places: Floats, pairs: Pairs) -> Floats:
    heights: Floats = places[pairs[:, 0], 1] - places[pairs[:, 1], 1]
    return heights


def test_all_published_faces_are_looked_at() -> None:
    assert len(FACES) == PUBLISHED


@each
@pytest.mark.parametrize("blink", [0.0, 0.5, 1.0])
def test_lids_do_not_go_past_shut(face: str, blink: float, signer: Rig) -> None:
    morphs = _apex(face)
    shown = _shaped(signer, morphs | {"AU43": max(blink, morphs.get("AU43", 0.0))})
    for pairs, shut in _lids(signer):
        assert (shut - _height(shown, pairs)).max() < OVERLAP_M


@each
def test_lips_do_not_go_past_pressed(face: str, signer: Rig) -> None:
    pairs = _lips(signer)
    pressed = _height(_shaped(signer, {"AU24": 1.0}), pairs).mean()
    assert _height(_shaped(signer, _apex(face)), pairs).mean() > pressed - PRESSED_M
