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

    fingers, palm: as notated. flip: factors of x, y and z from there to the world, which a weak
    hand has that does what the strong hand does.
    """

    shape: HandShape | None = None
    fingers: Heading | None = None
    palm: Heading | None = None
    flip: Vector = NO_FLIP
    site: Site | None = None
    place: Place | None = None

    def with_config(self, config: HandConfig, flip: Vector) -> Hand:
        """Return the hand with what a notation says of it."""
        turned = config.fingers is not None or config.palm is not None
        return replace(
            self,
            shape=config.shape or self.shape,
            fingers=config.fingers or self.fingers,
            palm=config.palm or self.palm,
            flip=flip if turned else self.flip,
        )

    @property
    def pointing(self) -> Vector | None:
        """Where the fingers point, in the world."""
        return None if self.fingers is None else flipped(direction(self.fingers), self.flip)

    @property
    def facing(self) -> Vector | None:
        """Where the palm looks, in the world."""
        if self.fingers is None or self.palm is None:
            return None
        return flipped(palm_normal(direction(self.fingers), self.palm), self.flip)

    def put(self, site: Site, place: Place) -> Hand:
        """Return the hand with one of its sites at a place."""
        return replace(self, site=site, place=place)


Hands: TypeAlias = Mapping[str, Hand]
"""The hands s and w."""


def changed(hands: Hands, change: Callable[[str, Hand], Hand], *which: str) -> Hands:
    """Return hands of which some are changed."""
    return {name: change(name, hand) if name in which else hand for name, hand in hands.items()}


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
