"""Stands a body up: metres, y up, looking along +z, feet on y = 0, hips in its middle.

Where a body comes from, centimetres, z up, a turned root, does not matter: its own bones tell which
way it stands. A body that is nearly upright is turned by right angles only, so that the lean its
makers gave it stays.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.importing.bone_map import NEEDED, SIDES, BoneMap
from azee_rig.importing.fault import BodyError
from azee_rig.importing.skeleton_tree import Tree

Floats = NDArray[np.float64]

UNITS_M = {"m": 1.0, "cm": 0.01, "inch": 0.0254, "mm": 0.001, "dm": 0.1, "foot": 0.3048}
ADULT_M, TALL_M = (1.3, 2.1), (0.6, 2.6)
"""Heights of an adult, and of anybody."""
USUAL_M = 1.7
NEARLY_DEG = 15.0
FAR_M = 0.3
"""Hips no further before or behind the origin stay where they are."""
SOLE_M = 0.05
"""Soles no further from the ground stay there."""


@dataclass(frozen=True, eq=False, slots=True)
class Stand:
    """A change of space: x' = turn · x + shift, turn with its scale. notes: what was done."""

    turn: Floats
    shift: Floats
    notes: tuple[str, ...]

    def points(self, points: Floats) -> Floats:
        """Places (…, 3) in the new space."""
        return np.asarray(points @ self.turn.T + self.shift)

    def vectors(self, vectors: Floats) -> Floats:
        """Displacements (…, 3) in the new space."""
        return np.asarray(vectors @ self.turn.T)


def stand_up(tree: Tree, bones: BoneMap, vertices: Floats, *, exactly: bool) -> Stand:
    """Return how to stand a body up.

    Args: exactly: turn it by what its bones say even if that is little, for a body that was bound
        in some other posture than it stands in.
    Raises: BodyError: its joints do not tell up from left.
    """
    index = {name: j for j, name in enumerate(tree.names)}

    def place(joint: str) -> Floats:
        return np.asarray(tree.places[index[joint]])

    left = place(bones.bones["arm_L"][0]) - place(bones.bones["arm_R"][0])
    up = place(bones.bones["head"][0]) - place(bones.root)
    across = left - up * (left @ up) / max(float(up @ up), 1e-12)
    if min(np.linalg.norm(up), np.linalg.norm(across)) < 1e-6 * float(np.ptp(vertices)):
        raise BodyError(
            "body-incomplete",
            "its joints do not tell up from left: shoulders, head and hips lie on one line",
            help_="check the bones-map: `azee rig import BODY.glb --propose MAP.json` writes it",
        )
    y, x = up / np.linalg.norm(up), across / np.linalg.norm(across)
    turn = np.stack([x, y, np.cross(x, y)])
    notes = []
    if not exactly:
        turn = _right_angles(turn)
    angle = float(np.degrees(np.arccos(np.clip((np.trace(turn) - 1.0) / 2.0, -1.0, 1.0))))
    if angle > 0.1:
        notes.append(f"turned by {angle:.0f}° to stand upright and look forward")
    height = float(np.ptp(vertices @ turn[1]))
    if not height > 0.0:
        raise BodyError("body-incomplete", "its mesh has no height: all of it lies in one plane")
    scale = _scale(height, notes)
    turn = scale * turn
    moved = vertices @ turn.T
    hips = turn @ place(bones.root)
    ahead = hips[2] if abs(hips[2]) > FAR_M else 0.0
    sole = float(moved[:, 1].min())
    shift = -np.array([hips[0], sole if abs(sole) > SOLE_M else 0.0, ahead])
    return Stand(turn, shift, tuple(notes))


def _right_angles(turn: Floats) -> Floats:
    """Return the nearest turn by right angles, if it is near, else the turn itself."""
    near = np.zeros((3, 3))
    for row, values in enumerate(turn):
        column = int(np.abs(values).argmax())
        near[row, column] = np.sign(values[column])
    between = (np.trace(turn @ near.T) - 1.0) / 2.0
    sound = abs(np.linalg.det(near) - 1.0) < 1e-9
    return near if sound and between > np.cos(np.radians(NEARLY_DEG)) else turn


def _scale(height: float, notes: list[str]) -> float:
    for low, high in (ADULT_M, TALL_M) if not TALL_M[0] <= height <= TALL_M[1] else ():
        for unit, metre in UNITS_M.items():
            if low <= height * metre <= high:
                notes.append(f"its lengths are taken for {unit}: it is {height * metre:.2f} m tall")
                return metre
    if TALL_M[0] <= height <= TALL_M[1]:
        return 1.0
    notes.append(f"{height:.4g} tall, which no usual unit makes a person: it is made {USUAL_M} m")
    return USUAL_M / height


def checks(tree: Tree, bones: BoneMap, places: Floats) -> list[str]:
    """Doubts about a bones-map, on a body that stands: sides, lengths, order. places: (J, 3)."""
    index = {name: j for j, name in enumerate(tree.names)}
    at = {bone: places[index[chain[0]]] for bone, chain in bones.bones.items()}
    doubts = []
    for one, other in (("arm", "f_arm"), ("f_arm", "palm")):
        lengths = [float(np.linalg.norm(at[f"{other}_{s}"] - at[f"{one}_{s}"])) for s in SIDES]
        if min(lengths) < 0.9 * max(lengths):
            doubts.append(
                f"the left {one} is {1000 * lengths[0]:.0f} mm long, the right one "
                f"{1000 * lengths[1]:.0f} mm"
            )
    pairs = [(b[:-2], at[b], at[f"{b[:-2]}_R"]) for b in NEEDED if b.endswith("_L")]
    crossed = [name for name, left, right in pairs if left[0] < 0.0 < right[0]]
    if crossed:
        doubts.append(f"left and right look swapped at {', '.join(crossed)}")
    ahead = [
        places[c][2] - places[index[name]][2]
        for name in bones.kept
        for c in tree.children[index[name]]
        if not any(tree.names[c] == other for other in bones.kept)
        and places[index[name]][1] < 0.15 * places[:, 1].max()
    ]
    if ahead and max(ahead) < -0.02:
        doubts.append("the toes point backwards: left and right are probably swapped")
    return doubts
