"""Changes the sides in a score: the mirror image, and another dominant hand.

A mirror image is the reflection in a plane between left and right. Sides change, x changes its
sign, and rotations change their sense. With M the reflection, M(a × b) = −(Ma × Mb), and a rotation
about `a` by φ becomes one about Ma by −φ.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

from azee.score.score import SIDE_CHANNELS, Group, Hold, Key, Recorded, Score
from azee_grammar import vocabulary
from azee_solver.constraint import (
    Constraint,
    Look,
    LookAt,
    Morph,
    Orient,
    Origin,
    Place,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.geometry import (
    Arc,
    Around,
    Between,
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
    Side,
    SigningSpace,
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


class NoMirrorImage(Exception):  # noqa: N818 - what it says is a fact about a morph
    """A morph of one side that the other side lacks."""


class Change:
    """A change applied to everything in a score; sides and places stay, unless it changes them."""

    __slots__ = ()

    def side(self, side: Side) -> Side:
        """Return the new side for a side."""
        return side

    def place(self, place: SigningSpace) -> SigningSpace:
        """Return the new place for a named place."""
        return place

    def score(self, score: Score) -> Score:
        """Return the score with all its constraints changed; times stay."""
        if isinstance(score, Key):
            return replace(score, constraints=tuple(self.constraint(c) for c in score.constraints))
        if isinstance(score, Group):
            blocks = []
            for block in score.blocks:
                blocks.append(replace(block, score=self.score(block.score)))
            return replace(score, blocks=tuple(blocks))
        if isinstance(score, Hold):
            return replace(score, channels=tuple(self._channel(name) for name in score.channels))
        if isinstance(score, Recorded):
            return self.recorded(score)
        return score

    def recorded(self, score: Recorded) -> Recorded:
        """Return a recorded sign changed; of itself it has neither sides nor places."""
        return score

    def _channel(self, name: str) -> str:
        if name not in SIDE_CHANNELS:
            return name
        side = self.side(SIDE_CHANNELS[name])
        return next(other for other, found in SIDE_CHANNELS.items() if found is side)

    def constraint(self, constraint: Constraint) -> Constraint:
        """Return the constraint with all its parts changed."""
        changed: Constraint = self.rebuilt(constraint)
        return changed

    def node(self, node: Any) -> Any:
        """Return a part of a constraint changed: geometry, bones, sites, sides."""
        if isinstance(node, Side):
            return self.side(node)
        if isinstance(node, NamedPoint):
            return NamedPoint(self.place(node.place))
        if isinstance(node, tuple):
            return tuple(self.node(part) for part in node)
        if is_dataclass(node) and not isinstance(node, Origin):
            return self.rebuilt(node)
        return node

    def rebuilt(self, node: Any) -> Any:
        """Return a node of the same class with all its parts changed."""
        return replace(node, **{f.name: self.node(getattr(node, f.name)) for f in fields(node)})


_SWAPPED_PLACES = {
    SigningSpace.RSSP: SigningSpace.LSSP,
    SigningSpace.LSSP: SigningSpace.RSSP,
    SigningSpace.SSSP: SigningSpace.WSSP,
    SigningSpace.WSSP: SigningSpace.SSSP,
}


@dataclass(frozen=True, slots=True)
class Mirror(Change):
    """The mirror image. Applied twice it changes nothing."""

    def side(self, side: Side) -> Side:
        """Return the other side of the same kind."""
        return side.opposite

    def place(self, place: SigningSpace) -> SigningSpace:
        """Return the place on the other side."""
        return _SWAPPED_PLACES.get(place, place)

    def recorded(self, score: Recorded) -> Recorded:
        """Return the sign as the other hand signs it."""
        return replace(score, mirrored=not score.mirrored)

    def constraint(self, constraint: Constraint) -> Constraint:
        """Return the mirror image; rotations change their sense.

        So do trills that start or go farther to one side; the others go to both alike.
        """
        changed: Constraint
        match constraint:
            case Morph(name=name, side=None):
                changed = replace(constraint, name=_other_morph(name))
            case Rotate(angle_rad=angle):
                changed = replace(self.rebuilt(constraint), angle_rad=-angle)
            case Trill(amplitude_rad=there, back_rad=back, phase_rad=phase) if (
                phase or back is not None
            ):
                changed = replace(
                    self.rebuilt(constraint),
                    amplitude_rad=constraint.other_rad,
                    back_rad=None if back is None else there,
                    phase_rad=(phase + math.pi) % (2.0 * math.pi),
                )
            case Place() | Orient() | Look() | LookAt() | Morph() | Trill() | Transpath():
                changed = self.rebuilt(constraint)
        return changed

    def node(self, node: Any) -> Any:
        """Return the mirror image of a part."""
        if isinstance(node, Vector | Point | Path):
            return self._geometry(node)
        return Change.node(self, node)

    def _geometry(self, node: Vector | Point | Path) -> Any:
        match node:
            case Vec(x=x) | FreePoint(x=x) | WorldPoint(x=x):
                return replace(node, x=-x if x else x)
            case Cross(left=left, right=right):
                return Cross(self.node(right), self.node(left))
            case Rotated(angle_rad=angle):
                return replace(self.rebuilt(node), angle_rad=-angle)
            case Circle(turns=turns, phase_rad=phase):
                return replace(self.rebuilt(node), turns=-turns, phase_rad=-phase if phase else 0.0)
            case Around(turns=turns):
                return replace(self.rebuilt(node), turns=-turns)
            case NamedPoint(place):
                return NamedPoint(self.place(place))
            case Out() | Dir() | Nrm() | Opp() | Unit() | Scale() | VSum() | VDiff() | Towards():
                return self.rebuilt(node)
            case Swing():
                return self.rebuilt(node)
            case Was(at=tuple((x, y, z))):
                return replace(node, point=self.node(node.point), at=(-x if x else x, y, z))
            case SitePoint() | JointPoint() | VTranslate() | Between() | Moving() | Was():
                return self.rebuilt(node)
            case Straight() | Arc() | Wave() | Zigzag() | Through() | Slide():
                return self.rebuilt(node)


MIRROR = Mirror()

_SUFFIXED = re.compile(r"(.+)_([LR])", re.ASCII)


def _other_morph(name: str) -> str:
    """Return the morph of the other side, for names that include their side."""
    found = _SUFFIXED.fullmatch(name)
    other = f"{found[1]}_{'R' if found[2] == 'L' else 'L'}" if found else name
    if other in vocabulary.MORPHS and not (other == name == "palm_l_closed"):
        return other
    raise NoMirrorImage(f"the morph `'{name}` has no mirror image")


@dataclass(frozen=True, slots=True)
class WithDominant(Change):
    """Strong means one given side; places on the strong and the weak side follow."""

    strong: Side

    def side(self, side: Side) -> Side:
        """Return the side that strong or weak now means; left and right stay."""
        if side is Side.STRONG:
            return self.strong
        return self.strong.opposite if side is Side.WEAK else side

    def place(self, place: SigningSpace) -> SigningSpace:
        """Return the place that the place of the strong or the weak side now is."""
        if place is SigningSpace.SSSP:
            return _PLACES[self.strong]
        return _PLACES[self.strong.opposite] if place is SigningSpace.WSSP else place


_PLACES = {
    Side.STRONG: SigningSpace.SSSP,
    Side.WEAK: SigningSpace.WSSP,
    Side.LEFT: SigningSpace.LSSP,
    Side.RIGHT: SigningSpace.RSSP,
}


def with_dominant(strong: Side) -> WithDominant:
    """Return the change after which strong means `strong`."""
    return WithDominant(strong)
