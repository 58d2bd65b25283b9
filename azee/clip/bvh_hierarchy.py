"""The first half of a BVH file: joints, their places at rest and their channels."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

LARGEST_NUMBER = 1e9
"""No length and no angle of a file is larger, in whatever unit."""
LONGEST_SHOWN = 40
"""Characters of a file's word that a message quotes."""
MOST_CHANNELS = 9
"""Three of place, three of turn, three of scale."""

_TOKEN = re.compile(r"[{}]|[^\s{}]+")
_CHANNEL = re.compile(r"([xyz])(rotation|position|scale)", re.IGNORECASE)


class BvhError(Exception):
    """A file that is no BVH, or a damaged one. The message is for the user and names the line."""


@dataclass(eq=False)
class Joint:
    """A joint as the file has it: lengths in the file's unit.

    channels: kind and axis of each. tip: where its bone ends, if it has an end site.
    """

    name: str
    parent: int
    offset: tuple[float, ...] = (0.0, 0.0, 0.0)
    channels: list[tuple[str, int]] = field(default_factory=list)
    tip: tuple[float, ...] | None = None


def read_hierarchy(text: str, notes: list[str]) -> list[Joint]:
    """Read joints, parents before children; no two have one name.

    Args: notes: grows by what had to be put right.
    Raises: BvhError: the hierarchy is damaged.
    """
    tokens = _Tokens(text)
    joints: list[Joint] = []
    open_: list[int | None] = []
    """Joints whose braces are open; None for an end site."""
    too_many: list[int] = []
    """Lines of braces that close nothing."""
    for word in tokens:
        match word.upper():
            case "HIERARCHY":
                pass
            case "ROOT" | "JOINT":
                parent = open_[-1] if open_ else -1
                if parent is None:
                    raise BvhError(f"line {tokens.line}: a joint below an end site")
                joints.append(Joint(tokens.name(), parent))
                open_.append(len(joints) - 1)
            case "END":
                if not open_ or open_[-1] is None:
                    raise BvhError(f"line {tokens.line}: an end site outside of all joints")
                tokens.name()
                open_.append(None)
            case "OFFSET":
                place = tokens.numbers(3)
                if not open_:
                    raise BvhError(f"line {tokens.line}: an OFFSET outside of all joints")
                if (at := open_[-1]) is not None:
                    joints[at].offset = place
                elif (above := open_[-2]) is not None:
                    joints[above].tip = place
            case "CHANNELS":
                if not open_ or (at := open_[-1]) is None:
                    raise BvhError(f"line {tokens.line}: CHANNELS outside of all joints")
                if joints[at].channels:
                    raise BvhError(f"line {tokens.line}: a second CHANNELS of one joint")
                joints[at].channels = _channels(tokens)
            case "}":
                if open_:
                    open_.pop()
                else:
                    too_many.append(tokens.line)
            case _:
                raise BvhError(
                    f"line {tokens.line}: `{shown(word)}` is not part of a BVH hierarchy"
                )
    if open_:
        raise BvhError("the hierarchy ends before all its braces are closed")
    if not joints:
        raise BvhError("the hierarchy has no joints")
    if too_many:
        notes.append(f"line {too_many[0]}: a `}}` without its `{{` is left out")
    _tell_apart(joints, notes)
    return joints


def _tell_apart(joints: list[Joint], notes: list[str]) -> None:
    """Give joints of one name names of their own, the first keeping it."""
    counts = Counter(joint.name for joint in joints)
    taken = set(counts)
    twice = [name for name, count in counts.items() if count > 1]
    if not twice:
        return
    seen: Counter[str] = Counter()
    for joint in joints:
        name = joint.name
        seen[name] += 1
        number = seen[name]
        if number == 1:
            continue
        while f"{name}_{number}" in taken:
            number += 1
        joint.name = f"{name}_{number}"
        taken.add(joint.name)
    more = f" and {len(twice) - 1} further names" if len(twice) > 1 else ""
    called = f"{counts[twice[0]]} joints are called `{shown(twice[0])}`{more}"
    notes.append(f"{called}: they are told apart by where they stand")


class _Tokens:
    """Words of the hierarchy, with the line that each stands on."""

    def __init__(self, text: str) -> None:
        self._words = [
            (word.group(), number)
            for number, line in enumerate(text.split("\n"), 1)
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
        """All words before the next `{`. Raises: BvhError: the joint begins without it."""
        words = []
        while (word := self.take("`{`")) != "{":
            if word in ("OFFSET", "CHANNELS", "}"):
                raise BvhError(f"line {self.line}: `{shown(word)}` where `{{` should stand")
            words.append(word)
        return " ".join(words)

    def numbers(self, count: int) -> tuple[float, ...]:
        """Next numbers. Raises: BvhError: a word is none."""
        return tuple(number_of(self.take("a number"), self.line) for _ in range(count))

    @property
    def line(self) -> int:
        """Where the word taken last stands."""
        return self._words[max(0, self._next - 1)][1] if self._words else 1


def shown(word: str) -> str:
    """Return a word of the file as a message may quote it: printable, and not long."""
    plain = "".join(sign if sign.isprintable() else "\N{REPLACEMENT CHARACTER}" for sign in word)
    return plain if len(plain) <= LONGEST_SHOWN else f"{plain[:LONGEST_SHOWN]}…"


def number_of(word: str, line: int) -> float:
    """Return the number that a word is, with a decimal point or comma.

    Raises: BvhError: it is none, or none that a length or an angle could be.
    """
    try:
        value = float(word.rstrip(",;").replace(",", "."))
    except ValueError:
        raise BvhError(f"line {line}: `{shown(word)}` is not a number") from None
    if not np.isfinite(value):
        raise BvhError(f"line {line}: `{shown(word)}` is infinite or not a number")
    if abs(value) > LARGEST_NUMBER:
        raise BvhError(f"line {line}: `{shown(word)}` is too large for a length or an angle")
    return value


def _channels(tokens: _Tokens) -> list[tuple[str, int]]:
    word = tokens.take("a number of channels")
    if not (word.isascii() and word.isdigit() and int(word) <= MOST_CHANNELS):
        raise BvhError(f"line {tokens.line}: `{shown(word)}` is no number of channels")
    channels = []
    for _ in range(int(word)):
        word = tokens.take("a channel")
        found = _CHANNEL.fullmatch(word)
        if found is None:
            raise BvhError(f"line {tokens.line}: `{shown(word)}` is not a channel")
        channels.append((found[2].lower(), "xyz".index(found[1].lower())))
    places = [axis for kind, axis in channels if kind == "position"]
    if len(set(places)) < len(places):
        raise BvhError(f"line {tokens.line}: a joint has one position twice")
    return channels
