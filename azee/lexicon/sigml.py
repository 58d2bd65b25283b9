"""Reads signs of gestural SiGML. Whatever its notation does not allow is told, and read if it can.

Elements and attributes: the public DTD of gestural SiGML (Virtual Humans Group, University of East
Anglia).
"""

from __future__ import annotations

from collections.abc import Sequence

from lxml import etree

from azee.lexicon.codeset import words
from azee.lexicon.faults import FaultLog
from azee.lexicon.model import (
    Circle,
    FingerPlay,
    ForEach,
    InTurn,
    Manner,
    Manual,
    Movement,
    Repeat,
    Sign,
    Still,
    Straight,
    Symmetry,
    Target,
    Together,
    Wrist,
)
from azee.lexicon.sigml_posture import POSTURE_TAGS, PostureReader, heading
from azee.lexicon.sigml_tiers import read_nonmanual
from azee.lexicon.sigml_xml import children

_WRIST = frozenset(("nodding", "swinging", "twisting", "stircw", "stirccw"))
_REPETITIONS = words(
    "fromstart fromstart_several continue continue_several reverse tofroto manyrandom swap"
)
_SIZES = frozenset(("small", "big"))


def read_sign(element: etree._Element) -> Sign:
    """Read one `hamgestural_sign`."""
    log = FaultLog()
    manuals: list[Manual] = []
    nonmanual = read_nonmanual(element.find("sign_nonmanual"), log)
    for manual in element.findall("sign_manual"):
        manuals += _manuals(manual, log)
    if not manuals:
        log.add("no-manual", "the sign has no part for the hands", element.sourceline)
    return Sign(element.get("gloss") or "", tuple(manuals), nonmanual, log.faults)


def _manuals(element: etree._Element, log: FaultLog) -> list[Manual]:
    inner = [child for child in children(element) if child.tag == "sign_manual"]
    if inner:
        return [manual for child in inner for manual in _manuals(child, log)]
    return [_manual(element, log)]


def _manual(element: etree._Element, log: FaultLog) -> Manual:
    reader = _MovementReader(log)
    parts = children(element)
    posture = reader.postures.read([e for e in parts if e.tag in POSTURE_TAGS])
    found = (reader.read(e) for e in parts if e.tag not in POSTURE_TAGS)
    moves = tuple(move for move in found if move is not None)
    symmetry = None
    if _is(element, "both_hands"):
        names = ("lr_symm", "ud_symm", "oi_symm", "outofphase")
        symmetry = Symmetry(*(_is(element, name) for name in names))
    return Manual(posture, moves, symmetry, _is(element, "nondominant"), _is(element, "holdover"))


def _is(element: etree._Element, name: str) -> bool:
    return bool(element.get(name) == "true")


class _MovementReader:
    """Reads movements, with the postures that they lead to."""

    def __init__(self, log: FaultLog) -> None:
        self._log = log
        self.postures = PostureReader(log)

    def read(self, e: etree._Element) -> Movement | None:
        """Read an element; None, told, for what is no movement."""
        manner = self._manner(e)
        match e.tag:
            case "directedmotion":
                return self._straight(e, manner)
            case "circularmotion":
                return self._circle(e, manner)
            case "wristmotion":
                kind = self._known(e, "motion", _WRIST, "nodding")
                return Wrist(kind or "nodding", self._known(e, "size", _SIZES), manner)
            case "fingerplay":
                return FingerPlay(self.postures.digits(e, "digits"), manner)
            case "nomotion" | "no_motion" | "changeposture":
                return Still()
            case "tgt_motion":
                return self._target(e, manner)
            case "par_motion":
                return Together(self._all(children(e)), manner)
            case "seq_motion":
                return InTurn(self._all(children(e)), _is(e, "fused"), manner)
            case "split_motion":
                return self._for_each(e, manner)
            case "rpt_motion":
                return self._repeat(e, manner)
            case _:
                pass
        self._log.add("unknown-element", f"`{e.tag}` is no movement; left out", e.sourceline)
        return None

    def _all(self, elements: Sequence[etree._Element]) -> tuple[Movement, ...]:
        found = (self.read(element) for element in elements)
        return tuple(move for move in found if move is not None)

    def _straight(self, e: etree._Element, manner: Manner) -> Movement | None:
        way = heading(e, "direction", self._log)
        if way is None:
            self._log.add("no-direction", "a movement without direction; left out", e.sourceline)
            return None
        curve = self._known(e, "curve", frozenset("udlr"))
        style = e.get("zigzag_style")
        size = self._known(e, "curve_size", _SIZES)
        brushed = self.postures.touched(e)
        return Straight(way, self._known(e, "size", _SIZES), curve, size, style, brushed, manner)

    def _circle(self, e: etree._Element, manner: Manner) -> Movement | None:
        axis = heading(e, "axis", self._log)
        if axis is None:
            self._log.add("no-direction", "a circle without axis; left out", e.sourceline)
            return None
        return Circle(
            axis,
            self._known(e, "size", _SIZES),
            1 + _is(e, "clockplus") + _is(e, "second_clockplus"),
            self._hour(e, "start"),
            self._hour(e, "end"),
            e.get("ellipse_direction"),
            manner,
        )

    def _hour(self, e: etree._Element, name: str) -> str | None:
        found = heading(e, name, self._log)
        return None if found is None else found.first

    def _target(self, e: etree._Element, manner: Manner) -> Movement:
        parts = children(e)
        posture = self.postures.read([part for part in parts if part.tag in POSTURE_TAGS])
        return Target(
            self._all([part for part in parts if part.tag not in POSTURE_TAGS]), posture, manner
        )

    def _for_each(self, e: etree._Element, manner: Manner) -> Movement | None:
        parts = self._all(children(e))
        if len(parts) != 2:
            self._log.add("not-two-hands", f"{len(parts)} movements for two hands", e.sourceline)
        if not parts:
            return None
        return ForEach(parts[0], parts[1] if len(parts) > 1 else Still(), manner)

    def _repeat(self, e: etree._Element, manner: Manner) -> Movement | None:
        parts = self._all(children(e))
        if not parts:
            return None
        move = parts[0] if len(parts) == 1 else InTurn(parts)
        kind = self._known(e, "repetition", _REPETITIONS, "fromstart") or "fromstart"
        shift = heading(e, "repetition_baseshift", self._log)
        again = self._known(e, "second_repetition", _REPETITIONS)
        return Repeat(move, kind, again, shift, _is(e, "alternating"), manner)

    def _known(
        self, e: etree._Element, name: str, known: frozenset[str], instead: str | None = None
    ) -> str | None:
        value: str | None = e.get(name)
        if value is None or value in known:
            return value
        self._log.add("unknown-value", f'{name}="{value}" is not known', e.sourceline)
        return instead

    def _manner(self, e: etree._Element) -> Manner:
        fast, slow, tense, rest, halt = (
            _is(e, name) for name in ("fast", "slow", "tense", "rest", "halt")
        )
        return Manner(fast, slow, tense, rest, halt, self._log.number(e, "speed"))
