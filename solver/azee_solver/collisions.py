"""Capsules of the body that a problem must keep apart, and where touching is meant."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_rig.chain import Frames
from azee_solver.anatomy import Anatomy, Part, part_of
from azee_solver.binding import Binding
from azee_solver.constraint import Constraint, Place
from azee_solver.geometry import Site, SitePoint
from azee_solver.program import Collisions

if TYPE_CHECKING:
    from azee_rig.rig import Rig

Array = NDArray[np.float64]

SLACK_M, CONTACT_SLACK_M = 0.002, 0.005
"""Capsules only approach the skin, and skin gives way: so much more overlap is forgiven where a
site is placed on a site, and where the text calls it a contact."""
NEAR_M = 0.03
"""Capsules nearer to a contact than this take part in it."""


@dataclass(frozen=True, slots=True)
class Overlap:
    """Two capsules of the body that overlap deeper than a meant contact accounts for."""

    first: str
    second: str
    depth_m: float


class Obstacles:
    """All pairs of capsules that must not overlap, for the constraints of one moment.

    pairs: (P, 2). Placing a site on a site means contact there. Where a capsule stands out beyond
    the skin at the contact, as much overlap is allowed with all that lies around it; on the whole
    hand, where the text calls it a contact.
    """

    def __init__(
        self, binding: Binding, anatomy: Anatomy, constraints: Sequence[Constraint]
    ) -> None:
        self.binding, self.rig = binding, binding.rig
        capsules = self.rig.capsules
        self.pairs: NDArray[np.int64] = np.vstack([capsules.pairs, capsules.finger_pairs])
        nodes = capsules.node[self.pairs]
        self.radii: Array = capsules.radius[self.pairs].sum(axis=1)
        self._relative: NDArray[np.bool_] = anatomy.moves[nodes[:, 0]] ^ anatomy.moves[nodes[:, 1]]
        """(P, V) whether a coordinate moves one of the two, not both alike."""
        self._let_fingers_touch(anatomy)
        self._contacts = list(_contacts(constraints))
        self._near: dict[Site, NDArray[np.bool_]] = {}
        """(K,) capsules that may take part in a contact."""
        for a, b, slack in self._contacts:
            for site in (a, b):
                near = self._around(site, anatomy, wide=slack == CONTACT_SLACK_M)
                self._near[site] = near | self._near.get(site, np.False_)

    def _let_fingers_touch(self, anatomy: Anatomy) -> None:
        """Fingers of one hand lie side by side when they are straight: no nearer than that."""
        others = np.ones(len(self.rig.coordinates), dtype=np.bool_)
        others[list(anatomy.of(Part.HAND))] = False
        same = ~(self._relative & others).any(axis=1)
        straight = self.rig.chain.frames(np.zeros(len(self.rig.coordinates)))
        self.radii[same] = np.minimum(self.radii[same], self.distances(straight)[same])

    def for_problem(
        self, frames: Frames, free: Iterable[int], unsettled: Iterable[int]
    ) -> Collisions:
        """Pairs whose distance the free coordinates change.

        Args: frames: the posture at hand, one. unsettled: coordinates that a later problem will
            move: what they carry is not yet in the way.
        """
        mine, later = list(free), list(unsettled)
        chosen: NDArray[np.bool_] = np.logical_and(
            self._relative[:, mine].any(axis=1), ~self._relative[:, later].any(axis=1)
        )
        return Collisions(self.pairs[chosen], self.radii[chosen] - self._allowance(frames, chosen))

    def _allowance(self, frames: Frames, chosen: NDArray[np.bool_]) -> Array:
        """Overlap that meant contacts make up, per chosen pair, (n,) metres."""
        pairs = self.pairs[chosen]
        allowed = np.zeros(len(pairs))
        for a, b, slack in self._contacts:
            if not (self._near[a][pairs] & self._near[b][pairs[:, ::-1]]).any():
                continue
            first, second = self._depth(a, frames), self._depth(b, frames)
            for i, j in ((0, 1), (1, 0)):
                out, other = first[pairs[:, i]], second[pairs[:, j]]
                near = (out > -NEAR_M) & (other > -NEAR_M)
                depth = np.maximum(out, 0.0) + np.maximum(other, 0.0) + slack
                allowed = np.maximum(allowed, np.where(near, depth, 0.0))
        return allowed

    def _around(self, site: Site, anatomy: Anatomy, *, wide: bool) -> NDArray[np.bool_]:
        """Capsules of a site's bone and of those before and after it; wide: of all beyond it."""
        node, parents = self.binding.site(site).node, self.rig.chain.parents
        on = self.rig.capsules.node
        near = (on == node) | (on == parents[node]) | (parents[on] == node)
        if wide and part_of(self.binding.site(site).bone) in (Part.ARM, Part.HAND):
            near |= np.array([anatomy.is_above(node, int(n)) for n in on])
        return np.asarray(near)

    def _depth(self, site: Site, frames: Frames) -> Array:
        """How deep a site lies in each capsule of its bone or the next ones, (K,); else −∞."""
        bound, capsules = self.binding.site(site), self.rig.capsules
        depth = np.full(len(capsules.node), -np.inf)
        point = frames.positions[bound.node] + frames.rotations[bound.node] @ bound.position
        for c in np.flatnonzero(self._near[site]):
            a, b = _ends(self.rig, frames, int(c))
            depth[c] = capsules.radius[c] - _to_segment(point, a, b)
        return depth

    def overlaps(self, frames: Frames) -> tuple[Overlap, ...]:
        """Pairs that overlap in a posture, deepest first."""
        names = self.rig.capsules.names
        every = np.ones(len(self.pairs), dtype=np.bool_)
        excess = self.radii - self._allowance(frames, every) - self.distances(frames)
        order = [int(n) for n in np.argsort(-excess, kind="stable") if excess[n] > 0]
        return tuple(
            Overlap(names[self.pairs[n, 0]], names[self.pairs[n, 1]], float(excess[n]))
            for n in order
        )

    def distances(self, frames: Frames) -> Array:
        """Distance of the axes of each pair in a posture, (P,) metres."""
        count = range(len(self.rig.capsules.names))
        ends = np.array([_ends(self.rig, frames, c) for c in count])
        p, q = ends[self.pairs[:, 0]], ends[self.pairs[:, 1]]
        return segment_distance(p[:, 0], p[:, 1], q[:, 0], q[:, 1])


def _contacts(constraints: Sequence[Constraint]) -> Iterable[tuple[Site, Site, float]]:
    """Sites that are meant to touch, with the overlap that is forgiven."""
    places = [c for c in constraints if isinstance(c, Place)]
    for place in places:
        if isinstance(place.point, SitePoint):
            slack = CONTACT_SLACK_M if place.contact else SLACK_M
            yield place.site, place.point.site, slack
    for one, other in combinations(places, 2):
        if one.point == other.point and one.distance_m == other.distance_m == 0.0:
            yield one.site, other.site, SLACK_M


def _ends(rig: Rig, frames: Frames, c: int) -> tuple[Array, Array]:
    capsules = rig.capsules
    node = capsules.node[c]
    o, R = frames.positions[node], frames.rotations[node]
    return o + R @ capsules.a[c], o + R @ capsules.b[c]


def _to_segment(p: Array, a: Array, b: Array) -> float:
    along = b - a
    square = float(along @ along)
    t = min(max(float((p - a) @ along) / square, 0.0), 1.0) if square > 0 else 0.0
    return float(np.linalg.norm(p - a - t * along))


def segment_distance(p0: Array, p1: Array, q0: Array, q1: Array) -> Array:
    """Distance of segments, (n,): the least of the interior solution and the four ends'."""
    u, v, w = p1 - p0, q1 - q0, p0 - q0
    a, b, c = (np.sum(x * y, axis=-1) for x, y in ((u, u), (u, v), (v, v)))
    d, e = np.sum(u * w, axis=-1), np.sum(v * w, axis=-1)

    def clip(top: Array, bottom: Array) -> Array:
        return np.clip(np.where(bottom > 0, top / np.where(bottom > 0, bottom, 1.0), 0.0), 0, 1)

    inner = clip(b * e - c * d, a * c - b * b)
    candidates = [
        (inner, clip(b * inner + e, c)),
        *((clip(t * b - d, a), t) for t in (np.zeros(len(a)), np.ones(len(a)))),
        *((s, clip(s * b + e, c)) for s in (np.zeros(len(a)), np.ones(len(a)))),
    ]
    gaps = [np.linalg.norm(w + s[:, None] * u - t[:, None] * v, axis=-1) for s, t in candidates]
    return np.asarray(np.min(gaps, axis=0))
