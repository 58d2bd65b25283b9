"""Capsules of the body that a problem must keep apart, and where touching is meant."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
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


@dataclass(frozen=True, slots=True)
class Contact:
    """Two sites that are meant to touch.

    Capsules only approach the skin, and skin gives way: slack_m more overlap is forgiven there.
    Capsules nearer to the sites than near_m take part in it. wide: also those of all bones beyond
    the sites' own, such as the fingers of a palm.
    """

    first: Site
    second: Site
    slack_m: float = 0.002
    near_m: float = 0.03
    wide: bool = False

    @staticmethod
    def called(first: Site, second: Site, *, palms: tuple[bool, bool]) -> Contact:
        """Return one that the text calls a contact.

        A palm is hollow and soft: its edges stand out around what it touches. One that is laid on
        something may lie there with all its fingers.

        Args: palms: whether the sites are on palms.
        """
        slack_m = 0.009 if any(palms) else 0.004
        return Contact(first, second, slack_m, near_m=0.12 if palms[0] else 0.03, wide=palms[0])


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
        self.pairs, self.radii, self._relative = _pairs(self.rig, anatomy)
        self._contacts = list(self._meant(constraints))
        self._near: dict[Site, NDArray[np.bool_]] = {}
        """(K,) capsules that may take part in a contact."""
        for contact in self._contacts:
            for site in (contact.first, contact.second):
                near = self._around(site, anatomy, wide=contact.wide)
                self._near[site] = near | self._near.get(site, np.False_)

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
        for c in self._contacts:
            if not (self._near[c.first][pairs] & self._near[c.second][pairs[:, ::-1]]).any():
                continue
            first, second = self._depth(c.first, frames), self._depth(c.second, frames)
            for i, j in ((0, 1), (1, 0)):
                out, other = first[pairs[:, i]], second[pairs[:, j]]
                near = (out > -c.near_m) & (other > -c.near_m)
                depth = np.maximum(out, 0.0) + np.maximum(other, 0.0) + c.slack_m
                allowed = np.maximum(allowed, np.where(near, depth, 0.0))
        return allowed

    def _meant(self, constraints: Sequence[Constraint]) -> Iterable[Contact]:
        places = [c for c in constraints if isinstance(c, Place)]
        for place in places:
            if isinstance(place.point, SitePoint):
                first, second = place.site, place.point.site
                if place.contact:
                    one, other = (
                        self.binding.site(s).bone.startswith("palm") for s in (first, second)
                    )
                    yield Contact.called(first, second, palms=(one, other))
                else:
                    yield Contact(first, second)
        for a, b in combinations(places, 2):
            if a.point == b.point and a.distance_m == b.distance_m == 0.0:
                yield Contact(a.site, b.site)

    def _around(self, site: Site, anatomy: Anatomy, *, wide: bool) -> NDArray[np.bool_]:
        """Capsules of a site's bone and of those before and after it; wide: of all beyond it."""
        node, parents = self.binding.site(site).node, self.rig.chain.parents
        on = self.rig.capsules.node
        near = (on == node) | (on == parents[node]) | (parents[on] == node)
        if wide and part_of(self.binding.site(site).bone) is Part.ARM:
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
        excess = (
            self.radii - self._allowance(frames, every) - _distances(self.rig, self.pairs, frames)
        )
        order = [int(n) for n in np.argsort(-excess, kind="stable") if excess[n] > 0]
        return tuple(
            Overlap(names[self.pairs[n, 0]], names[self.pairs[n, 1]], float(excess[n]))
            for n in order
        )


@lru_cache(maxsize=4)
def _pairs(rig: Rig, anatomy: Anatomy) -> tuple[NDArray[np.int64], Array, NDArray[np.bool_]]:
    """Pairs (P, 2), sums of radii (P,), and which coordinates change their distance (P, V).

    Fingers of one hand lie side by side when they are straight: no pair asks for more than that.
    """
    capsules = rig.capsules
    pairs = np.vstack([capsules.pairs, capsules.finger_pairs])
    radii = capsules.radius[pairs].sum(axis=1)
    relative = anatomy.relative(*capsules.node[pairs].T)
    others = np.ones(len(rig.coordinates), dtype=np.bool_)
    others[list(anatomy.of(Part.HAND))] = False
    same_hand = ~(relative & others).any(axis=1)
    straight = rig.chain.frames(np.zeros(len(rig.coordinates)))
    radii[same_hand] = np.minimum(radii, _distances(rig, pairs, straight))[same_hand]
    return pairs, radii, relative


def _distances(rig: Rig, pairs: NDArray[np.int64], frames: Frames) -> Array:
    """Distance of the axes of pairs of capsules in a posture, (P,) metres."""
    ends = np.array([_ends(rig, frames, c) for c in range(len(rig.capsules.names))])
    p, q = ends[pairs[:, 0]], ends[pairs[:, 1]]
    return segment_distance(p[:, 0], p[:, 1], q[:, 0], q[:, 1])


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
