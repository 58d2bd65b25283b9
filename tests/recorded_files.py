"""Recordings in BVH that tests import: a stick figure that waves, and one without arms."""

from __future__ import annotations

from stick_signer import stick_signer


def wave(start_deg: float = 0.0) -> str:
    """A stick signer who lifts the right arm, 31 frames in 1.2 s."""
    frames = [
        {"arm_R": (0.0, 0.0, t + start_deg), "f_arm_R": (0.0, 2.0 * t, 0.0)} for t in range(31)
    ]
    return stick_signer(frames)


STATUE = """HIERARCHY
ROOT Hips { OFFSET 0 0 0
CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
JOINT Head { OFFSET 0 60 0 CHANNELS 3 Zrotation Xrotation Yrotation
End Site { OFFSET 0 20 0 } } }
MOTION
Frames: 2
Frame Time: 0.04
0 95 0 0 0 0 0 0 0
0 95 0 0 0 0 0 0 0
"""
"""Hips and a head."""
