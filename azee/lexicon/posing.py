"""Puts hands into a notated posture."""

from __future__ import annotations

from dataclasses import dataclass, replace

from azee.lexicon.hand_sites import site_of, usual_site
from azee.lexicon.hand_text import Told
from azee.lexicon.hands import Hand, Hands, changed, config_for_weak
from azee.lexicon.model import (
    Constellation,
    EachAt,
    HandPart,
    Location,
    OnBody,
    OnHand,
    Posture,
    Symmetry,
)
from azee.lexicon.places import Place, Site, apart, body_place, other
from azee.lexicon.sizes import NEAR_M
from azee.lexicon.vectors import Vector, cross, dot, plus, times

_BACK: Vector = (0, 0, -1)
_PAST = 0.3
"""Cosine of the angle at which a palm looks past something."""
_SPREAD_M = {"PA": 0.015, "H_BACK": 0.015, "I_KNt": 0.045, "H_EDGE": 0.045, "M_TIP": 0.11}
"""How far each site is from the middle of the hand, of the reference signer."""


@dataclass(frozen=True, slots=True)
class Posing:
    """Applies postures to hands. symmetry is None where hands do not do the same."""

    symmetry: Symmetry | None
    told: Told

    def pose(self, posture: Posture, hands: Hands, sides: tuple[str, ...]) -> Hands:
        """Return hands as a posture says. sides: the hands that it is about."""
        for name in sides:
            config = posture.both
            if name == "w":
                config = config_for_weak(config, self.symmetry)
            hands = {**hands, name: hands[name].with_config(config)}
        for name, own in (("s", posture.strong), ("w", posture.weak)):
            if own is not None:
                hands = {**hands, name: hands[name].with_config(own)}
        if posture.location is None:
            return hands
        return self._located(posture.location, hands, sides)

    def _located(self, location: Location, hands: Hands, sides: tuple[str, ...]) -> Hands:
        match location:
            case OnBody():
                return changed(
                    hands, lambda name, hand: self._on_body(location, name, hand, hands), *sides
                )
            case OnHand():
                return self._on_hand(location, hands, sides[0])
            case EachAt():
                return self._each(location, hands)
            case Constellation():
                return self._beside_each_other(location, hands)

    def _on_body(self, where: OnBody, name: str, hand: Hand, hands: Hands) -> Hand:
        """Return a hand at the body; of two hands, the weak one is opposite the strong one."""
        if where.behind:
            self.told("behind", "a place behind the body is at it")
        if name == "w" and self.symmetry is not None:
            strong = self._on_body(where, "s", hands["s"], hands)
            assert strong.site is not None
            assert strong.place is not None
            site, place = strong.site.mirrored(), strong.place.mirrored()
            if where.own is None:
                site = _usual_site(hand, "w", place)
            return hand.put(site, place)
        place = body_place(where, name)
        if self.symmetry is not None and not (where.side or where.second_side):
            place = apart(place)
        return hand.put(self._own(where.own, name, hand, place), place)

    def _own(self, part: HandPart | None, name: str, hand: Hand, place: Place) -> Site:
        if part is None:
            return _usual_site(hand, name, place)
        self._tell_digits(part)
        return site_of(part, name, hand.pointing, hand.facing, hand.shape)

    def _tell_digits(self, part: HandPart) -> None:
        if len(part.digits) > 1:
            self.told("several-digits", "one of several fingers is at its place")

    def _on_hand(self, where: OnHand, hands: Hands, name: str) -> Hands:
        """Return hands of which one is at a part of the other."""
        base = hands[other(name)]
        self._tell_digits(where.at)
        first = site_of(where.at, other(name), base.pointing, base.facing, base.shape)
        sites: tuple[Site, ...] = (first,)
        if where.second is not None:
            part = where.second
            if part.part is None:
                part = replace(part, part=where.at.part)
            between = site_of(part, other(name), base.pointing, base.facing, base.shape)
            sites = (first, between) if between != first else sites
        touches = where.contact != "close"
        own = self._own(where.own, name, hands[name], Place(sites, touches=True))
        place = Place(sites, touches=touches, gap=0.0 if touches else NEAR_M)
        if base.place is None:
            hands = {**hands, other(name): _somewhere(base, other(name))}
        return {**hands, name: hands[name].put(own, place)}

    def _each(self, location: EachAt, hands: Hands) -> Hands:
        pair = [("s", location.strong), ("w", location.weak)]
        for name, where in sorted(pair, key=lambda entry: isinstance(entry[1], OnHand)):
            if isinstance(where, OnHand):
                hands = self._on_hand(where, hands, name)
            elif where is not None:
                place = body_place(where, name)
                own = self._own(where.own, name, hands[name], place)
                hands = {**hands, name: hands[name].put(own, place)}
        return hands

    # Two hands beside each other ----------------------------------------------------------------

    def _beside_each_other(self, where: Constellation, hands: Hands) -> Hands:
        strong, weak = hands["s"], hands["w"]
        middle = body_place(where.place or OnBody("chest"))
        stays = False
        if where.place is None and weak.place is not None:
            if self.symmetry is None:
                stays = True
            else:
                middle = weak.place  # they meet where they met before
        if where.weak is None or where.strong is None:
            return self._facing(where, hands, middle)
        on_weak = self._sites(where.weak, "w", weak)
        on_strong = self._sites(where.strong, "s", strong)
        if not stays:
            weak = weak.put(on_weak[0], middle)
        touches = where.contact != "close"
        place = Place(on_weak, touches=touches, gap=0.0 if touches else NEAR_M)
        return {"s": strong.put(on_strong[0], place), "w": weak}

    def _sites(self, where: OnHand, name: str, hand: Hand) -> tuple[Site, ...]:
        self._tell_digits(where.at)
        first = site_of(where.at, name, hand.pointing, hand.facing, hand.shape)
        if where.second is None:
            return (first,)
        second = site_of(where.second, name, hand.pointing, hand.facing, hand.shape)
        return (first,) if second == first else (first, second)

    def _facing(self, where: Constellation, hands: Hands, middle: Place) -> Hands:
        """Return hands beside each other where no parts of them are said.

        They meet with the sites that look at each other.
        """
        sites = {name: _facing_site(hand, name, _inward(name)) for name, hand in hands.items()}
        if where.contact == "touch":
            weak = hands["w"].put(sites["w"], middle)
            return {"s": hands["s"].put(sites["s"], Place((sites["w"],), touches=True)), "w": weak}
        out = {}
        for name, hand in hands.items():
            away = _SPREAD_M[sites[name].name] + NEAR_M / 2
            way: Vector = (-away if name == "s" else away, 0, 0)
            place = replace(middle, offset=plus(middle.offset, way), touches=False)
            out[name] = hand.put(Site("PA", name), place)
        return out


def _inward(name: str) -> Vector:
    """Return where the other hand is."""
    return (1, 0, 0) if name == "s" else (-1, 0, 0)


def _usual_site(hand: Hand, name: str, place: Place) -> Site:
    """Return the site that is at the body where no part of the hand is said.

    A palm that looks past what it touches cannot touch it: the side of the hand does that is there.
    """
    usual, palm = usual_site(hand.shape, name, touches=place.touches), hand.facing
    if not place.touches or place.is_at_hand or usual.name != "PA" or palm is None:
        return usual
    at_side = any(site.hand is not None for site in place.sites)
    looks = max(dot(palm, _BACK), dot(palm, _inward(name)) if at_side else -1)
    return usual if looks > _PAST else _facing_site(hand, name, _BACK)


def _facing_site(hand: Hand, name: str, towards: Vector) -> Site:
    """Return the site of a hand that looks most in a direction."""
    fingers, palm = hand.pointing, hand.facing
    if fingers is None or palm is None:
        return Site("PA", name)
    thumb = times(cross(fingers, palm), 1 if name == "s" else -1)
    looks: dict[Site, Vector] = {
        Site("PA", name): palm,
        Site("I_KNt", name, 1): thumb,
        Site("M_TIP", name): fingers,
        Site("H_BACK", name): times(palm, -1),
        Site("H_EDGE", name): times(thumb, -1),
    }
    return max(looks, key=lambda site: dot(looks[site], towards))


def _somewhere(hand: Hand, name: str) -> Hand:
    """Return a hand before the chest, where nothing is said of its place."""
    place = apart(body_place(OnBody("chest")))
    return hand.put(Site("PA", name), place if name == "s" else place.mirrored())


def located(hands: Hands, names: tuple[str, ...]) -> Hands:
    """Return hands of which those without a place are before the chest."""
    out = dict(hands)
    for name in names:
        if hands[name].place is None:
            if len(names) > 1:
                out[name] = _somewhere(hands[name], name)
            else:
                out[name] = hands[name].put(Site("PA", name), body_place(OnBody("chest")))
    return out
