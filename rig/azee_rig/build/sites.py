"""Places AZee's body sites on a mesh: from within a bone, along a direction, to the skin.

The rules are data (data/site_rules.csv), one row per family of names, so that another body gets
its sites by the same rows. Columns:

name, digits, phalanges: `{F}` is a digit's letter, `{S}` the side, `{k}` the phalanx.
bone: the AZee bone; node: the bone or helper node that carries the site, where another does, or
`world`: legs stand still, and no AZee bone is theirs.
from, to, at: the ray starts at that fraction of the way between two joints; or from the middle
between the eyes (`eyes`).
shift, unit: moves the start, along out · dir · nrm (limbs) or out · up · forward (head, trunk),
counted in lengths of from–to (`bone`), distances between the eyes, or half shoulder widths.
toward: direction of the ray in the same axes. `out` is the thumb's side of a hand and forearm,
the outer side of an upper arm, the named side of head and trunk.
hit: the first or the last point met. on: which triangles count.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.anatomy import DIGITS, SIDES, Anatomy
from azee_rig.build.surface import Mask, Surface
from azee_rig.chain import Frames
from azee_rig.rig import BoneNodes, RigSite

Floats = NDArray[np.float64]
DIGIT = {"T": "thumb", "I": "index", "M": "middle", "R": "ring", "L": "little"}
BESIDE = 0.75
"""How far beside the skin a ray may pass, in lengths of the bone or distances between the eyes."""
AXIAL = ("back", "neck", "head", "eye", "clav", "world")


@dataclass(frozen=True, slots=True)
class SiteRule:
    """One row, written out for one site."""

    name: str
    bone: str
    node: str
    start: str
    end: str
    at: float
    shift: tuple[float, ...]
    unit: str
    toward: tuple[float, ...]
    hit: str
    on: str
    side: str


def read_rules(path: Path) -> Iterator[SiteRule]:
    """All rules, written out: 292 for AZee's table and 31 of our own."""
    with path.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            sides = SIDES if "{S}" in row["name"] else ("",)
            for letter in row["digits"].split() or [""]:
                for k in row["phalanges"].split() or [""]:
                    for side in sides:
                        yield _written_out(row, letter, k, side)


def _written_out(row: Mapping[str, str], letter: str, k: str, side: str) -> SiteRule:
    digit = DIGIT.get(letter, "")
    following = f"{digit}_{side}_{int(k or 3) + 1}" if k != "3" and k else f"tip {digit}_{side}"

    def fill(text: str) -> str:
        return text.format(F=letter, S=side, k=k, digit=digit, next=following)

    bone = fill(row["bone"])
    return SiteRule(
        name=fill(row["name"]),
        bone=bone,
        node=fill(row["node"]) or bone,
        start=fill(row["from"]),
        end=fill(row["to"]),
        at=float(row["at"] or 0.0),
        shift=tuple(float(x) for x in (row["shift"] or "0 0 0").split()),
        unit=row["unit"] or "bone",
        toward=tuple(float(x) for x in row["toward"].split()),
        hit=row["hit"],
        on=row["on"],
        side=side,
    )


@dataclass(frozen=True, slots=True)
class FaceShape:
    """How a face is shaped, counted in distances between the eyes, as shares of the signer's.

    out: half its width. up, down: from the eyes to the crown and to the chin. ahead, back: from
    the eyes to the tip of the nose and to the back of the head. deep: how far the joints of the
    eyes lie behind the eyes, in distances between them.
    """

    out: float = 1.0
    up: float = 1.0
    down: float = 1.0
    ahead: float = 1.0
    back: float = 1.0
    deep: float = 0.0

    def shaped(self, shift: Sequence[float]) -> Floats:
        """Return a shift (3,) of the signer's as it is on this face."""
        x, y, z = shift
        return np.array(
            [
                x * self.out,
                y * (self.up if y > 0.0 else self.down),
                z * (self.ahead if z > 0.0 else self.back) + self.deep,
            ]
        )


@dataclass(frozen=True, eq=False)
class SitePlacer:
    """Everything a rule is read against: the body in the mesh's own posture."""

    surface: Surface
    anatomy: Anatomy
    frames: Frames
    nodes: tuple[str, ...]
    bones: Mapping[str, BoneNodes]
    joints: Mapping[str, tuple[str, ...]]
    face: FaceShape = FaceShape()

    def place(self, rule: SiteRule) -> RigSite:
        """Cast the rule's ray. Raises ValueError, with the site's name, when it meets nothing."""
        node, axes = self._node(rule), self._axes(rule)
        R, origin = self._frame(node)
        start = self._start(rule, axes)
        try:
            point, normal = self.surface.cast(
                start, axes @ rule.toward, self._allowed(rule), rule.hit
            )
        except ValueError as error:
            raise ValueError(f"{rule.name}: {error}") from error
        return RigSite(rule.name, rule.bone, node, R.T @ (point - origin), R.T @ normal)

    def place_or_near(self, rule: SiteRule) -> RigSite | None:
        """Place a site; where its own part is not met, on what is, else where its ray passes by.

        None if nothing is near.
        """
        wider = "head" if rule.bone == "head" else "all"
        for on in (rule.on, wider):
            try:
                return self.place(replace(rule, on=on))
            except ValueError:
                continue
        return self._beside(rule) or self._beside(replace(rule, on=wider))

    def _beside(self, rule: SiteRule) -> RigSite | None:
        """Place a site on the skin that its ray passes nearest to."""
        node, axes = self._node(rule), self._axes(rule)
        R, origin = self._frame(node)
        reach = BESIDE * self._lengths(rule)["eyes" if rule.bone == "head" else "bone"]
        found = self.surface.passed(
            self._start(rule, axes), axes @ rule.toward, self._allowed(rule), reach
        )
        if found is None:
            return None
        point, normal = found
        return RigSite(rule.name, rule.bone, node, R.T @ (point - origin), R.T @ normal)

    def _frame(self, node: int) -> tuple[Floats, Floats]:
        """Rotation and origin of a node; of the world for −1."""
        if node < 0:
            return np.eye(3), np.zeros(3)
        return self.frames.rotations[node], self.frames.positions[node]

    def _node(self, rule: SiteRule) -> int:
        if rule.node == "world":
            return -1
        named = self.bones.get(rule.node)
        return self.nodes.index(rule.node) if named is None else named.node

    def _axes(self, rule: SiteRule) -> Floats:
        """Columns out, dir or up, nrm or forward."""
        sign = -1.0 if rule.side == "R" else 1.0
        if rule.node.startswith(AXIAL):
            return np.diag([sign, 1.0, 1.0])
        R = self.frames.rotations[self._node(rule)]
        return np.asarray(R * (-sign, 1.0, 1.0))

    def _lengths(self, rule: SiteRule) -> Mapping[str, float]:
        """Units that a rule's shift may be counted in, metres."""
        eyes = [self.anatomy.origin(f"eye_{s}") for s in SIDES]
        shoulders = [self.anatomy.origin(f"arm_{s}") for s in SIDES]
        ends = [self._joint(rule.start), self._joint(rule.end)] if rule.end else eyes
        return {
            "eyes": _distance(*eyes),
            "shoulders": _distance(*shoulders) / 2.0,
            "bone": _distance(*ends),
        }

    def _start(self, rule: SiteRule, axes: Floats) -> Floats:
        lengths = self._lengths(rule)
        shift = np.array(rule.shift)
        if rule.start == "eyes":
            start = (self.anatomy.origin("eye_L") + self.anatomy.origin("eye_R")) / 2.0
            shift = self.face.shaped(rule.shift)
        elif rule.end:
            near, far = self._joint(rule.start), self._joint(rule.end)
            start = near + rule.at * (far - near)
        else:
            start = self._joint(rule.start)
        return np.asarray(start + axes @ shift * lengths[rule.unit])

    def _joint(self, name: str) -> Floats:
        if name.startswith("tip "):
            return self.anatomy.tips[name.removeprefix("tip ")]
        return self.anatomy.origin(name)

    def _allowed(self, rule: SiteRule) -> Mask:
        s = rule.side
        match rule.on:
            case "digit":
                own = [b for b in self.joints if b.startswith(rule.bone.split("_")[0] + f"_{s}")]
                if rule.bone.endswith("_1"):
                    own.append(f"palm_{s}")
                return self._moved(own, 0.5)
            case "hand":
                return self._moved([f"palm_{s}", *(f"{d}_{s}_1" for d in DIGITS)], 0.5)
            case "arm":
                return self._moved([f"{b}_{s}" for b in ("arm", "f_arm", "palm")], 0.3)
            case "trunk":
                return self._moved(["back_1", "back_2", "clav_L", "clav_R"], 0.5)
            case "head":
                return self.surface.on_parts("skin", "brows")
            case "eye":
                return self.surface.on_parts("eyes")
            case "tongue":
                return self.surface.on_parts("tongue")
            case _:
                return self.surface.on_parts("skin", "top", "bands", "trousers", "hair")

    def _moved(self, bones: list[str], at_least: float) -> Mask:
        joints = [j for bone in bones for j in self.joints[bone]]
        return self.surface.moved_by(joints, at_least)


def _distance(a: Floats, b: Floats) -> float:
    return float(np.linalg.norm(a - b))
