"""The named sites of a body around a point."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_grammar import vocabulary
from azee_rig.chain import Frames
from azee_solver.anatomy import anatomy
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Side, Site

Array = NDArray[np.float64]

_SIDED = re.compile(r"(?P<name>.+?)_(?P<side>[LR])(?:_(?P<phalanx>[123]))?", re.ASCII)


@dataclass(frozen=True, slots=True, eq=False)
class NearSite:
    """A site, where it is, (3,) metres, its outward normal, (3,), and how far away, metres."""

    site: Site
    point: Array
    normal: Array
    distance_m: float


def site_of(key: str, dominant: Side) -> Site | None:
    """Return the site of a key such as `I_TIP_R`, its side as strong or weak.

    None for one that AZee does not name.
    """
    if key not in vocabulary.SITES:
        return None
    found = _SIDED.fullmatch(key)
    if found is None:
        return Site(key)
    side = Side.STRONG if found["side"] == dominant.value else Side.WEAK
    return Site(found["name"], side, int(found["phalanx"]) if found["phalanx"] else None)


class SiteMap:
    """The sites of a posture that stay where they are while some coordinates move."""

    def __init__(self, evaluator: Evaluator, frames: Frames, free: frozenset[int]) -> None:
        """Find them; free: coordinates whose sites are left out, for they go along."""
        rig, dominant = evaluator.rig, evaluator.binding.dominant
        moved = anatomy(rig.chain, rig.coordinates).moved_by(free)
        staying = {
            site: found
            for key, found in rig.sites.items()
            if not any(moved[node] for node in found.nodes)
            and (site := site_of(key, dominant)) is not None
        }
        self._sites = tuple(staying)
        self._points = np.array([found.point(frames) for found in staying.values()])
        self._normals = np.array([found.outward(frames) for found in staying.values()])

    def near(self, point: Array, within_m: float) -> list[NearSite]:
        """Return the sites within a distance of a point (3,), the nearest first."""
        if not self._sites:
            return []
        apart = np.linalg.norm(self._points - point, axis=1)
        return [
            NearSite(self._sites[i], self._points[i], self._normals[i], float(apart[i]))
            for i in np.argsort(apart, kind="stable")
            if apart[i] <= within_m
        ]
