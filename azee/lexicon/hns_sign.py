"""Reads signs of HamNoSys in XML: each symbol is an element, `<hamflathand/>`."""

from __future__ import annotations

from dataclasses import replace

from lxml import etree

from azee.lexicon.faults import FaultLog
from azee.lexicon.hamnosys import read_symbols
from azee.lexicon.hamnosys_symbols import SYMBOLS
from azee.lexicon.model import NonManual, Sign, Tier
from azee.lexicon.sigml_xml import children

_TIERS = {
    "hnm_mouthpicture": "mouthing",
    "hnm_mouthgesture": "mouth",
    "hnm_head": "head",
    "hnm_body": "body",
    "hnm_shoulder": "shoulders",
    "hnm_eyebrows": "brows",
    "hnm_eyelids": "lids",
    "hnm_eyegaze": "gaze",
    "hnm_nose": "nose",
    "hnm_extra": "extra",
}


def read_hns_sign(element: etree._Element) -> Sign:
    """Read one `hns_sign`.

    Raises: AZeeError: bad-hamnosys.
    """
    log = FaultLog()
    gloss = element.get("gloss") or ""
    symbols = ""
    for manual in element.findall("hamnosys_manual"):
        for child in children(manual):
            name = str(child.tag).removeprefix("ham")
            if name in SYMBOLS:
                symbols += SYMBOLS[name]
            else:
                log.add("unknown-element", f"`{child.tag}` is no symbol", child.sourceline)
    sign = read_symbols(symbols, gloss or "sign")
    nonmanual = _nonmanual(element, log)
    return replace(sign, gloss=gloss, nonmanual=nonmanual, faults=(*sign.faults, *log.faults))


def _nonmanual(element: etree._Element, log: FaultLog) -> NonManual:
    mouthing = ""
    tiers = []
    for group in element.findall("hamnosys_nonmanual"):
        for child in children(group):
            kind = _TIERS.get(str(child.tag))
            code = child.get("picture") or child.get("tag") or ""
            if kind == "mouthing" and not mouthing:
                mouthing = code
            elif kind is None or not code:
                log.add("not-read", f"`{child.tag}` is not read", child.sourceline)
            elif kind != "mouthing":
                tiers.append(Tier(kind, code))
    return NonManual(mouthing, tuple(tiers))
