"""BVH of a stick figure with hands, written under anybody's joint names, arms held out sideways."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

FINGERS = {"index": 3.0, "middle": 1.0, "ring": -1.0, "little": -3.0}
"""Where each knuckle lies across the palm, centimetres to the front."""
CHANNELS = "Zrotation Xrotation Yrotation"
Turns = Mapping[str, tuple[float, float, float]]
"""Degrees about Z, X and Y that a frame turns each joint by; joints that are not there stay."""


def joints(phalanges: int = 3) -> list[tuple[str, str, tuple[float, float, float]]]:
    """Name, parent and offset of each joint, in AZee's words, centimetres."""
    found: list[tuple[str, str, tuple[float, float, float]]] = [
        ("hips", "", (0, 95, 0)),
        ("spine", "hips", (0, 8, 0)),
        ("chest", "spine", (0, 10, 0)),
        ("neck", "chest", (0, 30, 0)),
        ("head", "neck", (0, 9, 1)),
        ("head_end", "head", (0, 18, 0)),
    ]
    for side, s in (("L", 1), ("R", -1)):
        found += [
            (f"clav_{side}", "chest", (2 * s, 16, 0)),
            (f"arm_{side}", f"clav_{side}", (15 * s, 0, 0)),
            (f"f_arm_{side}", f"arm_{side}", (28 * s, 0, 0)),
            (f"palm_{side}", f"f_arm_{side}", (25 * s, 0, 0)),
        ]
        for finger, z in FINGERS.items():
            found.append((f"{finger}_{side}_1", f"palm_{side}", (9 * s, 0, z)))
            found += [
                (f"{finger}_{side}_{k + 1}", f"{finger}_{side}_{k}", (3 * s, 0, 0))
                for k in range(1, phalanges)
            ]
            found.append((f"{finger}_{side}_end", f"{finger}_{side}_{phalanges}", (2.5 * s, 0, 0)))
        found.append((f"thumb_{side}_1", f"palm_{side}", (3 * s, -1, 3)))
        found += [
            (f"thumb_{side}_{k + 1}", f"thumb_{side}_{k}", (2.5 * s, 0, 2))
            for k in range(1, phalanges)
        ]
        found.append((f"thumb_{side}_end", f"thumb_{side}_{phalanges}", (2 * s, 0, 1.6)))
        found += [
            (f"thigh_{side}", "hips", (9 * s, -4, 0)),
            (f"calf_{side}", f"thigh_{side}", (0, -42, 0)),
            (f"foot_{side}", f"calf_{side}", (0, -42, 0)),
            (f"foot_{side}_end", f"foot_{side}", (0, -3, 0)),
        ]
    return found


def plain(joint: str) -> str:
    """Names that say what each joint is."""
    return joint.replace("f_arm", "forearm").replace("palm", "hand")


def stick_signer(
    frames: Sequence[Turns],
    name: Callable[[str], str] = plain,
    *,
    phalanges: int = 3,
    between: Mapping[str, Sequence[tuple[str, tuple[float, float, float]]]] | None = None,
) -> str:
    """Return the BVH.

    Args: name: the file's name of each joint. between: per joint what stands between its parent
        and it, as names of the file and offsets; its own offset is counted from its parent still.
    """
    all_joints = joints(phalanges)
    lines = ["HIERARCHY"]
    order: list[str] = []

    def opened(kind: str, called: str, offset: Sequence[float], channels: str) -> None:
        place = " ".join(f"{x:g}" for x in offset)
        lines.append(f"{kind} {called} {{ OFFSET {place} CHANNELS {channels}")

    def write(joint: str, offset: tuple[float, float, float]) -> None:
        if joint.endswith("_end"):
            lines.append(f"End Site {{ OFFSET {' '.join(f'{x:g}' for x in offset)} }}")
            return
        rest = list(offset)
        inserted = (between or {}).get(joint, ())
        for called, at in inserted:
            opened("JOINT", called, at, f"3 {CHANNELS}")
            order.append("")
            rest = [a - b for a, b in zip(rest, at, strict=True)]
        six = f"6 Xposition Yposition Zposition {CHANNELS}"
        root = joint == "hips"
        opened("ROOT" if root else "JOINT", name(joint), rest, six if root else f"3 {CHANNELS}")
        order.append(joint)
        for child, parent, place in all_joints:
            if parent == joint:
                write(child, place)
        lines.extend(["}"] * (1 + len(inserted)))

    write("hips", (0, 95, 0))
    rows = []
    for turns in frames:
        row = ["0 95 0"]
        row += [" ".join(f"{a:.6f}" for a in turns.get(joint, (0.0, 0.0, 0.0))) for joint in order]
        rows.append(" ".join(row))
    head = ["MOTION", f"Frames: {len(rows)}", "Frame Time: 0.04"]
    return "\n".join([*lines, *head, *rows, ""])


def bent(degrees: Mapping[str, float]) -> dict[str, tuple[float, float, float]]:
    """Turns of both hands' fingers towards the palm, by finger and phalanx such as `index_2`."""
    turns = {}
    for joint, angle in degrees.items():
        finger, k = joint.split("_")
        turns[f"{finger}_L_{k}"] = (-angle, 0.0, 0.0)
        turns[f"{finger}_R_{k}"] = (angle, 0.0, 0.0)
    return turns
