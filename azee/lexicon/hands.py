"""What a hand is like at a moment of a sign, as vectors, sites and places."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TypeAlias

from azee.lexicon.codes import direction, palm_normal
from azee.lexicon.model import HandConfig, HandShape, Heading, Symmetry
from azee.lexicon.places import Place, Site
from azee.lexicon.vectors import Vector

NO_FLIP: Vector = (1, 1, 1)


@dataclass(frozen=True, slots=True)
class Hand:
    """A hand at a moment; None is what nothing has been said of.

    fingers, palm: as they are notated for this hand alone, so left and right are those of a
    right-handed signer.
    """

    shape: HandShape | None = None
    fingers: Heading | None = None
    palm: Heading | None = None
    site: Site | None = None
    place: Place | None = None

    def with_config(self, config: HandConfig) -> Hand:
        """Return the hand with what a notation says of it alone."""
        return replace(
            self,
            shape=config.shape or self.shape,
            fingers=config.fingers or self.fingers,
            palm=config.palm or self.palm,
        )

    @property
    def pointing(self) -> Vector | None:
        """Where the fingers point."""
        return None if self.fingers is None else direction(self.fingers)

    @property
    def facing(self) -> Vector | None:
        """Where the palm looks."""
        if self.fingers is None or self.palm is None:
            return None
        return palm_normal(direction(self.fingers), self.palm)

    def put(self, site: Site, place: Place) -> Hand:
        """Return the hand with one of its sites at a place."""
        return replace(self, site=site, place=place)


Hands: TypeAlias = Mapping[str, Hand]
"""The hands s and w."""


def changed(hands: Hands, change: Callable[[str, Hand], Hand], *which: str) -> Hands:
    """Return hands of which some are changed."""
    return {name: change(name, hand) if name in which else hand for name, hand in hands.items()}


def config_for_weak(config: HandConfig, symmetry: Symmetry | None) -> HandConfig:
    """Return what is said of two hands as the weak hand does it.

    Mirrors swap letters: `l` and `r`, `u` and `d`, `o` and `i`. A palm is notated about the
    fingers; swapping its letters too mirrors where it looks. A mirror between out and in does so
    only for fingers that point out or in.
    """
    if symmetry is None:
        return config
    swapped: dict[str, str] = {}
    for applies, pair in (
        (symmetry.left_right, "lr"),
        (symmetry.up_down, "ud"),
        (symmetry.out_in, "oi"),
    ):
        if applies:
            swapped |= {pair[0]: pair[1], pair[1]: pair[0]}
    return replace(
        config,
        fingers=_swapped(config.fingers, swapped),
        palm=_swapped(config.palm, swapped),
    )


def _swapped(heading: Heading | None, letters: Mapping[str, str]) -> Heading | None:
    if heading is None:
        return None

    def swap(code: str | None) -> str | None:
        return None if code is None else "".join(letters.get(c, c) for c in code)

    return Heading(swap(heading.first) or heading.first, swap(heading.second))


def flip_of(symmetry: Symmetry | None) -> Vector:
    """Return the factors of x, y and z that lead from the strong hand to the weak one."""
    if symmetry is None:
        return NO_FLIP
    return (
        -1 if symmetry.left_right else 1,
        -1 if symmetry.up_down else 1,
        -1 if symmetry.out_in else 1,
    )


def flipped(vector: Vector, flip: Vector) -> Vector:
    """Return a direction or a way, flipped."""
    return vector[0] * flip[0], vector[1] * flip[1], vector[2] * flip[2]


def flipped_axis(axis: Vector, flip: Vector) -> Vector:
    """Return an axis of turning, flipped: each flip turns the sense of turning round."""
    sense = flip[0] * flip[1] * flip[2]
    return axis[0] * flip[0] * sense, axis[1] * flip[1] * sense, axis[2] * flip[2] * sense
