"""Binding: the step from AZee's names of a body to the nodes, sites and morphs of one rig."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from typing import TYPE_CHECKING

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
from azee_solver.geometry import Between, Bone, Side, Site, SitePoint, depends_on
from azee_solver.notation import part_text, subject_text

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from azee_rig.rig import BoneNodes, Rig, RigSite

    Array = NDArray[np.float64]


TOUCHING = ("fingers_together", "fingers_crossed")
"""Morphs whose angles press fingers together; these move apart until they just touch."""


class BindingError(Exception):
    """A rig lacks what a constraint names.

    code: `rig-lacks-bone`, `rig-lacks-site` or `rig-lacks-morph`. name: as the rig would call it.
    text: as AZee writes it. origin: where the constraint was written, if known.
    """

    def __init__(self, code: str, name: str, text: str, origin: Origin | None = None) -> None:
        super().__init__(f"{code}: {name}")
        self.code, self.name, self.text, self.origin = code, name, text, origin

    def at(self, origin: Origin | None) -> BindingError:
        """Return it with the place where the constraint was written."""
        return BindingError(self.code, self.name, self.text, origin)


class Binding:
    """The names of one rig, for a signer whose dominant hand is known."""

    def __init__(self, rig: Rig, dominant: Side) -> None:
        if dominant not in (Side.LEFT, Side.RIGHT):
            raise ValueError("the dominant hand is the left or the right one")
        self.rig, self.dominant = rig, dominant
        self._together: dict[tuple[Morph, ...], dict[int, float]] = {}

    def bone(self, bone: Bone) -> BoneNodes:
        """Nodes of a bone. Raises BindingError."""
        key = bone.key(self.dominant)
        try:
            return self.rig.bones[key]
        except KeyError:
            raise BindingError("rig-lacks-bone", key, part_text(bone)) from None

    def site(self, site: Site) -> RigSite:
        """Return a site on the skin. Raises BindingError."""
        key = site.key(self.dominant)
        try:
            return self.rig.sites[key]
        except KeyError:
            raise BindingError("rig-lacks-site", key, part_text(site)) from None

    def skin_between(self, point: Between) -> tuple[int, Array] | None:
        """Return the point of the skin that is nearest to one between two sites, if that is meant.

        A node and the place in its frame, (3,) metres. None: it is not meant, or the sites are not
        on trunk, neck or head. Raises BindingError.
        """
        start, end = point.start, point.end
        if not (point.on_skin and isinstance(start, SitePoint) and isinstance(end, SitePoint)):
            return None
        names = self.site(start.site).name, self.site(end.site).name
        from azee_solver.sliding import skin_between

        return skin_between(self.rig, *names, point.fraction)

    def is_skeletal(self, morph: Morph) -> bool:
        """Whether a morph moves joints, not the face. Raises BindingError."""
        key = morph.key(self.dominant)
        if key in self.rig.skeletal_morphs:
            return True
        if key in self.rig.face_morphs:
            return False
        written = subject_text(morph).removeprefix("morph ")
        raise BindingError("rig-lacks-morph", key, written, morph.origin)

    def preset(self, morph: Morph) -> dict[int, float]:
        """Coordinates that a skeletal morph moves, and by how much at its weight, radians."""
        index = self.rig.coordinates.index
        angles = self.rig.skeletal_morphs[morph.key(self.dominant)]
        return {index[name]: morph.weight * angle for name, angle in angles.items()}

    def presets(self, constraints: Iterable[Constraint]) -> dict[int, float]:
        """Angles that all skeletal morphs in force at one moment ask for together.

        They add to straight digits, and thumbs that they would put into their hand move aside; see
        `handshape`.
        """
        morphs = tuple(constraint for constraint in constraints if isinstance(constraint, Morph))
        if morphs not in self._together:
            self._together[morphs] = self._added(morphs)
        return self._together[morphs].copy()

    def yielding(self, constraints: Iterable[Constraint]) -> dict[int, float]:
        """Coordinates that soft morphs move and no exact one does, and by how far each may yield.

        Radians; the largest bound where soft morphs share a coordinate.
        """
        bounds: dict[int, float] = {}
        exact: set[int] = set()
        for morph in constraints:
            if isinstance(morph, Morph) and self.is_skeletal(morph):
                for v in self.preset(morph):
                    bounds[v] = max(bounds.get(v, 0.0), morph.within_rad)
                    if not morph.within_rad and morph.weight:
                        exact.add(v)
        return {v: bound for v, bound in bounds.items() if bound and v not in exact}

    def _added(self, morphs: Iterable[Morph]) -> dict[int, float]:
        total: dict[int, float] = {}
        touching: set[int] = set()
        for morph in morphs:
            if self.is_skeletal(morph):
                preset = self.preset(morph)
                for v, angle in preset.items():
                    total[v] = total.get(v, 0.0) + angle
                if morph.name.startswith(TOUCHING) and morph.weight:
                    touching.update(preset)
        if not total:
            return total
        from azee_solver.handshape import fitted, straight

        names = self.rig.coordinates.names
        asked = {v: straight(names[v]) + a for v, a in total.items()}
        return fitted(self.rig, asked, frozenset(touching))

    def has(self, constraint: Constraint) -> bool:
        """Whether the rig has everything that a constraint names."""
        try:
            _look_up(constraint, self)
        except BindingError:
            return False
        return True

    def check(self, constraint: Constraint) -> None:
        """Raise BindingError, with the constraint's origin, for the first name the rig lacks."""
        try:
            _look_up(constraint, self)
        except BindingError as error:
            raise error.at(constraint.origin) from None


@lru_cache(maxsize=4096)
def _look_up(constraint: Constraint, binding: Binding) -> None:
    """Look all names of a constraint up; the same ones come again from key to key."""
    if isinstance(constraint, Morph):
        binding.is_skeletal(constraint)
    for name in _names(constraint):
        if isinstance(name, Bone):
            binding.bone(name)
        else:
            binding.site(name)


def _names(constraint: Constraint) -> list[Bone | Site]:
    names: list[Bone | Site] = []
    match constraint:
        case Place(site, point):
            names += [site, *_ordered(depends_on(point))]
        case Orient(_, bone, _, vector):
            names += [bone, *_ordered(depends_on(vector))]
        case Look(vector):
            names += [*EYES, *_ordered(depends_on(vector))]
        case LookAt(point):
            names += [*EYES, *_ordered(depends_on(point))]
        case Trill(bone, axis) | Rotate(bone, axis):
            names += [bone, *_ordered(depends_on(axis))]
        case Transpath(site, path):
            names += [site, *_ordered(depends_on(path))]
        case Morph():
            pass
    return names


def _ordered(found: Iterable[Bone | Site]) -> list[Bone | Site]:
    return sorted(found, key=repr)


EYES = (Bone("eye", Side.LEFT), Bone("eye", Side.RIGHT))
