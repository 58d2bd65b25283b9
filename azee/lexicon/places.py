"""Where a hand can be: at a site of the body, between two, or in space; moved from there."""

from __future__ import annotations

from dataclasses import dataclass, replace

from azee.lexicon.codeset import words
from azee.lexicon.model import ARM, FACE, OnBody
from azee.lexicon.sizes import (
    APART_M,
    AT_SIDE_M,
    BESIDE_M,
    FORWARD_M,
    HEIGHT_M,
    OFF_FACE_M,
)
from azee.lexicon.vectors import ZERO, Vector, is_close, mirrored, plus, times


@dataclass(frozen=True, slots=True)
class Site:
    """A site of the body. hand: s or w, the side it is on; None for one in the middle."""

    name: str
    hand: str | None = None
    phalanx: int | None = None

    def mirrored(self) -> Site:
        """Return the site of the other side."""
        return self if self.hand is None else replace(self, hand=other(self.hand))

    @property
    def text(self) -> str:
        """The site in AZee."""
        operands = [str(part) for part in (self.hand, self.phalanx) if part is not None]
        return f"@{self.name}" + (f"({', '.join(operands)})" if operands else "")


@dataclass(frozen=True, slots=True)
class Place:
    """A point: a site, the middle of two, or without any the middle of the shoulder line; moved.

    touches: whether the surfaces are meant to meet there. gap: else how far they are apart, along
    the normal of the site. origin, way: where a hand came from that moved there, and how far.
    """

    sites: tuple[Site, ...] = ()
    offset: Vector = ZERO
    touches: bool = False
    gap: float = 0.0
    origin: Place | None = None
    way: Vector = ZERO

    @property
    def is_space(self) -> bool:
        """Whether it is counted from the shoulders, not from a site."""
        return not self.sites

    @property
    def is_on_skin(self) -> bool:
        """Whether the point is on the skin: at a site, or between two that are not on a hand.

        A contact between two sites of trunk, neck and head is where the skin is nearest.
        """
        if not self.sites or not is_close(self.offset, ZERO, _LEAST_M):
            return False
        return len(self.sites) == 1 or not self.is_at_hand

    @property
    def is_at_hand(self) -> bool:
        """Whether it is at a site of a hand, which moves by itself."""
        return any(site.name in HAND_SITES or site.phalanx is not None for site in self.sites)

    def moved(self, way: Vector) -> Place:
        """Return the place that lies a vector further; nothing touches there."""
        offset = plus(self.offset, way)
        return Place(self.sites, offset, origin=self, way=way)

    def way_from(self, start: Place) -> Vector | None:
        """Return how far a hand moved from another place; None if it did not come from there."""
        total, place = ZERO, self
        while place != start:
            if place.origin is None:
                return None
            total, place = plus(total, place.way), place.origin
        return total if place is not self else None

    def mirrored(self) -> Place:
        """Return the place on the other side."""
        sites = tuple(site.mirrored() for site in self.sites)
        return replace(self, sites=sites, offset=mirrored(self.offset))


_LEAST_M = 0.0005
"""Places that are nearer to each other are the same."""
HAND_SITES = words(
    "PA H_BACK H_EDGE WR WRi WRt T_BALL I_TIP M_TIP R_TIP L_TIP T_TIP I_PAD M_PAD R_PAD L_PAD T_PAD"
    " I_NA M_NA R_NA L_NA T_NA F_ARM F_ARMi EL ELi ARM"
)

_FACE_SITES = {
    "forehead": "FH",
    "eyebrows": "EB",
    "eyes": "EYE",
    "uppereyelid": "EYE",
    "lowereyelid": "EYE",
    "nose": "NO",
    "nostrils": "NSP",
    "ear": "EAR",
    "earlobe": "LOBE",
    "cheek": "CK",
    "lips": "MO",
    "upperlip": "MO",
    "lowerlip": "MO",
    "tongue": "TO",
    "teeth": "MO",
    "chin": "CH",
    "underchin": "CHu",
}
_BOTH_SIDES = frozenset(("EB", "EYE", "EAR", "LOBE", "CK", "SH"))
"""Sites that there are two of and none in the middle."""
_SIDED = frozenset(("FH", "NO", "MO", "CH", "HEAD", "NK", "ST", "ABST", "AB"))
"""Sites in the middle that have one on either side."""
_ARM_SITES = {"upperarm": "ARM", "elbow": "EL", "elbowinside": "ELi", "lowerarm": "F_ARM"}
_TRUNK_SITES = {
    "headtop": "HEAD",
    "head": "HEAD",
    "neck": "NK",
    "shouldertop": "SH",
    "shoulders": "ST",
    "chest": "ST",
    "stomach": "ABST",
    "belowstomach": "AB",
}
_BESIDE_M = 0.03
"""How far beside a part of the face a place beside it is, where nothing touches."""
_BESIDE = {
    "forehead": "TE",
    "eyebrows": "EBe",
    "eyes": "CB",
    "uppereyelid": "CB",
    "lowereyelid": "CB",
    "nose": "CK",
    "nostrils": "CK",
    "cheek": "CB",
    "lips": "CDL",
    "upperlip": "CDL",
    "lowerlip": "CDL",
}
"""Sites of the skin beside parts of the face."""


def other(hand: str) -> str:
    """Return the other hand of s and w."""
    return "w" if hand == "s" else "s"


def body_place(where: OnBody, hand: str = "s") -> Place:
    """Return the place that is meant for one hand; left and right are those of the signer."""
    at, second = where.at, where.second or where.at
    if where.second is None and where.second_side is None:
        return _one(at, where.side, where.contact, hand)
    if (at in FACE) != (second in FACE) and not {at, second} & ARM and where.contact != "touch":
        above = _space(at or "chest", where.side, where.contact, hand)
        return _middle(above, _space(second or "chest", where.second_side, where.contact, hand))
    first = _one(at, where.side, where.contact, hand)
    return _middle(first, _one(second, where.second_side, where.contact, hand))


def apart(place: Place) -> Place:
    """Return the place of the strong hand, where two hands share a place in the middle.

    Hands that touch the body are at the sites of their own sides, if it has such sites there.
    """
    if any(site.hand is not None for site in place.sites):
        return place
    if place.touches:
        own = (replace(s, hand="s") if s.name in _SIDED else s for s in place.sites)
        return replace(place, sites=tuple(own))
    return replace(place, offset=plus(place.offset, (-APART_M, 0, 0)))


def _middle(first: Place, second: Place) -> Place:
    offset = times(plus(first.offset, second.offset), 0.5)
    touches = first.touches and second.touches
    if first.is_space != second.is_space:
        return first
    if first.sites == second.sites:
        return replace(first, offset=offset)
    for one, other_one in ((first, second), (second, first)):
        if set(one.sites) < set(other_one.sites):
            return replace(one, offset=offset)
    return Place((*first.sites[:1], *second.sites[:1]), offset, touches)


def _one(at: str | None, side: str | None, contact: str | None, hand: str) -> Place:
    if at in FACE:
        return _face(at, side, contact, hand)
    if at in ARM:
        return Place((Site(_ARM_SITES[at], other(hand)),), touches=contact in ("touch", None))
    if contact == "touch":
        return _skin(at or "chest", side, hand)
    return _space(at or "chest", side, contact, hand)


def _space(at: str, side: str | None, contact: str | None, hand: str) -> Place:
    if side is None and _FACE_SITES.get(at) in _BOTH_SIDES:
        side = "right_at" if hand == "s" else "left_at"
    sideways = {"at": AT_SIDE_M, "beside": BESIDE_M}.get((side or "").rpartition("_")[2])
    x = 0.0 if sideways is None else sideways[contact] * _sign(side)
    return Place(offset=(x, HEIGHT_M[at], FORWARD_M[contact]))


def _skin(at: str, side: str | None, hand: str) -> Place:
    name = _TRUNK_SITES[at]
    if at == "head" and not _sign(side):
        name = "FH"
    site = _sited(name, side, hand)
    if at == "chest":  # lower than the sternum, at whose top the site is
        return Place((site, _sited("ABST", side, hand)), touches=True)
    return Place((site,), touches=True)


def _face(at: str, side: str | None, contact: str | None, hand: str) -> Place:
    site = _sited(_FACE_SITES[at], side, hand)
    offset: Vector = ZERO
    sign, beside = _sign(side), (side or "").endswith("_beside")
    if contact in ("touch", None):
        if beside and at in _BESIDE:
            site = Site(_BESIDE[at], "w" if sign > 0 else "s")
        return Place((site,), offset, touches=True)
    if beside:
        offset = plus(offset, (sign * _BESIDE_M, 0, 0))
    away = OFF_FACE_M[contact]
    outward = -1 if site.hand == "s" else 1
    if site.name in ("EAR", "LOBE"):
        return Place((site,), plus(offset, (outward * away, 0, 0)))
    if site.hand is not None and site.name in ("CK", "FH", "EYE", "EB"):
        return Place((site,), plus(offset, (outward * 0.7 * away, 0, 0.5 * away)))
    return Place((site,), plus(offset, (0, 0, away)))


def _sited(name: str, side: str | None, hand: str) -> Site:
    """Return a site, on the side that is said, or on the hand's own if it must be on one."""
    sign = _sign(side)
    if name in _BOTH_SIDES or (name in _SIDED and sign):
        return Site(name, {1: "w", -1: "s", 0: hand}[sign])
    return Site(name)


def _sign(side: str | None) -> int:
    """Return where x goes: 1 to the left, -1 to the right, 0 if no side is said."""
    if side is None:
        return 0
    return {"left": 1, "right": -1}.get(side.partition("_")[0], 0)
