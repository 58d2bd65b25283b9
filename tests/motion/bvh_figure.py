"""A figure of few joints as BVH."""

from __future__ import annotations

import re

FIGURE = """HIERARCHY
ROOT Hips
{
	OFFSET 0 90 0
	CHANNELS 6 Zrotation Xrotation Yrotation Xposition Yposition Zposition
	JOINT Bip01 Spine
	{
		OFFSET 0 130 0
		CHANNELS 1 Zrotation
		JOINT Hand
		{
			OFFSET 0 20 0
			CHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation
			End Site
			{
				OFFSET 0 10 0
			}
		}
	}
}
MOTION
Frames: 2
Frame Time: 0.04
0 0 0 5 90 0 0 0 20 0 0 0 0
0 0 0 5 90 0 90 0 20 0 0 0 90
"""


def scaled(text: str, factor: float) -> str:
    """The figure with other lengths, in the hierarchy and in its positions."""
    head, motion = text.split("MOTION")
    head = re.sub(
        r"OFFSET (\S+) (\S+) (\S+)",
        lambda m: "OFFSET " + " ".join(f"{factor * float(x):.6f}" for x in m.groups()),
        head,
    )
    rows = motion.strip().split("\n")
    for i, row in enumerate(rows[2:], 2):
        values = [float(x) for x in row.split()]
        for c in (3, 4, 5, 7, 8, 9):
            values[c] *= factor
        rows[i] = " ".join(f"{x:.6f}" for x in values)
    return head + "MOTION\n" + "\n".join(rows) + "\n"
