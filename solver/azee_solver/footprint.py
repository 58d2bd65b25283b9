"""What a constraint reads of a body, found in its symbols before anything is solved."""

from __future__ import annotations

from dataclasses import dataclass

from azee_solver.anatomy import Anatomy, Part, part_of
from azee_solver.binding import EYES, Binding
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
    Around,
    Between,
    Bone,
    Circle,
    Cross,
    Dir,
    FreePoint,
    JointPoint,
    Moving,
    NamedPoint,
    Nrm,
    Opp,
    Out,
    Path,
    Point,
    Rotated,
    Scale,
    Site,
    SitePoint,
    Slide,
    Straight,
    Swing,
    Through,
    Towards,
    Unit,
    VDiff,
    Vec,
    Vector,
    VSum,
    VTranslate,
    Was,
    Wave,
    WorldPoint,
    Zigzag,
)


@dataclass(frozen=True, slots=True)
class Footprint:
    """Nodes that a constraint reads.

    own: those of the bone or site that it moves. target: those that its target depends on.
    world: whether it also reads a place or direction that no bone carries. Without one it does
    not change when everything it reads moves together.
    """

    own: frozenset[int]
    target: frozenset[int]
    world: bool

    def affected(self, anatomy: Anatomy) -> frozenset[int]:
        """Coordinates that can change the residual."""
        return self._of(self.own | self.target, anatomy)

    def movers(self, anatomy: Anatomy) -> frozenset[int]:
        """Coordinates that can change the residual by moving the constraint's own bone or site."""
        return self._of(self.own, anatomy)

    def _of(self, nodes: frozenset[int], anatomy: Anatomy) -> frozenset[int]:
        if self.world:
            return frozenset().union(*(anatomy.above(n) for n in nodes))
        common = anatomy.common(sorted(self.own | self.target))
        return frozenset().union(*(anatomy.below(common, n) for n in nodes))


def footprint(constraint: Constraint, binding: Binding) -> Footprint:
    """Return what a placement, orientation, rotation or gaze reads. Raises BindingError."""
    reader = _Reader(binding)
    match constraint:
        case Place(site, point):
            own = set(binding.site(site).nodes) or {0}  # what stands still is placed by nothing
            reader.point(point)
        case Orient(_, bone, _, vector):
            own = {binding.bone(bone).node}
            reader.vector(vector)
        case Look(vector):
            own = {binding.bone(eye).node for eye in EYES}
            reader.vector(vector)
        case LookAt(point):
            own = {binding.bone(eye).node for eye in EYES}
            reader.point(point)
        case Rotate(bone, axis):
            nodes = binding.bone(bone)
            own = {nodes.node}
            reader.node(int(binding.rig.chain.parents[nodes.origin_node]))
            aside = _Reader(binding)
            aside.vector(axis)
            if aside.nodes:
                reader.nodes |= aside.nodes
                reader.world = reader.world or aside.world
        case Morph() | Trill() | Transpath():
            raise ValueError(f"no footprint of a {type(constraint).__name__}")
    return Footprint(frozenset(own), frozenset(reader.nodes), reader.world)


def part_constrained(constraint: Constraint, binding: Binding) -> Part | None:
    """Part of the body that the placed site or the turned bone belongs to.

    None for a gaze, which eyes and head share, and for what no posture meets. Raises BindingError.
    """
    match constraint:
        case Place(site):
            return part_of(binding.site(site).bone)
        case Orient(_, bone) | Rotate(bone):
            return part_of(bone.name)
        case Look() | LookAt() | Morph() | Trill() | Transpath():
            return None


class _Reader:
    def __init__(self, binding: Binding) -> None:
        self.binding = binding
        self.nodes: set[int] = set()
        self.world = False

    def node(self, node: int) -> None:
        """Read a node's frame; the world's for −1."""
        if node < 0:
            self.world = True
        else:
            self.nodes.add(node)

    def site(self, site: Site) -> None:
        nodes = self.binding.site(site).nodes
        self.nodes.update(nodes)
        self.world = self.world or not nodes

    def bone(self, bone: Bone) -> int:
        return self.binding.bone(bone).node

    def vector(self, expr: Vector) -> None:
        match expr:
            case Vec() | Out():
                self.world = True
            case Dir(bone) | Nrm(bone):
                self.node(self.bone(bone))
            case Opp(inner) | Unit(inner) | Scale(inner):
                self.vector(inner)
            case VSum(inners):
                for inner in inners:
                    self.vector(inner)
            case VDiff(a, b) | Cross(a, b) | Rotated(a, b):
                self.vector(a)
                self.vector(b)
            case Towards(start, end):
                self.point(start)
                self.point(end)
            case Swing(start, end, beside):
                for side in (start, end, beside):
                    if side is not None:
                        self.vector(side)

    def point(self, expr: Point) -> None:
        match expr:
            case FreePoint() | NamedPoint() | WorldPoint() | Was():
                self.world = True
            case SitePoint(site):
                self.site(site)
            case JointPoint(bone):
                # A joint's place is carried by the bone before it.
                origin = self.binding.bone(bone).origin_node
                self.node(int(self.binding.rig.chain.parents[origin]))
            case VTranslate(point, vector):
                self.point(point)
                self.vector(vector)
            case Between(start, end):
                self.point(start)
                self.point(end)
            case Moving(path, start, end):
                self.point(start)
                self.point(end)
                self.path(path)

    def path(self, path: Path) -> None:
        match path:
            case Arc(vector) | Circle(vector) | Wave(vector) | Zigzag(vector):
                self.vector(vector)
                self.world = True  # a circle's starting side is the world's
            case Around(centre, axis):
                self.point(centre)
                self.vector(axis)
            case Slide(bone, inner):
                self.node(self.bone(bone))
                self.path(inner)
            case Through(points):
                for point in points:
                    self.point(point)
            case Straight():
                pass
