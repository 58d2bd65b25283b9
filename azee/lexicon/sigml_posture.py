"""Reads the postures of gestural SiGML: hands and where they are."""

from __future__ import annotations

from collections.abc import Sequence

from lxml import etree

from azee.lexicon.codes import is_direction, is_palm
from azee.lexicon.codeset import words
from azee.lexicon.faults import FaultLog
from azee.lexicon.model import (
    BASES,
    BODY,
    DIGITS,
    HAND,
    SIDES,
    THUMBS,
    Constellation,
    Crossing,
    EachAt,
    Form,
    HandConfig,
    HandPart,
    HandShape,
    Heading,
    Location,
    OnBody,
    OnHand,
    Posture,
    is_bend,
)
from azee.lexicon.sigml_xml import children

POSTURE_TAGS = words(
    "handconfig split_handconfig location_bodyarm location_hand split_location handconstellation"
    " nonmanualconfig use_locname"
)
_CONTACTS = frozenset(("touch", "close", "armextended"))
_OPENINGS = frozenset(("slack", "tight"))


def heading(
    element: etree._Element, name: str, log: FaultLog, *, palm: bool = False
) -> Heading | None:
    """Read a direction and the second one that makes it lie between; None if there is none."""
    legal = is_palm if palm else is_direction
    codes = []
    for attribute in (name, f"second_{name}"):
        code = element.get(attribute)
        if code is not None and not legal(code):
            kind = "odd-palm" if palm else "odd-direction"
            kept = "".join(c for c in code if c in "udlr") if palm else ""
            told = f'{attribute}="{code}" is not known'
            code = kept if kept and legal(kept) else None
            log.add(
                kind, f"{told}; {f'read as {code}' if code else 'left out'}", element.sourceline
            )
        codes.append(code)
    first, second = codes
    if first is None:
        first, second = second, None
    return None if first is None else Heading(first, None if second == first else second)


class PostureReader:
    """Reads the elements of a posture, in any order."""

    def __init__(self, log: FaultLog) -> None:
        self._log = log

    def read(self, elements: Sequence[etree._Element]) -> Posture:
        """Read a posture; what is said later counts."""
        both, strong, weak = HandConfig(), None, None
        location: Location | None = None
        for e in elements:
            match e.tag:
                case "handconfig":
                    both = both.then(self._config(e))
                case "split_handconfig":
                    pair = [self._config(child) for child in children(e)]
                    if len(pair) != 2:
                        self._tell("not-two-hands", f"{len(pair)} hands where two are", e)
                    strong = (strong or HandConfig()).then(pair[0]) if pair else strong
                    weak = (weak or HandConfig()).then(pair[1]) if pair[1:] else weak
                case "nonmanualconfig" | "use_locname":
                    self._tell("not-read", f"`{e.tag}` is not read", e)
                case _:
                    location = self._location(e) or location
        return Posture(both, strong, weak, location)

    def touched(self, element: etree._Element) -> OnHand | OnBody | None:
        """Read what a movement brushes."""
        for child in children(element):
            if child.tag == "location_hand":
                return self._on_hand(child)
            if child.tag == "location_bodyarm":
                return self._on_body(child)
        return None

    def digits(self, element: etree._Element, name: str) -> str:
        """Read a list of digits, without those that are none."""
        text = element.get(name) or ""
        kept = "".join(dict.fromkeys(c for c in text if c in DIGITS))
        if kept != text:
            self._tell("unknown-value", f'{name}="{text}" has what is no digit', element)
        return kept

    # Hands --------------------------------------------------------------------------------------

    def _config(self, e: etree._Element) -> HandConfig:
        absolute = any(e.get(name) == "true" for name in ("abs_extfidir", "abs_palmor"))
        return HandConfig(
            self._shape(e),
            heading(e, "extfidir", self._log),
            heading(e, "palmor", self._log, palm=True),
            absolute,
        )

    def _shape(self, e: etree._Element) -> HandShape | None:
        base = self._one_of(e, "handshape", BASES)
        if base is None:
            if any(e.get(name) for name in ("mainbend", "thumbpos", "bend2", "specialfingers")):
                self._tell("no-handshape", "modifiers without a handshape are left out", e)
            return None
        form = self._form(e, base, "")
        second = None
        if other := self._one_of(e, "second_handshape", BASES):
            second = self._form(e, other, "second_")
            if second == form:
                self._tell("between-itself", f"between `{base}` and itself", e)
                second = None
        bends = tuple((digit, bend) for digit in DIGITS if (bend := self._bend(e, f"bend{digit}")))
        return HandShape(
            form,
            second,
            self.digits(e, "specialfingers"),
            bends,
            self.digits(e, "exempteddigits"),
            self._crossing(e),
            e.get("thumbenclosed") == "true",
        )

    def _form(self, e: etree._Element, base: str, prefix: str) -> Form:
        return Form(
            base,
            self._bend(e, f"{prefix}mainbend"),
            self._one_of(e, f"{prefix}thumbpos", THUMBS),
            self._one_of(e, f"{prefix}ceeopening", _OPENINGS),
        )

    def _crossing(self, e: etree._Element) -> Crossing | None:
        pair = self.digits(e, "contactpair")
        if len(pair) != 2:
            return None
        return Crossing(pair[0], pair[1], self._one_of(e, "contactkind", HAND) or "tip")

    # Places -------------------------------------------------------------------------------------

    def _location(self, e: etree._Element) -> Location | None:
        match e.tag:
            case "location_bodyarm":
                return self._on_body(e)
            case "location_hand":
                return self._on_hand(e)
            case "split_location":
                pair = [self._one(child) for child in children(e)]
                if len(pair) != 2:
                    self._tell("not-two-hands", f"{len(pair)} places where two are", e)
                return EachAt(pair[0] if pair else None, pair[1] if pair[1:] else None)
            case _:
                return self._constellation(e)

    def _one(self, e: etree._Element) -> OnBody | OnHand | None:
        if e.tag == "location_bodyarm":
            return self._on_body(e)
        if e.tag == "location_hand":
            return self._on_hand(e)
        self._tell("unknown-element", f"`{e.tag}` is no place; left out", e)
        return None

    def _on_body(self, e: etree._Element) -> OnBody:
        own = next((self._part(c, "") for c in children(e) if c.tag == "location_hand"), None)
        return OnBody(
            self._one_of(e, "location", BODY),
            self._one_of(e, "side", SIDES),
            self._one_of(e, "second_location", BODY),
            self._one_of(e, "second_side", SIDES),
            self._one_of(e, "contact", _CONTACTS),
            own,
            e.get("behind") == "true",
        )

    def _on_hand(self, e: etree._Element) -> OnHand:
        second = self._part(e, "second_")
        own = next((self._part(c, "") for c in children(e) if c.tag == "location_hand"), None)
        return OnHand(
            self._part(e, ""),
            None if second == HandPart() else second,
            self._one_of(e, "contact", _CONTACTS),
            own,
        )

    def _part(self, e: etree._Element, prefix: str) -> HandPart:
        return HandPart(
            self.digits(e, f"{prefix}digits"),
            self._one_of(e, f"{prefix}location", HAND),
            self._one_of(e, f"{prefix}side", SIDES),
        )

    def _constellation(self, e: etree._Element) -> Constellation:
        hands = [self._on_hand(c) for c in children(e) if c.tag == "location_hand"]
        bodies = [self._on_body(c) for c in children(e) if c.tag == "location_bodyarm"]
        if len(hands) == 1:
            self._tell("not-two-hands", "one hand's part where two are; left out", e)
            hands = []
        return Constellation(
            hands[0] if hands else None,
            hands[1] if hands else None,
            bodies[0] if bodies else None,
            self._one_of(e, "contact", _CONTACTS),
        )

    # --------------------------------------------------------------------------------------------

    def _bend(self, e: etree._Element, name: str) -> str | None:
        code: str | None = e.get(name)
        if code is None or is_bend(code):
            return code
        self._tell("unknown-bend", f'{name}="{code}" is no bend; left out', e)
        return None

    def _one_of(self, e: etree._Element, name: str, known: frozenset[str]) -> str | None:
        value: str | None = e.get(name)
        if value is None or value in known:
            return value
        self._tell("unknown-value", f'{name}="{value}" is not known; left out', e)
        return None

    def _tell(self, kind: str, detail: str, e: etree._Element) -> None:
        self._log.add(kind, detail, e.sourceline)
