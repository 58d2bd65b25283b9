"""Reads BVH, liberally: what exporters write, not only what the format's description says.

The description is Gürel 2010, appendix B. Beyond it are understood: any blanks and line ends, names
with blanks, joints with any number of channels in any order, several roots, decimal commas, a
frame count that disagrees with the data (the data counts), and channels of scale (left out).
Where a file leaves something open a note says how it was read:

- position channels of a joint either replace its OFFSET or are added to it. They replace it where
  they come, on the whole, nearer to it than to zero;
- lengths have no unit. The one is taken that makes the figure of the first frame as tall as a
  person; a figure that none fits is made 1.7 m tall.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee.clip.recording import Recording
from azee_rig.rotation import about_axis, to_quaternions
from azee_rig.skeleton import Skeleton

Floats = NDArray[np.float64]

UNITS_M = {"m": 1.0, "cm": 0.01, "inch": 0.0254, "mm": 0.001, "dm": 0.1, "foot": 0.3048}
"""Units of length, the likelier first."""
PERSON_M = (1.0, 2.3)
"""Largest extent of a figure, child or adult, arms hanging or stretched out."""
USUAL_PERSON_M = 1.7
USUAL_FRAME_S = 1 / 30
TRUNK = ("hip", "pelvis", "spine", "chest", "torso", "back", "head")
"""One of these stands in a name of any figure that is more than a limb."""

_TOKEN = re.compile(r"[{}]|[^\s{}]+")
_CHANNEL = re.compile(r"([xyz])(rotation|position|scale)", re.IGNORECASE)
_MOTION = re.compile(r"^\s*MOTION\b", re.IGNORECASE | re.MULTILINE)
_FRAMES = re.compile(r"\s*Frames\s*:\s*(\S+)", re.IGNORECASE)
_FRAME_TIME = re.compile(r"\s*Frame\s+Time\s*:\s*(\S+)", re.IGNORECASE)


class BvhError(Exception):
    """A file that is no BVH, or a damaged one. The message is for the user and names the line."""


@dataclass(eq=False)
class _Joint:
    name: str
    parent: int
    offset: tuple[float, ...] = (0.0, 0.0, 0.0)
    channels: list[tuple[str, int]] = field(default_factory=list)
    """Kind and axis of each."""
    tip: tuple[float, ...] | None = None


def read_bvh(path: str | Path, unit: str | None = None) -> Recording:
    """Read a BVH file.

    Args: unit: of its lengths, one of `UNITS_M`; guessed where none is given.
    Raises: OSError. BvhError: the file is none, or is damaged.
    """
    return parse_bvh(_decoded(Path(path).read_bytes()), unit)


def parse_bvh(text: str, unit: str | None = None) -> Recording:
    """Read a BVH text: see `read_bvh`."""
    text = text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")
    found = _MOTION.search(text)
    if found is None:
        raise BvhError("there is no line MOTION: it is not a BVH file, or it was cut off")
    notes: list[str] = []
    joints = _hierarchy(text[: found.start()])
    line = text.count("\n", 0, found.end()) + 1
    times, values = _motion(text[found.end() :], line, joints, notes)
    return _recording(joints, times, values, unit, notes)


def _decoded(data: bytes) -> str:
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", errors="replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


class _Tokens:
    """Words of the hierarchy, with the line that each stands on."""

    def __init__(self, text: str) -> None:
        self._words = [
            (word.group(), number)
            for number, line in enumerate(text.splitlines(), 1)
            for word in _TOKEN.finditer(line)
        ]
        self._next = 0

    def __iter__(self) -> Iterator[str]:
        while self._next < len(self._words):
            yield self.take("")

    def take(self, wanted: str) -> str:
        """Next word. Raises: BvhError: there is none, where something was `wanted`."""
        if self._next == len(self._words):
            raise BvhError(f"line {self.line}: the hierarchy ends where {wanted} should stand")
        self._next += 1
        return self._words[self._next - 1][0]

    def name(self) -> str:
        """All words before the next `{`."""
        words = []
        while (word := self.take("`{`")) != "{":
            words.append(word)
        return " ".join(words)

    def numbers(self, count: int) -> tuple[float, ...]:
        """Next numbers. Raises: BvhError: a word is none."""
        return tuple(self._number(self.take("a number")) for _ in range(count))

    def _number(self, word: str) -> float:
        value = _float(word)
        if value is None or not np.isfinite(value):
            raise BvhError(f"line {self.line}: `{word}` is not a number")
        return value

    @property
    def line(self) -> int:
        """Where the word taken last stands."""
        return self._words[max(0, self._next - 1)][1] if self._words else 1


def _float(word: str) -> float | None:
    try:
        return float(word.replace(",", "."))
    except ValueError:
        return None


def _hierarchy(text: str) -> list[_Joint]:
    tokens = _Tokens(text)
    joints: list[_Joint] = []
    open_: list[int | None] = []
    """Joints whose braces are open; None for an end site."""
    for word in tokens:
        match word.upper():
            case "HIERARCHY":
                pass
            case "ROOT" | "JOINT":
                parent = open_[-1] if open_ else -1
                if parent is None:
                    raise BvhError(f"line {tokens.line}: a joint below an end site")
                joints.append(_Joint(tokens.name(), parent))
                open_.append(len(joints) - 1)
            case "END":
                tokens.name()
                open_.append(None)
            case "OFFSET":
                place = tokens.numbers(3)
                if not open_:
                    raise BvhError(f"line {tokens.line}: an OFFSET outside of all joints")
                if open_[-1] is None:
                    above = next(j for j in reversed(open_) if j is not None)
                    joints[above].tip = place
                else:
                    joints[open_[-1]].offset = place
            case "CHANNELS":
                if not open_ or open_[-1] is None:
                    raise BvhError(f"line {tokens.line}: CHANNELS outside of all joints")
                joints[open_[-1]].channels = _channels(tokens)
            case "}":
                if not open_:
                    raise BvhError(f"line {tokens.line}: a `}}` without its `{{`")
                open_.pop()
            case _:
                raise BvhError(f"line {tokens.line}: `{word}` is not part of a BVH hierarchy")
    if open_:
        raise BvhError("the hierarchy ends before all its braces are closed")
    if not joints:
        raise BvhError("the hierarchy has no joints")
    return joints


def _channels(tokens: _Tokens) -> list[tuple[str, int]]:
    (count,) = tokens.numbers(1)
    channels = []
    for _ in range(int(count)):
        word = tokens.take("a channel")
        found = _CHANNEL.fullmatch(word)
        if found is None:
            raise BvhError(f"line {tokens.line}: `{word}` is not a channel")
        channels.append((found[2].lower(), "xyz".index(found[1].lower())))
    return channels


def _motion(
    text: str, line: int, joints: Sequence[_Joint], notes: list[str]
) -> tuple[Floats, Floats]:
    """Read times (T,) and channel values (T, C)."""
    frames, start = _FRAMES.match(text), 0
    if frames:
        start = frames.end()
    step = _FRAME_TIME.match(text, start)
    if step:
        start = step.end()
    width = sum(len(j.channels) for j in joints)
    if not width:
        raise BvhError("no joint has a channel: nothing can move")
    numbers = _numbers(text[start:], line + text.count("\n", 0, start))
    count, rest = divmod(len(numbers), width)
    if rest:
        notes.append(f"the last frame has {rest} of {width} values and is left out")
    if not count:
        raise BvhError("there is no whole frame")
    declared = _float(frames[1]) if frames else None
    if declared != count:
        said = "no number of frames" if declared is None else f"{declared:g} frames"
        notes.append(f"the file says {said} and has {count}: {count} are kept")
    seconds = _float(step[1]) if step else None
    if seconds is None or not (np.isfinite(seconds) and seconds > 0):
        notes.append("the file says no frame time: 30 frames a second are taken")
        seconds = USUAL_FRAME_S
    times = np.arange(count, dtype=np.float64) * seconds
    return times, numbers[: count * width].reshape(count, width)


def _numbers(text: str, line: int) -> Floats:
    try:
        numbers = np.array(text.split(), dtype=np.float64)
    except ValueError:
        numbers = np.array(list(_one_by_one(text, line)))
    if not np.isfinite(numbers).all():
        raise BvhError("a value of the motion is infinite or not a number")
    return numbers


def _one_by_one(text: str, line: int) -> Iterator[float]:
    for number, row in enumerate(text.splitlines(), line):
        for word in row.split():
            value = _float(word)
            if value is None:
                raise BvhError(f"line {number}: `{word}` is not a number")
            yield value


def _recording(
    joints: Sequence[_Joint], times: Floats, values: Floats, unit: str | None, notes: list[str]
) -> Recording:
    offsets = np.array([j.offset for j in joints])
    translations = np.tile(offsets, (len(times), 1, 1))
    rotations = np.empty((len(times), len(joints), 4))
    column = 0
    scaled = False
    for j, joint in enumerate(joints):
        R = np.broadcast_to(np.eye(3), (len(times), 3, 3))
        moved: dict[int, Floats] = {}
        for kind, axis in joint.channels:
            if kind == "rotation":
                R = R @ about_axis(axis, np.radians(values[:, column]))
            elif kind == "position":
                moved[axis] = values[:, column]
            scaled |= kind == "scale"
            column += 1
        rotations[:, j] = to_quaternions(R)
        if moved:
            translations[:, j] = _placed(joint, offsets[j], moved, notes)
    if scaled:
        notes.append("its channels of scale are left out")
    skeleton = Skeleton(
        tuple(j.name for j in joints), np.array([j.parent for j in joints]), offsets
    )
    tips = {i: np.array(j.tip) for i, j in enumerate(joints) if j.tip is not None}
    read = Recording(skeleton, tips, times, rotations, translations)
    metre = UNITS_M[unit] if unit else _guessed_unit(read, notes)
    return Recording(
        Skeleton(skeleton.names, skeleton.parents, offsets * metre),
        {j: tip * metre for j, tip in tips.items()},
        times,
        rotations,
        translations * metre,
        tuple(notes),
    )


def _placed(joint: _Joint, offset: Floats, moved: dict[int, Floats], notes: list[str]) -> Floats:
    """Places of a joint that slides, (T, 3), whether its channels replace its offset or add."""
    axes = sorted(moved)
    channels = np.stack([moved[axis] for axis in axes], axis=1)
    along = offset[axes]
    square = float(along @ along)
    added = square > 0 and float(np.median(channels, axis=0) @ along) < 0.5 * square
    places = np.tile(offset, (len(channels), 1))
    places[:, axes] = channels + along if added else channels
    if added:
        notes.append(f"the positions of `{joint.name}` are taken as added to its OFFSET")
    return places


def _guessed_unit(read: Recording, notes: list[str]) -> float:
    places, turned = read.frames()
    ends = [places[0, j] + turned[0, j] @ tip for j, tip in read.tips.items()]
    extent = float(np.ptp(np.vstack([places[0], *ends]), axis=0).max())
    names = " ".join(read.skeleton.names).lower()
    if not any(word in names for word in TRUNK) or extent == 0.0:
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
