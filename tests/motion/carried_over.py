"""Figures and clips that are carried over to other bodies, and where hands are on these."""

from __future__ import annotations

import numpy as np

from azee.clip.clip import Clip
from azee.clip.retarget_source import measure_clip
from azee_rig.rig import Rig


def hands_seen(rig: Rig, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Wrists from the shoulders' middle in arm lengths, and palms, in the chest's frame."""
    seen = measure_clip(Clip(np.arange(len(q)) / 30, q, (), np.zeros((len(q), 0))), rig)
    return seen.wrists / seen.arm_m, seen.palms


def turn_deg(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    trace = np.einsum("...ab,...ab->...", a, b)
    return np.asarray(np.degrees(np.arccos(np.clip((trace - 1) / 2, -1, 1))))


def stick_figure(frames: int, change: tuple[str, str] = ("", ""), step_s: float = 1 / 30) -> str:
    """BVH of a figure with arms and no fingers, held out, whose forearms bend by 10° a frame."""
    arm = (
        "JOINT {side}Arm {{ OFFSET {s}15 45 0 CHANNELS 3 Zrotation Xrotation Yrotation "
        "JOINT {side}ForeArm {{ OFFSET {s}28 0 0 CHANNELS 3 Zrotation Xrotation Yrotation "
        "JOINT {side}Hand {{ OFFSET {s}25 0 0 CHANNELS 3 Zrotation Xrotation Yrotation "
        "End Site {{ OFFSET {s}10 0 0 }} }} }} }} "
    )
    text = (
        "HIERARCHY ROOT Hips { OFFSET 0 95 0 CHANNELS 6 Xposition Yposition Zposition "
        "Zrotation Xrotation Yrotation JOINT Head { OFFSET 0 60 0 "
        "CHANNELS 3 Zrotation Xrotation Yrotation End Site { OFFSET 0 20 0 } } "
        + arm.format(side="Left", s="")
        + arm.format(side="Right", s="-")
        + "}\nMOTION\n"
    )
    if change[0]:
        assert change[0] in text
        text = text.replace(*change)
    rows = [
        f"0 95 0 0 0 0  0 0 0  0 0 0  0 0 {-10 * t}  0 0 0  0 0 0  0 0 {10 * t}  0 0 0"
        for t in range(frames)
    ]
    head = f"Frames: {frames}\nFrame Time: {step_s:g}\n"
    return text + head + "\n".join(rows) + "\n"


def posed(rig: Rig, frames: int, degrees: dict[str, float]) -> Clip:
    """A still of some frames, both arms alike; coordinates that are not named rest."""
    c = rig.coordinates
    q = np.tile(c.idle, (frames, 1))
    for name, angle in degrees.items():
        for side in "LR":
            q[:, c.index[name.format(side)]] = np.radians(angle)
    return Clip(np.arange(frames) / 30, q, (), np.zeros((frames, 0)))
