"""Points and directions in the words of AZee: named ones first, then offsets, then numbers.

A name's `cost` ranks it: how far it is from what was dragged, squared, in units of what an author
would call the same, and how much there is to read.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from azee.posing.sites import NearSite, SiteMap
from azee_rig.chain import Frames
from azee_solver.evaluate import Evaluator, angle
from azee_solver.geometry import (
    Bone,
    Dir,
    FreePoint,
    NamedPoint,
    Nrm,
    Opp,
    Out,
    Point,
    Scale,
    Side,
    SigningSpace,
    SitePoint,
    Vec,
    Vector,
    VSum,
    VTranslate,
)
from azee_solver.notation import part_text, point_text, vector_text

Array = NDArray[np.float64]

UP, DOWN, FORWARD, BACK = Vec(0, 1, 0), Vec(0, -1, 0), Vec(0, 0, 1), Vec(0, 0, -1)
SPACES = (SigningSpace.MSSP, SigningSpace.SSSP, SigningSpace.WSSP)
SAME_M = 0.01
"""Points so near to each other are nearly the same to an author."""
SNAP_M, DISTANCE_M, AROUND_M = 0.02, 0.15, 0.25
"""How near a site must be for a site to lie at it, for a distance from it, for an offset."""
SAME_RAD, SNAP_RAD = np.radians(8.0), np.radians(20.0)
"""The same of directions: nearly the same, and how near a named direction must be."""
STEP_M = 0.005
"""To which offsets along named directions are rounded."""
EXACT_M = 4e-4
"""By how much numbers may be off."""
_NUMBER = re.compile(r"(?<![\w.])(-?)0(?=\.\d)")


@dataclass(frozen=True, slots=True, eq=False)
class PointName:
    """A point as AZee writes it. options: of a `place` there. point: (3,) where that is, metres.

    off_m: from what it names. what: in plain words.
    """

    text: str
    options: str
    point: Array
    off_m: float
    what: str
    cost: float


@dataclass(frozen=True, slots=True, eq=False)
class DirectionName:
    """A direction as AZee writes it. off_rad: from what it names."""

    text: str
    off_rad: float
    cost: float


def in_azee(text: str) -> str:
    """Write numbers as the published texts do: `.2`, not `0.2`."""
    return _NUMBER.sub(r"\1", text)


class PointNamer:
    """Names points beside a body in one posture."""

    def __init__(
        self, evaluator: Evaluator, frames: Frames, sites: SiteMap, places: Mapping[str, Point]
    ) -> None:
        """Know the names; sites: that may be named. places: of the discourse, by their names."""
        self._evaluator, self._frames, self._sites = evaluator, frames, sites
        self._places = places

    def names(self, point: Array, *, options: bool = True) -> list[PointName]:
        """Return names of a point (3,), metres in the world, the best first.

        Args: options: whether a `place` has them, so that it may touch or keep a distance.
        """
        found = [*self._of_sites(point, options=options), *self._of_space(point)]
        best: dict[str, PointName] = {}
        for name in sorted(found, key=lambda name: name.cost):
            best.setdefault(name.text + name.options, name)
        return [*best.values()]

    def _of_sites(self, point: Array, *, options: bool) -> Iterator[PointName]:
        near = self._sites.near(point, AROUND_M)
        for found in near[:4]:
            text, called = SitePoint(found.site), part_text(found.site)
            if found.distance_m <= SNAP_M:
                touch = " 'contact" if options else ""
                yield self._named(text, point, 0.0, f"at {called}", touch)
            if options and (height := self._height(found, point)) is not None:
                distance_m = self._evaluator.scale * height
                at = found.point + distance_m * found.normal
                off_m = float(np.linalg.norm(at - point))
                words = f"{distance_m * 100:.1f} cm off {called}"
                yield PointName(
                    called, in_azee(f" 'dist {height:g}"), at, off_m, words, 0.5 + _square(off_m)
                )
        for found in near[:1] if near and near[0].distance_m <= DISTANCE_M else ():
            yield from self._beside(SitePoint(found.site), point, part_text(found.site), 3.2)

    def _height(self, found: NearSite, point: Array) -> float | None:
        """Return the distance along a site's normal at which a point lies, if it does."""
        offset = point - found.point
        height_m = float(offset @ found.normal)
        aside_m = float(np.linalg.norm(offset - height_m * found.normal))
        if not (STEP_M <= height_m <= DISTANCE_M and aside_m <= 2 * SAME_M):
            return None
        return round(round(height_m / self._evaluator.scale / STEP_M) * STEP_M, 4) or None

    def _of_space(self, point: Array) -> Iterator[PointName]:
        spaces: dict[Point, str] = {NamedPoint(s): f"^{s.value}" for s in SPACES}
        for name, place in self._places.items():
            spaces[place] = f"^{name}"
        apart = {p: np.linalg.norm(self._evaluator.point(p, self._frames) - point) for p in spaces}
        nearest = min(apart, key=lambda p: apart[p])
        for place, text in spaces.items():
            if apart[place] <= SNAP_M:
                yield self._named(place, point, 0.0, f"at {text}", "", text)
            if place == nearest or apart[place] <= AROUND_M:
                yield from self._beside(place, point, text, 2.6 + (place != nearest))
        offset = point - self._evaluator.point(FreePoint(0, 0, 0), self._frames)
        numbers = rounded(offset / self._evaluator.scale)
        yield self._named(FreePoint(*numbers), point, 3.5, "just there")

    def _beside(self, base: Point, point: Array, text: str, exact: float) -> Iterator[PointName]:
        """Yield a base moved along one or two named directions, or by numbers."""
        offset = (point - self._evaluator.point(base, self._frames)) / self._evaluator.scale
        right = self._evaluator.binding.dominant is Side.RIGHT
        outwards = -offset[0] if right else offset[0]
        sideways: Vector = Out(Side.STRONG)
        parts: list[tuple[float, Vector, Vector]] = [
            (offset[1], UP, DOWN),
            (offset[2], FORWARD, BACK),
            (outwards, sideways, Opp(sideways)),
        ]
        steps = [
            Scale(there if length > 0 else back, round(round(abs(length) / STEP_M) * STEP_M, 4))
            for length, there, back in parts
        ]
        for count in (1, 2):
            for few in combinations([s for s in steps if s.factor], count):
                vector = few[0] if count == 1 else VSum(few)
                name = self._moved(base, vector, point, text, 0.6 * count)
                if name.off_m <= 2 * SAME_M:
                    yield name
        yield self._moved(base, Vec(*rounded(offset)), point, text, exact)

    def _moved(
        self, base: Point, vector: Vector, point: Array, text: str, cost: float
    ) -> PointName:
        moved = VTranslate(base, vector)
        where = self._evaluator.point(moved, self._frames)
        off_m = float(np.linalg.norm(where - point))
        written = in_azee(f"vtranslate({text}, {vector_text(vector)})")
        words = f"{_in_words(where - self._evaluator.point(base, self._frames))} {text}"
        return PointName(written, "", where, off_m, words, cost + _square(off_m))

    def _named(
        self, place: Point, point: Array, cost: float, what: str, options: str = "", text: str = ""
    ) -> PointName:
        where = self._evaluator.point(place, self._frames)
        off_m = float(np.linalg.norm(where - point))
        written = text or in_azee(point_text(place))
        return PointName(written, options, where, off_m, what, cost + _square(off_m))


def rounded(metres: Array) -> tuple[float, float, float]:
    """Return three lengths to the millimetre, or to a tenth where they would be off by more."""
    coarse = np.round(metres, 3)
    near = np.linalg.norm(coarse - metres) <= EXACT_M
    x, y, z = ((coarse if near else np.round(metres, 4)) + 0.0).tolist()
    return x, y, z


def _in_words(offset: Array) -> str:
    """Say where something is against something else, (3,) metres: `10 cm above, 5 cm before`."""
    words = (("left of", "right of"), ("above", "below"), ("before", "behind"))
    parts = [
        f"{abs(length) * 100:.0f} cm {ways[int(length < 0)]}"
        for length, ways in zip(offset.tolist(), words, strict=True)
        if abs(length) >= STEP_M
    ]
    return ", ".join(parts) or "at"


def _square(off_m: float) -> float:
    return (off_m / SAME_M) ** 2


def direction_names(
    direction: Array, bone: Bone | None, evaluator: Evaluator, frames: Frames
) -> list[DirectionName]:
    """Return names of a direction (3,), the best first; bone: that has it, and is not named."""
    sideways: Vector = Out(Side.STRONG)
    basis: list[Vector] = [UP, DOWN, FORWARD, BACK, sideways, Opp(sideways)]
    if bone is not None and bone.side is not None:
        own: Vector = Out(bone.side)
        basis[4:] = [own, Opp(own)]
    found: list[tuple[Vector, float]] = [(v, 0.0) for v in basis]
    pairs = (*product(basis[:2], basis[2:]), *product(basis[2:4], basis[4:]))
    found += ((VSum(pair), 1.0) for pair in pairs)
    for axis in _axes_beside(bone):
        found += [(axis, 0.6), (Opp(axis), 0.8)]
    unit = direction / np.linalg.norm(direction)
    found += (
        (Vec(*(np.round(unit, digits) + 0.0).tolist()), 2.4 + digits / 10) for digits in (2, 3)
    )
    names: dict[str, DirectionName] = {}
    for vector, cost in found:
        off = float(angle(evaluator.vector(vector, frames), unit))
        if off <= SNAP_RAD:
            text = in_azee(vector_text(vector))
            names.setdefault(text, DirectionName(text, off, cost + (off / SAME_RAD) ** 2))
    return sorted(names.values(), key=lambda name: name.cost)


def _axes_beside(bone: Bone | None) -> Sequence[Vector]:
    """Return the axes of other bones that a hand is compared with."""
    if bone is None or bone.name != "palm" or bone.side is None:
        return ()
    other = Bone("palm", bone.side.opposite)
    return Dir(Bone("f_arm", bone.side)), Dir(other), Nrm(other)
