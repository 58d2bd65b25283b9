"""What a page offers for dragging, and where on the body it is in a posture."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.posing.handle import BoneHandle, GazeHandle, Handle, MorphHandle, SiteHandle
from azee_grammar import vocabulary
from azee_rig.chain import Frames
from azee_solver.binding import EYES
from azee_solver.constraint import BoneAxis
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Bone, Side, Site

Array = NDArray[np.float64]

ARM_M = 0.14
"""From the foot of a bone to the tip of an arrow that turns it."""
GAZE_M = 0.5
"""From the eyes to the point that leads the gaze."""
_SIDED = re.compile(r"(?P<name>.+)_(?P<side>[LR])", re.ASCII)
_SITES = ("I_TIP", "M_TIP", "R_TIP", "L_TIP", "T_TIP", "PA", "H_BACK", "WR", "EL")
_BONES = (
    *(("palm", None, axis) for axis in (BoneAxis.DIR, BoneAxis.NRM)),
    *(("index", 1, BoneAxis.DIR), ("f_arm", None, BoneAxis.DIR)),
)


@dataclass(frozen=True, slots=True, eq=False)
class Grip:
    """A point on or before the body by which a handle is dragged.

    at: where it is, (3,) metres. base: the foot of an arrow, (3,), for a direction or the gaze.
    """

    handle: Handle
    at: Array
    base: Array | None = None

    def as_json(self) -> dict[str, object]:
        """Return it as plain data, in tenths of a millimetre."""
        base = None if self.base is None else self.base.round(4).tolist()
        return {"handle": str(self.handle), "at": self.at.round(4).tolist(), "base": base}


def grips(evaluator: Evaluator, frames: Frames) -> list[Grip]:
    """Return the grips of both hands and of the gaze, those that the body has."""
    return [
        *(_site(evaluator, frames, Site(name, side)) for side in _SIDES for name in _SITES
          if Site(name, side).key(evaluator.binding.dominant) in evaluator.rig.sites),
        *(_bone(evaluator, frames, Bone(name, side, phalanx), axis)
          for side in _SIDES for name, phalanx, axis in _BONES),
        _gaze(evaluator, frames),
    ]  # fmt: skip


_SIDES = (Side.STRONG, Side.WEAK)


def _site(evaluator: Evaluator, frames: Frames, site: Site) -> Grip:
    return Grip(SiteHandle(site), evaluator.site(site, frames))


def _bone(evaluator: Evaluator, frames: Frames, bone: Bone, axis: BoneAxis) -> Grip:
    base = frames.positions[evaluator.binding.bone(bone).origin_node]
    return Grip(BoneHandle(bone, axis), base + ARM_M * evaluator.axis(bone, axis, frames), base)


def _gaze(evaluator: Evaluator, frames: Frames) -> Grip:
    eyes = [evaluator.gaze(eye, frames) for eye in EYES]
    base = np.mean([origin for origin, _ in eyes], axis=0)
    ahead = np.mean([direction for _, direction in eyes], axis=0)
    return Grip(GazeHandle(), base + GAZE_M * ahead / np.linalg.norm(ahead), base)


def morph_handles(evaluator: Evaluator) -> tuple[list[MorphHandle], list[MorphHandle]]:
    """Return the morphs that bend parts of the body, and those of the face, in AZee's order."""
    rig, dominant = evaluator.rig, evaluator.binding.dominant
    known = list(vocabulary.MORPHS)
    skeletal = [_morph(key, dominant) for key in known if key in rig.skeletal_morphs]
    facial = [_morph(key, dominant) for key in known if key in rig.face_morphs]
    return skeletal, facial


def _morph(key: str, dominant: Side) -> MorphHandle:
    found = _SIDED.fullmatch(key)
    if found is None:
        return MorphHandle(key)
    side = Side.STRONG if found["side"] == dominant.value else Side.WEAK
    return MorphHandle(found["name"], side)
