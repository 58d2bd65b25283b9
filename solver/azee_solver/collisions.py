"""Capsules of the body that a problem must keep apart, and where touching is meant."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from azee_rig.chain import Frames
from azee_rig.rig import RigSite
from azee_rig.skeleton import frozen
from azee_solver.anatomy import Anatomy, Part
from azee_solver.binding import Binding
from azee_solver.broadphase import Collisions
from azee_solver.constraint import Constraint, Place
from azee_solver.geometry import Between, Site, SitePoint, WorldPoint, sites_of
from azee_solver.kinematics import Parting
from azee_solver.sliding import UPRIGHT, skin_between

if TYPE_CHECKING:
    from azee_rig.rig import Rig

Array = NDArray[np.float64]
Spot: TypeAlias = str | tuple[str, str, float]
"""A site of the body by name, or the skin between two, so far from the one to the other."""


NEAR_M = 0.014
"""Capsules of the bones before and after a site take part in its contacts if so near to it."""
BENT = 0.9
"""Of their upper limits, joints that are bent."""
MARGIN_M = 0.004
"""Capsules hold most of the skin, not all: arms and hands are kept so far from trunk and head."""
BROAD = (*UPRIGHT, "clav", "arm")
"""Bones that all fingers of a hand lie on where one of them touches."""
FINGERS = ("thumb", "index", "middle", "ring", "little")
BESIDE_M, FAR_M = 0.04, 0.1
"""Capsules of a hand that touches take part wholly up to the one distance and not at all from the
other."""
SLACK_M, CALLED_SLACK_M, PALM_SLACK_M = 0.001, 0.002, 0.009
"""Overlap that is forgiven where a site is placed on a site; where the text calls that a contact;
and where one of them is a palm, which is hollow and soft: its edges stand out around what it
touches."""


@dataclass(frozen=True, slots=True, eq=False)
class Surroundings:
    """Capsules around a site.

    share: (K,) how far each takes part in what the site touches, 0 to 1. out_m: (K,) how far the
    capsules of its bone stand out beyond the skin at the site, metres.
    """

    share: Array
    out_m: Array


@dataclass(frozen=True, slots=True, eq=False)
class Contact:
    """Two sites that are meant to touch.

    first, second: what is around the two sites. slack_m: what is forgiven besides what the
    capsules stand out by.
    """

    first: Surroundings
    second: Surroundings
    slack_m: float

    def allowed_m(self, i: NDArray[np.int64], j: NDArray[np.int64]) -> Array:
        """How deep pairs of capsules (P,) may overlap, metres: as they do when the skins touch."""
        one, other = self.first, self.second

        def either(a: Surroundings, b: Surroundings) -> Array:
            share = a.share[i] * b.share[j]
            return np.asarray(share * (a.out_m[i] + b.out_m[j] + self.slack_m))

        return np.maximum(either(one, other), either(other, one))


@dataclass(frozen=True, slots=True)
class Overlap:
    """Two capsules of the body that overlap deeper than a meant contact accounts for."""

    first: str
    second: str
    depth_m: float


class Obstacles:
    """All pairs of capsules that must not overlap, for the constraints of one moment.

    pairs: (P, 2). reach: (P,) how near their axes may come. Placing a site on a site means contact
    there: as far as the capsules stand out beyond the skin at the two sites, those around them may
    overlap.
    """

    def __init__(
        self, binding: Binding, anatomy: Anatomy, constraints: Sequence[Constraint]
    ) -> None:
        self.rig = binding.rig
        meant = tuple(_meant(binding, constraints))
        self._clearance = _clearance(self.rig, anatomy, meant)
        self.pairs, self.reach = self._clearance.pairs, self._clearance.reach

    def for_problem(self, free: Iterable[int], unsettled: Iterable[int]) -> Collisions:
        """Pairs whose distance the free coordinates change.

        Args: unsettled: coordinates that a later problem will move: what only they carry is not
            yet in the way.
        """
        return _changed(self._clearance, frozenset(free), frozenset(unsettled))

    def overlaps(self, q: Array) -> tuple[Overlap, ...]:
        """Pairs that overlap in a posture (V,), deepest first."""
        names = self.rig.capsules.names
        depth = depths(self.rig, Collisions(self.pairs, self.reach, self._clearance.margin), q)
        inside = np.flatnonzero(depth > 0.0)
        return tuple(
            Overlap(names[self.pairs[n, 0]], names[self.pairs[n, 1]], float(depth[n]))
            for n in inside[np.argsort(-depth[inside], kind="stable")]
        )


def depths(rig: Rig, collisions: Collisions, q: Array) -> Array:
    """How deep pairs overlap in a posture (V,), margins left out, (P,) metres; less than 0: not."""
    reach = collisions.reach - collisions.margin
    nothing = np.empty(0, dtype=np.int64)
    depth, _ = Parting(rig, collisions.pairs).depths(q[None], reach, nothing)
    return np.asarray(depth[0])


@dataclass(frozen=True, slots=True, eq=False)
class _Clearance:
    """How near capsules may come where certain contacts are meant.

    pairs: (P, 2). reach: (P,) metres, with the margin in it. margin: (P,). nodes: (P, 2) that
    carry them. relative: (P, V), which coordinates change their distance.
    """

    anatomy: Anatomy
    pairs: NDArray[np.int64]
    reach: Array
    margin: Array
    nodes: NDArray[np.int64]
    relative: NDArray[np.bool_]


@lru_cache(maxsize=64)
def _clearance(rig: Rig, anatomy: Anatomy, meant: tuple[tuple[str, Spot, bool], ...]) -> _Clearance:
    """Work it out once for all moments with the same contacts, as those of a movement."""
    pairs, radii, margin, relative = _pairs(rig, anatomy)
    i, j = pairs.T
    allowed = np.zeros(len(pairs))
    for one, other, called in meant:
        contact = _contact(rig, anatomy, one, other, called=called)
        allowed = np.maximum(allowed, contact.allowed_m(i, j))
    reach = frozen(radii + margin - allowed, np.float64)
    return _Clearance(anatomy, pairs, reach, margin, rig.capsules.node[pairs], relative)


@lru_cache(maxsize=256)
def _changed(clear: _Clearance, free: frozenset[int], unsettled: frozenset[int]) -> Collisions:
    mine, later = sorted(free), sorted(unsettled)
    moves = clear.anatomy.moves
    absent = np.logical_or.reduce(moves[:, later], axis=1)
    absent = np.logical_and(absent, ~np.logical_or.reduce(moves[:, mine], axis=1))[clear.nodes]
    changed = np.logical_or.reduce(clear.relative[:, mine], axis=1)
    chosen = np.logical_and(changed, ~np.logical_or.reduce(absent, axis=1))
    return Collisions(clear.pairs[chosen], clear.reach[chosen], clear.margin[chosen])


def _meant(binding: Binding, constraints: Iterable[Constraint]) -> Iterator[tuple[str, Spot, bool]]:
    """Sites and what they are meant to touch, and whether the text calls that a contact.

    A contact at a point between sites or beside one is a contact with each of them, and with the
    skin between.
    """

    def name(site: Site) -> str:
        return binding.site(site).name

    places = [c for c in constraints if isinstance(c, Place)]
    for place in places:
        own, point = name(place.site), place.point
        if isinstance(point, SitePoint):
            yield own, name(point.site), place.contact
        elif isinstance(point, WorldPoint):
            for site in point.touching:
                yield own, name(site), True
        elif place.contact:
            for site in sorted(sites_of(point), key=str):
                yield own, name(site), True
            if isinstance(point, Between) and (spot := _between(binding, point)) is not None:
                yield own, spot, True
    for a, b in combinations(places, 2):
        if a.point == b.point and a.distance_m == b.distance_m == 0.0:
            yield name(a.site), name(b.site), False


def _between(binding: Binding, point: Between) -> Spot | None:
    """Return the point of the skin that is meant between two sites; None if none is."""
    start, end = point.start, point.end
    if not (isinstance(start, SitePoint) and isinstance(end, SitePoint)):
        return None
    if binding.skin_between(point) is None:
        return None
    return binding.site(start.site).name, binding.site(end.site).name, point.fraction


def _contact(rig: Rig, anatomy: Anatomy, one: str, other: Spot, *, called: bool) -> Contact:
    bones = [_site(rig, spot).bone for spot in (one, other)]
    palms = [called and bone.startswith("palm") for bone in bones]
    slack = PALM_SLACK_M if any(palms) else CALLED_SLACK_M if called else SLACK_M
    at_body = called and any(str(spot).startswith("WR") for spot in (one, other))
    at_body |= called and any(bone.startswith(BROAD) for bone in bones)
    first, second = (
        _around(rig, spot, anatomy, wide=palm or (at_body and bone.startswith(FINGERS)))
        for spot, bone, palm in zip((one, other), bones, palms, strict=True)
    )
    return Contact(first, second, slack)


def _site(rig: Rig, spot: Spot) -> RigSite:
    """Return a site of the body, or one made for a point of its skin."""
    if isinstance(spot, str):
        return rig.sites[spot]
    found = skin_between(rig, *spot)
    assert found is not None, spot
    node, place = found
    bone = next(name for name, nodes in rig.bones.items() if nodes.node == node)
    return RigSite("", bone, node, place, np.zeros(3))


@lru_cache(maxsize=256)
def _around(rig: Rig, spot: Spot, anatomy: Anatomy, *, wide: bool) -> Surroundings:
    """Find the capsules that take part in contacts of a site, and how far they stand out there.

    Those of the site's own bone, and near ones of its neighbours; a site of a joint, such as an
    elbow, has the bones on both sides as neighbours. Wide: also those of the whole hand, the
    farther the less: where a trunk stands out around what is touched it does so for all fingers.
    Which are near is told at the zero pose; how far they stand out is the most of that, idle and
    joints bent: a bent elbow is flatter.
    """
    site, capsules, parents = _site(rig, spot), rig.capsules, rig.chain.parents
    if site.node < 0:
        nothing = np.zeros(len(capsules.node))
        return Surroundings(nothing, nothing)
    c = rig.coordinates
    depth, *bent = (
        np.array(
            [
                radius - _to_segment(site.point(frames), a, b)
                for radius, a, b in zip(capsules.radius, *_ends(rig, frames), strict=True)
            ]
        )
        for frames in map(rig.chain.frames, (np.zeros(len(c)), c.idle, BENT * c.upper))
    )
    above = parents[capsules.node]
    own = capsules.node == site.node
    beside = (capsules.node == parents[site.node]) | (above == site.node)
    if site.node not in {bone.node for bone in rig.bones.values()}:
        beside |= above == parents[site.node]
    near = own | (beside & (depth > -NEAR_M))
    out = np.zeros(len(parents))
    np.maximum.at(out, capsules.node[near], np.max([depth, *bent], axis=0)[near])
    share = near.astype(np.float64)
    if wide:
        base = _palm(rig, site.bone) if site.bone.startswith(FINGERS) else site.node
        beyond = anatomy.paths[capsules.node, base]
        fading = np.clip((FAR_M + depth) / (FAR_M - BESIDE_M), 0.0, 1.0)
        share = np.maximum(share, np.where(beyond, fading, 0.0))
    others = out.max() if site.bone.startswith("palm") else 0.0
    return Surroundings(share, np.where(near, out[capsules.node], others))


def _palm(rig: Rig, bone: str) -> int:
    """Return the node of the palm of the hand that a finger's bone belongs to."""
    side = bone.split("_")[1]
    return rig.bones[f"palm_{side}"].node


@lru_cache(maxsize=4)
def _pairs(rig: Rig, anatomy: Anatomy) -> tuple[NDArray[np.int64], Array, Array, NDArray[np.bool_]]:
    """Pairs (P, 2), sums of radii and margins (P,), coordinates that change distances (P, V).

    Fingers of one hand lie side by side when they are straight, and a thumb is clear of its hand
    in the mesh's own posture: no pair asks for more than that.
    """
    capsules = rig.capsules
    pairs = np.vstack([capsules.pairs, capsules.finger_pairs])
    radii = capsules.radius[pairs].sum(axis=1)
    relative = anatomy.relative(*capsules.node[pairs].T)
    others = np.ones(len(rig.coordinates), dtype=np.bool_)
    others[list(anatomy.of(Part.HAND))] = False
    same_hand = ~(relative & others).any(axis=1)
    names = [f"thumb_{side}_1" for side in "LR"]
    thumbs = [rig.bones[name].node for name in names if name in rig.bones]
    thumb = anatomy.paths[capsules.node[pairs]][:, :, thumbs].any(axis=(1, 2))
    for alike, posture in (
        (same_hand & ~thumb, np.zeros(len(rig.coordinates))),
        (same_hand & thumb, rig.coordinates.bind),
    ):
        clear = _distances(rig, pairs, rig.chain.frames(posture))
        radii[alike] = np.minimum(radii, clear)[alike]
    arm = np.logical_or(*(anatomy.paths[:, rig.bones[f"arm_{side}"].node] for side in "LR"))
    i, j = capsules.node[pairs].T
    margin = np.where(arm[i] ^ arm[j], MARGIN_M, 0.0)
    return pairs, radii, margin, relative


def _distances(rig: Rig, pairs: NDArray[np.int64], frames: Frames) -> Array:
    """Distance of the axes of pairs of capsules in a posture, (P,) metres."""
    a, b = _ends(rig, frames)
    i, j = pairs.T
    return segment_distance(a[i], b[i], a[j], b[j])


def _ends(rig: Rig, frames: Frames) -> tuple[Array, Array]:
    """Return the ends of all capsules' axes in the world, (K, 3) each."""
    capsules = rig.capsules
    R, o = frames.rotations[capsules.node], frames.positions[capsules.node]
    a = (R @ capsules.a[:, :, None])[:, :, 0] + o
    b = (R @ capsules.b[:, :, None])[:, :, 0] + o
    return a, b


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
