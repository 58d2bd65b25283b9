"""Geometry as AZee declares it: rig-independent, symbolic, evaluated only on a posture.

Vectors are directions in the signer's frame (x to the signer's left, y up, z forward), points are
metres of a reference signer in the same frame, scaled by arm length to the body that plays.
`dir`, `nrm`, sites and joints depend on the posture that is being solved: nothing here turns them
into numbers. Nodes bear the names of the AZee operators that make them.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, is_dataclass
from enum import Enum
from functools import lru_cache
from typing import TypeAlias


class Side(Enum):
    """Strong and weak stay symbolic until the signer's dominant hand is known."""

    STRONG = "s"
    WEAK = "w"
    LEFT = "L"
    RIGHT = "R"

    __hash__ = object.__hash__
    """By identity, as `is` compares them: sides stand in most keys of caches."""

    @property
    def opposite(self) -> Side:
        """The other side of the same kind."""
        return _OPPOSITE[self]

    def bound(self, dominant: Side) -> Side:
        """Return LEFT or RIGHT, for a signer whose dominant hand is `dominant`."""
        if self is Side.STRONG:
            return dominant
        return dominant.opposite if self is Side.WEAK else self


_OPPOSITE = {
    Side.STRONG: Side.WEAK,
    Side.WEAK: Side.STRONG,
    Side.LEFT: Side.RIGHT,
    Side.RIGHT: Side.LEFT,
}


@dataclass(frozen=True, slots=True)
class Bone:
    """`!palm s`, `!index s 2`: AZee's bone, without a rig."""

    name: str
    side: Side | None = None
    phalanx: int | None = None

    def key(self, dominant: Side) -> str:
        """Name in the bone table, such as `index_R_2`."""
        return _key(self.name, self.side, self.phalanx, dominant)


@dataclass(frozen=True, slots=True)
class Site:
    """`@I_TIP s`, `@I_BACK s 2`, `@FH`: AZee's body site, without a rig."""

    name: str
    side: Side | None = None
    phalanx: int | None = None

    def key(self, dominant: Side) -> str:
        """Name in the site table, such as `I_BACK_R_2`."""
        return _key(self.name, self.side, self.phalanx, dominant)


@lru_cache(maxsize=1024)
def _key(name: str, side: Side | None, phalanx: int | None, dominant: Side) -> str:
    parts = [name]
    if side is not None:
        parts.append(side.bound(dominant).value)
    if phalanx is not None:
        parts.append(str(phalanx))
    return "_".join(parts)


# Vectors ------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Vec:
    """`vec x y z`, and constants such as `^up`."""

    x: float
    y: float
    z: float


@dataclass(frozen=True, slots=True)
class Out:
    """`out SIDE`: away from the middle, towards that side (`in` is its `Opp`)."""

    side: Side


@dataclass(frozen=True, slots=True)
class Dir:
    """`dir BONE`: from its proximal to its distal end."""

    bone: Bone


@dataclass(frozen=True, slots=True)
class Nrm:
    """`nrm BONE`: its normal, out of the palm for a hand."""

    bone: Bone


@dataclass(frozen=True, slots=True)
class Opp:
    """`oppvect V`."""

    vector: Vector


@dataclass(frozen=True, slots=True)
class Unit:
    """`unit V`: of length one; degenerate for the zero vector."""

    vector: Vector


@dataclass(frozen=True, slots=True)
class Scale:
    """`scale V k`."""

    vector: Vector
    factor: float


@dataclass(frozen=True, slots=True)
class VSum:
    """`vsum V …`."""

    vectors: tuple[Vector, ...]


@dataclass(frozen=True, slots=True)
class VDiff:
    """`vdiff A B`: A − B."""

    left: Vector
    right: Vector


@dataclass(frozen=True, slots=True)
class Cross:
    """`cross A B`."""

    left: Vector
    right: Vector


@dataclass(frozen=True, slots=True)
class Towards:
    """`towards P Q`: unit vector from P to Q."""

    start: Point
    end: Point


@dataclass(frozen=True, slots=True)
class Rotated:
    """`rotated V AXIS ANGLE`: right-handed about AXIS; the text gives degrees."""

    vector: Vector
    axis: Vector
    angle_rad: float


@dataclass(frozen=True, slots=True)
class Swing:
    """`swing V W`: a dynamic direction, on the shorter arc from V to W while its block lasts.

    Without V and W, as `turning` makes it, they are those of the orientations before and after.
    beside: what the other axis of the bone does meanwhile, where that turns, too. Both then go
    along as the bone turns about one axis from one orientation to the other. longer: by the longer
    of the two ways round.
    """

    start: Vector | None
    end: Vector | None
    beside: Swing | None = None
    longer: bool = False


Vector: TypeAlias = (
    Vec | Out | Dir | Nrm | Opp | Unit | Scale | VSum | VDiff | Cross | Towards | Rotated | Swing
)

# Points -------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class FreePoint:
    """`point x y z`: metres of the reference signer, from the middle of the shoulder line."""

    x: float
    y: float
    z: float


class SigningSpace(Enum):
    """Named points around the signer, defined in the body's own units."""

    MSSP = "Mssp"
    RSSP = "Rssp"
    LSSP = "Lssp"
    SSSP = "Sssp"
    WSSP = "Wssp"
    ADDRESSEE = "addressee"


@dataclass(frozen=True, slots=True)
class NamedPoint:
    """`^Mssp`, `^Rssp`, …, `^addressee`."""

    place: SigningSpace


@dataclass(frozen=True, slots=True)
class SitePoint:
    """A site used as a point: where it is when this is solved."""

    site: Site


@dataclass(frozen=True, slots=True)
class JointPoint:
    """`joint BONE`: the proximal end of a bone."""

    bone: Bone


@dataclass(frozen=True, slots=True)
class VTranslate:
    """`vtranslate P V`: V in metres of the reference signer."""

    point: Point
    vector: Vector


@dataclass(frozen=True, slots=True)
class Between:
    """`between P Q t`; `midpoint P Q` is t = .5.

    on_skin: whether the nearest point of the skin is meant, as where a contact is between two
    sites. Only trunk, neck and head have such points.
    """

    start: Point
    end: Point
    fraction: float
    on_skin: bool = False


@dataclass(frozen=True, slots=True)
class Moving:
    """`moving PATH P Q`: a dynamic point, on the path from P to Q while its block lasts."""

    path: Path
    start: Point
    end: Point


@dataclass(frozen=True, slots=True)
class WorldPoint:
    """A place in the world of the body that plays, metres: what motion code has measured.

    No AZee text makes one. `touching`: sites of the part of the body whose skin is there and may be
    touched.
    """

    x: float
    y: float
    z: float
    touching: tuple[Site, ...] = ()


@dataclass(frozen=True, slots=True)
class Was:
    """`was 'BLOCK P`: where a point was when a block ended.

    at: that place, metres in the world of the body that plays, once motion code has measured it;
    before, it is nowhere.
    """

    block: str
    point: Point
    at: tuple[float, float, float] | None = None


Point: TypeAlias = (
    FreePoint
    | NamedPoint
    | SitePoint
    | JointPoint
    | VTranslate
    | Between
    | Moving
    | WorldPoint
    | Was
)

# Paths --------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Straight:
    """`straight`."""


@dataclass(frozen=True, slots=True)
class Arc:
    """`arc V`: a circular arc that bulges by |V| along V; also `arc-vect`."""

    bulge: Vector


@dataclass(frozen=True, slots=True)
class Circle:
    """`circle AXIS RADIUS turns` and `spiral`: radii in metres of the reference signer.

    It starts `phase_rad` beyond its highest point, right-handed about the axis. Its height is
    `ratio` times its width. A spiral ends with another radius.
    """

    axis: Vector
    radius_m: float
    turns: float
    phase_rad: float = 0.0
    ratio: float = 1.0
    end_radius_m: float | None = None


@dataclass(frozen=True, slots=True)
class Around:
    """`around POINT AXIS turns`: about a centre, as far from it as the ends are."""

    centre: Point
    axis: Vector
    turns: float


@dataclass(frozen=True, slots=True)
class Wave:
    """`wave V n`: to and fro along V, n times on the way."""

    side: Vector
    waves: float


@dataclass(frozen=True, slots=True)
class Zigzag:
    """`zigzag V n`: n corners, to the side of V and to the other in turns."""

    side: Vector
    corners: int


@dataclass(frozen=True, slots=True)
class Slide:
    """`slide BONE PATH`: a path laid on the skin of a part of the body."""

    bone: Bone
    path: Path


@dataclass(frozen=True, slots=True)
class Through:
    """`through P …`: a centripetal Catmull–Rom curve through the points."""

    points: tuple[Point, ...]


Path: TypeAlias = Straight | Arc | Circle | Around | Wave | Zigzag | Through | Slide


# Dependencies -------------------------------------------------------------------------------


@lru_cache(maxsize=1024)
def depends_on(expr: Vector | Point | Path) -> frozenset[Bone | Site]:
    """Bones and sites whose posture an expression reads."""
    found: set[Bone | Site] = set()
    _collect(expr, found)
    return frozenset(found)


def sites_of(point: Point) -> frozenset[Site]:
    """Sites whose places a point is made of."""
    return frozenset(part for part in depends_on(point) if isinstance(part, Site))


def _collect(node: object, found: set[Bone | Site]) -> None:
    if isinstance(node, Was):
        return  # that posture is over
    match node:
        case Bone() | Site():
            found.add(node)
        case tuple():
            for item in node:
                _collect(item, found)
        case _ if is_dataclass(node):
            for part in fields(node):
                _collect(getattr(node, part.name), found)
        case _:
            pass
