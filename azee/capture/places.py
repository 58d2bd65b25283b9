"""Where on a hand markers are glued, read from their names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from azee.capture.markers import MarkersError, plain_name

DIGITS: Mapping[str, str] = {
    "thumb": "thumb", "index": "index", "middle": "middle", "ring": "ring", "little": "little",
    "pinky": "little", "pinkie": "little", "fore": "index", "long": "middle", "small": "little",
}  # fmt: skip
BONES: Mapping[str, int] = {
    "tip": 3, "nail": 3, "end": 3, "distal": 3, "3": 3, "dip": 3,
    "middle": 2, "mid": 2, "intermediate": 2, "2": 2, "pip": 2,
    "base": 1, "proximal": 1, "knuckle": 1, "1": 1, "mcp": 1,
}  # fmt: skip
"""Bones of a digit from the palm outwards, by the words that name places on them."""
_SITES: Mapping[int, str] = {3: "{D}_NA_{S}", 2: "{D}_KN_{S}_2", 1: "{D}_KN_{S}_1"}
"""Site that a marker on a bone is near."""


@dataclass(frozen=True, slots=True)
class Place:
    """A place on a digit: on which of its bones, 1 … 3 from the palm outwards."""

    digit: str
    bone: int

    def node(self, side: str) -> str:
        """Name of the node of the body that carries it."""
        return f"{self.digit}_{side}_{self.bone}"

    def site(self, side: str) -> str:
        """Name of the body's site that is near."""
        return _SITES[self.bone].format(D=self.digit[0].upper(), S=side)


def place_of(name: str) -> Place | None:
    """Return the place that a marker's name tells, such as `index_tip`; None if it tells none."""
    words = plain_name(name).split("_")
    found = [word for word in words if word in DIGITS]
    if not found:
        return None
    digit = next((word for word in found if word != "middle"), "middle")
    rest = list(words)
    rest.remove(digit)
    bones = {BONES[word] for word in rest if word in BONES}
    return Place(DIGITS[digit], bones.pop()) if len(bones) == 1 else None


def digit_markers(names: Sequence[str]) -> dict[str, Place]:
    """Return the markers whose names tell a place on a digit.

    Raises: MarkersError: there is none.
    """
    found = {name: place for name in names if (place := place_of(name)) is not None}
    if not found:
        raise MarkersError(
            f"no marker's name tells a place on a finger; there are: {', '.join(names)}",
            "names are such as `index_tip`, `thumb_middle`, `ring_base`; --label renames them",
        )
    return found


ROOT_WORDS = ("root", "hand", "palm", "wrist", "forearm")
"""Words with which names of a root's markers begin, where nobody names them."""


def root_markers(names: Sequence[str]) -> tuple[str, ...]:
    """Return the markers that are the root's by their names.

    Raises: MarkersError: there are fewer than three.
    """
    found = tuple(
        name
        for name in names
        if place_of(name) is None and plain_name(name).split("_")[0] in ROOT_WORDS
    )
    if len(found) < 3:
        raise MarkersError(
            f"no three markers are the root's by their names; there are: {', '.join(names)}",
            "name them with --root: markers that do not move against each other",
        )
    return found
