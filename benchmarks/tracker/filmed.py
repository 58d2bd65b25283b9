"""A film of a text, and where the joints that a tracker looks for are in its pictures."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.clip.resample import at_rate
from azee.compilation import perform
from azee.export.pictures.camera import projected
from azee.export.pictures.film import write_film
from azee.export.pictures.scene import Look, Scene
from azee.quality.kinematics import NOSE
from azee.score.score import Score
from azee_rig.chain import Frames
from azee_rig.rig import Rig

Array = NDArray[np.float64]

FPS = 25.0
LOOK = Look(size=(640, 640), shots=("front",), captions=False)
FINGERS = {"thumb": "T", "index": "I", "middle": "M", "ring": "R", "little": "L"}
"""In the tracker's order; letters are those of the sites at their tips."""


@dataclass(frozen=True, eq=False)
class Filmed:
    """A film, and the pixels from its upper left where the body's own joints are.

    body: shoulders, wrists, nose, (T, 5, 2). hands: by side (T, 21, 2): the wrist, then three
    joints and the tip of every digit.
    """

    film: Path
    body: Array
    hands: dict[str, Array]

    def in_view(self, side: str) -> NDArray[np.bool_]:
        """Whether a hand is wholly in the picture, (T,)."""
        hand, size = self.hands[side], np.array(LOOK.size)
        return np.asarray(np.all((hand >= 0.0) & (hand < size), axis=(1, 2)))


def filmed(score: Score, rig: Rig, film: Path) -> Filmed:
    """Film a text."""
    clip = perform(score, rig).clip
    film.parent.mkdir(parents=True, exist_ok=True)
    write_film(clip, rig, film, LOOK, fps=FPS)
    even = at_rate(clip, FPS, rig.coordinates)
    return Filmed(film, *joints_in_pictures(even, rig))


def joints_in_pictures(clip: Clip, rig: Rig) -> tuple[Array, dict[str, Array]]:
    """Return where a film of a clip's frames shows `body` and `hands`, as `Filmed` has them."""
    cameras = Scene(clip, rig, LOOK).cameras[0]
    frames = rig.chain.frames(clip.coordinates)
    body = [_joint(rig, frames, f"{bone}_{side}") for bone in ("arm", "palm") for side in "LR"]
    body.append(rig.sites[NOSE].point(frames))

    def shown(points: Array) -> Array:
        pairs = zip(points, cameras, strict=True)
        return np.stack([projected(now, camera, *LOOK.size)[0][:, :2] for now, camera in pairs])

    return shown(np.stack(body, axis=1)), {side: shown(_hand(rig, frames, side)) for side in "LR"}


def _joint(rig: Rig, frames: Frames, bone: str) -> Array:
    return np.asarray(frames.positions[:, rig.bones[bone].origin_node])


def _hand(rig: Rig, frames: Frames, side: str) -> Array:
    points = [_joint(rig, frames, f"palm_{side}")]
    for finger, letter in FINGERS.items():
        points += [_joint(rig, frames, f"{finger}_{side}_{n}") for n in (1, 2, 3)]
        points.append(rig.sites[f"{letter}_TIP_{side}"].point(frames))
    return np.stack(points, axis=1)
