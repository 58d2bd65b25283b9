"""Reads what else than hands moves in gestural SiGML: mouth, face, head, trunk, shoulders.

Codes: the non-manual section of the public DTD of gestural SiGML.
"""

from __future__ import annotations

from lxml import etree

from azee.lexicon.codeset import words
from azee.lexicon.faults import FaultLog
from azee.lexicon.model import NonManual, Tier
from azee.lexicon.sigml_xml import children

TIERS = {
    "head_movement": "head",
    "body_movement": "body",
    "shoulder_movement": "shoulders",
    "eye_brows": "brows",
    "eye_lids": "lids",
    "eye_gaze": "gaze",
    "nose": "nose",
    "mouth_gesture": "mouth",
    "extra_movement": "extra",
}
"""The elements of single movements, and what they move."""
CODES = {
    "head": words("NO SH SR SL TR TL NF NB PF PB LI MN"),
    "body": words("RL RR TL TR TF TB SI HE ST RD"),
    "shoulders": words("UL UR UB HL HR HB SL SR SB"),
    "brows": words("RB RR RL FU"),
    "lids": words("WB WR WL SB SR SL CB CR CL TB TR TL BB"),
    "gaze": words("AD FR HD HI HC UP DN LE RI NO RO LU LD RU RD"),
}
_MEANT = {("head", "ND"): "NF", ("head", "NU"): "NB", ("brows", "DN"): "FU"}
"""Codes that the notation does not have, and those that they are read as."""
_FAULTS = {
    ("gaze", "facialexpr_tier"): "gaze-in-face-tier",
    ("shoulders", "head_tier"): "shoulder-in-head-tier",
}


def read_nonmanual(element: etree._Element | None, log: FaultLog) -> NonManual:
    """Read the tiers. What stands in a wrong one is told and read."""
    if element is None:
        return NonManual()
    mouthing = ""
    tiers: list[Tier] = []
    for tier in children(element):
        for e in tier.iter():
            if e.tag == "mouth_picture":
                picture = e.get("picture") or ""
                if _is_gesture(picture):
                    log.add(
                        "gesture-as-mouthing",
                        f"`{picture}` is the code of a gesture, not of a sound",
                        e.sourceline,
                    )
                    tiers.append(Tier("mouth", picture))
                elif mouthing:
                    log.add("second-mouthing", f"`{picture}` is left out", e.sourceline)
                else:
                    mouthing = picture
            elif isinstance(e.tag, str) and (name := TIERS.get(e.tag)):
                tiers += _movement(e, name, str(tier.tag), log)
    return NonManual(mouthing, tuple(tiers))


def _is_gesture(picture: str) -> bool:
    return len(picture) == 3 and picture[0] in "DJLCT" and picture[1:].isdigit()


def _movement(e: etree._Element, name: str, tier: str, log: FaultLog) -> list[Tier]:
    if fault := _FAULTS.get((name, tier)):
        log.add(fault, f"`{e.tag}` stands in `{tier}`", e.sourceline)
    code = e.get("movement") or e.get("direction")
    if code is None:
        log.add("unknown-value", f"`{e.tag}` does not say what it does", e.sourceline)
        return []
    if name in CODES and code not in CODES[name]:
        meant = _MEANT.get((name, code))
        told = f"read as `{meant}`" if meant else "left out"
        log.add(f"unknown-{name}", f"`{e.tag}` has no `{code}`; {told}", e.sourceline)
        if meant is None:
            return []
        code = meant
    return [Tier(name, code, log.number(e, "amount"), log.number(e, "speed"))]
