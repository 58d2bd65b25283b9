"""Reads BVH, liberally: what exporters write, not only what the format's description says.

The description is Gürel 2010, appendix B. Beyond it are understood: any blanks and line ends, names
with blanks, joints with any number of channels in any order, several roots, decimal commas, a
brace too many, a frame count that disagrees with the data (the data counts), lines that are short
of values, frame times that are rates, and channels of scale (left out). Where a file leaves
something open a note says how it was read:

- position channels either replace the OFFSET of their joint or are added to it; a file does one of
  both. Joints that slide little tell which: their channels are nearer to the OFFSET, or to zero;
- lengths have no unit. The one is taken that makes the figure of the first frame as tall as a
  person; a figure that none fits is made 1.7 m tall.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee.clip.bvh_hierarchy import BvhError, Joint, read_hierarchy, shown
from azee.clip.bvh_motion import read_motion
from azee.clip.recording import Recording
from azee_rig.rotation import about_axis, to_quaternions
from azee_rig.skeleton import Skeleton

Floats = NDArray[np.float64]

UNITS_M = {"m": 1.0, "cm": 0.01, "inch": 0.0254, "mm": 0.001, "dm": 0.1, "foot": 0.3048}
"""Units of length, the likelier first."""
PERSON_M = (1.0, 2.3)
"""Largest extent of a figure, child or adult, arms hanging or stretched out."""
USUAL_PERSON_M = 1.7
SMALLEST, GREATEST = 1e-6, 1e7
"""Extents of figures in whatever unit."""
TRUNK = ("hip", "pelvis", "spine", "chest", "torso", "back", "head")
"""One of these stands in a name of any figure that is more than a limb."""
AT_ZERO = 0.1
"""Places of a whole figure that are nearer to zero, as a share of its OFFSET, are added to it."""

_MOTION = re.compile(r"^\s*MOTION\b", re.IGNORECASE | re.MULTILINE)


def read_bvh(path: str | Path, unit: str | None = None) -> Recording:
    """Read a BVH file.

    Args: unit: of its lengths, one of `UNITS_M`; guessed where none is given.
    Raises: OSError. BvhError: the file is none, or is damaged.
    """
    return parse_bvh(decoded(Path(path).read_bytes()), unit)


def parse_bvh(text: str, unit: str | None = None) -> Recording:
    """Read a BVH text: see `read_bvh`."""
    text = text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")
    found = _MOTION.search(text)
    if found is None:
        raise BvhError("there is no line MOTION: it is not a BVH file, or it was cut off")
    notes: list[str] = []
    joints = read_hierarchy(text[: found.start()], notes)
    width = sum(len(j.channels) for j in joints)
    if not width:
        raise BvhError("no joint has a channel: nothing can move")
    times, values = read_motion(text, found.end(), width, notes)
    del text, found  # as large as half of the arrays together
    try:
        return _recording(joints, times, values, unit, notes)
    except ValueError as error:
        raise BvhError(str(error)) from error


def decoded(data: bytes) -> str:
    """Return the text of a file in any of the encodings that BVH comes in."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", errors="replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def _recording(
    joints: Sequence[Joint], times: Floats, values: Floats, unit: str | None, notes: list[str]
) -> Recording:
    offsets = np.array([j.offset for j in joints])
    rotations = np.empty((len(times), len(joints), 4))
    moved: dict[int, dict[int, Floats]] = {}
    """Position channels by joint and axis, (T,) each."""
    column = 0
    for j, joint in enumerate(joints):
        R = np.broadcast_to(np.eye(3), (len(times), 3, 3))
        for kind, axis in joint.channels:
            if kind == "rotation":
                R = R @ about_axis(axis, np.radians(values[:, column]))
            elif kind == "position":
                moved.setdefault(j, {})[axis] = values[:, column]
            column += 1
        rotations[:, j] = to_quaternions(R)
    if any(kind == "scale" for joint in joints for kind, _ in joint.channels):
        notes.append("its channels of scale are left out")
    translations = _placed(joints, offsets, moved, len(times), notes)
    names, parents = tuple(j.name for j in joints), np.array([j.parent for j in joints])
    tips = {i: np.array(j.tip) for i, j in enumerate(joints) if j.tip is not None}
    largest = max(1.0, float(np.abs(translations[0]).max()))
    first = Recording(
        Skeleton(names, parents, offsets / max(largest, float(np.abs(offsets).max()))),
        {},
        times[:1],
        rotations[:1],
        translations[:1] / largest,
    )
    places, turned = first.frames()
    ends = {j: places[0, j] + turned[0, j] @ tip / largest for j, tip in tips.items()}
    metre = UNITS_M[unit] if unit else _guessed_unit(joints, places[0], ends, largest, notes)
    translations *= metre
    for array in (times, rotations, translations):
        array.setflags(write=False)  # a recording need not copy them
    return Recording(
        Skeleton(names, parents, offsets * metre),
        {j: tip * metre for j, tip in tips.items()},
        times,
        rotations,
        translations,
        tuple(notes),
    )


def _placed(
    joints: Sequence[Joint],
    offsets: Floats,
    moved: Mapping[int, Mapping[int, Floats]],
    count: int,
    notes: list[str],
) -> Floats:
    """Places of joints in their parents, (T, J, 3): OFFSETs, but where position channels say."""
    translations = np.empty((count, *offsets.shape))
    translations[:] = offsets
    for j, channels in moved.items():
        for axis, values in channels.items():
            translations[:, j, axis] = values
    if not _added(joints, offsets, {j: np.median(translations[:, j], axis=0) for j in moved}):
        return translations
    sliding = [j for j, channels in moved.items() if offsets[j, list(channels)].any()]
    for j, channels in moved.items():
        for axis in channels:
            translations[:, j, axis] += offsets[j, axis]
    whose = f"`{shown(joints[sliding[0]].name)}`"
    if len(sliding) > 1:
        whose = f"{len(sliding)} joints, such as {whose},"
    notes.append(f"the positions of {whose} are taken as added to the OFFSET")
    return translations


def _added(joints: Sequence[Joint], offsets: Floats, middles: Mapping[int, Floats]) -> bool:
    """Whether a file's position channels are added to OFFSETs, which otherwise they replace.

    Joints that carry the whole figure go where they want and tell little: they count where no
    other joint slides, and only where they stay about zero.

    Args: middles: the median place (3,) that the channels of each sliding joint say.
    """
    carriers = {j for path in _carriers(joints) for j in path}
    told = [j for j in middles if offsets[j].any()]
    inner = [j for j in told if j not in carriers]
    if inner:
        # Nearer to zero than to the OFFSET.
        added = sum(
            float(middles[j] @ offsets[j]) < 0.5 * float(offsets[j] @ offsets[j]) for j in inner
        )
        return 2 * added > len(inner)
    zero = [np.linalg.norm(middles[j]) < AT_ZERO * np.linalg.norm(offsets[j]) for j in told]
    return bool(told) and all(zero)


def _carriers(joints: Sequence[Joint]) -> list[list[int]]:
    """Per figure the joints that carry all of it: its root, down to where it first branches.

    A figure that does not branch is carried by its root alone.
    """
    children: dict[int, list[int]] = {}
    for j, joint in enumerate(joints):
        children.setdefault(joint.parent, []).append(j)
    paths = []
    for root in children[-1]:
        path = [root]
        while len(below := children.get(path[-1], [])) == 1:
            path.append(below[0])
        paths.append(path if below else path[:1])
    return paths


def _guessed_unit(
    joints: Sequence[Joint],
    places: Floats,
    ends: Mapping[int, Floats],
    scale: float,
    notes: list[str],
) -> float:
    """Return the metres of the file's unit of length.

    Args: places, ends: joints and tips in the first frame, in `scale` of the file's units.
    """
    extent = scale * _extent(joints, places, ends)
    names = " ".join(j.name for j in joints).lower()
    if not any(word in names for word in TRUNK) or not SMALLEST < extent < GREATEST:
        notes.append("it is no whole figure: its lengths are taken for centimetres")
        return UNITS_M["cm"]
    for unit, metre in UNITS_M.items():
        if PERSON_M[0] <= extent * metre <= PERSON_M[1]:
            notes.append(f"lengths are taken for {unit}: the figure is {extent * metre:.2f} m")
            return metre
    notes.append(
        f"no usual unit makes a person of the figure, {extent:.4g} long: it is made "
        f"{USUAL_PERSON_M} m"
    )
    return USUAL_PERSON_M / extent


def _extent(joints: Sequence[Joint], places: Floats, ends: Mapping[int, Floats]) -> float:
    """Largest extent of the largest figure, without the joints that only carry it about."""
    hips = {path[-1] for path in _carriers(joints)}
    figure = np.full(len(joints), -1)
    for j, joint in enumerate(joints):
        above = figure[joint.parent] if joint.parent >= 0 else -1
        figure[j] = j if j in hips else above
    extents = [0.0]
    for hip in hips:
        own = np.flatnonzero(figure == hip).tolist()
        points = [*places[own], *(ends[j] for j in own if j in ends)]
        extents.append(float(np.ptp(points, axis=0).max()))
    return max(extents)
