"""Makes the movements of a score larger or smaller.

The points at which a score places a site are drawn towards their mean C: P becomes C + f (P − C).
Where some of them lie on the body itself these stay, for a sign that touches the chin still touches
it when it is smaller, and C is the mean of these.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace

from azee.lang.reflection import Change
from azee.score.score import Key, Score, leaves
from azee_solver.constraint import (
    Constraint,
    Look,
    LookAt,
    Morph,
    Orient,
    Place,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.geometry import (
    Arc,
    Between,
    Circle,
    JointPoint,
    Moving,
    Path,
    Point,
    Scale,
    Site,
    SitePoint,
    Straight,
    Through,
)

_ACCENTED = ("back_1", "back_2", "neck", "head", "clav")
"""Bones whose turns are movements of their own, and no part of a hand's posture."""


@dataclass(frozen=True)
class Resizing(Change):
    """Multiplies the sizes of movements by a factor.

    centres: the point towards which each site moves; a site that does not move has none.
    """

    factor: float
    centres: dict[Site, Point]

    @classmethod
    def of(cls, score: Score, factor: float) -> Resizing:
        """Return the change for the movements of a score."""
        return cls(factor, dict(_centres(score)))

    def growth(self, score: Score) -> int:
        """Return by how many parts the score grows, counted as a tree."""
        sizes = {site: 1 + _size(centre) for site, centre in self.centres.items()}
        places = (c.site for c in _constraints(score) if isinstance(c, Place | Transpath))
        return sum(sizes.get(site, 1) for site in places)

    def constraint(self, constraint: Constraint) -> Constraint:
        """Return a constraint of the smaller or larger score."""
        match constraint:
            case Place(site=site, point=point):
                return replace(constraint, point=self._drawn(site, point))
            case Transpath(site=site, path=path):
                return replace(constraint, path=self._path(site, path))
            case Rotate(bone=bone, angle_rad=angle) if bone.name in _ACCENTED:
                return replace(constraint, angle_rad=angle * self.factor)
            case Trill(amplitude_rad=amplitude):
                return replace(constraint, amplitude_rad=amplitude * self.factor)
            case Orient() | Look() | LookAt() | Morph() | Rotate():
                return constraint

    def _drawn(self, site: Site, point: Point) -> Point:
        if site not in self.centres or _on_body(point):
            return point
        return Between(self.centres[site], point, self.factor)

    def _path(self, site: Site, path: Path) -> Path:
        match path:
            case Arc(bulge):
                return Arc(Scale(bulge, self.factor))
            case Circle(radius_m=radius):
                return replace(path, radius_m=radius * self.factor) if self.factor else Straight()
            case Through(points):
                return Through(tuple(self._drawn(site, point) for point in points))
            case Straight():
                return path


def _centres(score: Score) -> Iterator[tuple[Site, Point]]:
    places: dict[Site, dict[Point, None]] = {}
    for constraint in _constraints(score):
        if isinstance(constraint, Place):
            ends = _ends(constraint.point)
            places.setdefault(constraint.site, {}).update(dict.fromkeys(ends))
    for site, points in places.items():
        fixed = [point for point in points if _on_body(point)]
        if len(points) > 1:
            yield site, _mean(fixed or list(points))


def _constraints(score: Score) -> Iterator[Constraint]:
    for leaf in leaves(score):
        if isinstance(leaf.score, Key):
            yield from leaf.score.constraints


def _ends(point: Point) -> tuple[Point, ...]:
    return (point.start, point.end) if isinstance(point, Moving) else (point,)


def _on_body(point: Point) -> bool:
    return isinstance(point, SitePoint | JointPoint)


def _mean(points: Sequence[Point]) -> Point:
    """Return the mean of points: M(n) = M(n − 1) + (P(n) − M(n − 1)) / n."""
    mean = points[0]
    for count, point in enumerate(points[1:], 2):
        mean = Between(mean, point, 1.0 / count)
    return mean


def _size(node: object) -> int:
    if isinstance(node, tuple):
        return sum(map(_size, node))
    if is_dataclass(node):
        return 1 + sum(_size(getattr(node, part.name)) for part in fields(node))
    return 0
