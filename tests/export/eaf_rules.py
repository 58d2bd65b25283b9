"""What EAF 3.0 tasks of a file, checked rule by rule: what EAFv3.0.xsd says of what we write.

The schema says which elements stand in which order, which attributes they have and must have, and
what refers to what. What ELAN tasks beyond it: annotations of a tier do not overlap and have a
length, and those of a tier that is included in another lie inside one of its annotations.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from datetime import datetime
from itertools import pairwise
from xml.etree.ElementTree import Element

XSI = "{http://www.w3.org/2001/XMLSchema-instance}noNamespaceSchemaLocation"
CHILDREN = {
    "ANNOTATION_DOCUMENT": "LICENSE HEADER TIME_ORDER TIER LINGUISTIC_TYPE LOCALE LANGUAGE "
    "CONSTRAINT CONTROLLED_VOCABULARY LEXICON_REF REF_LINK_SET EXTERNAL_REF",
    "HEADER": "MEDIA_DESCRIPTOR LINKED_FILE_DESCRIPTOR PROPERTY",
    "TIME_ORDER": "TIME_SLOT",
    "TIER": "ANNOTATION",
    "ANNOTATION": "ALIGNABLE_ANNOTATION REF_ANNOTATION",
    "ALIGNABLE_ANNOTATION": "ANNOTATION_VALUE",
}
"""Elements inside each, in the order in which they must come."""
ATTRIBUTES: dict[str, tuple[str, str]] = {
    "ANNOTATION_DOCUMENT": ("AUTHOR DATE VERSION", f"FORMAT {XSI}"),
    "HEADER": ("", "MEDIA_FILE TIME_UNITS"),
    "MEDIA_DESCRIPTOR": ("MEDIA_URL MIME_TYPE", "RELATIVE_MEDIA_URL TIME_ORIGIN EXTRACTED_FROM"),
    "PROPERTY": ("", "NAME"),
    "TIME_ORDER": ("", ""),
    "TIME_SLOT": ("TIME_SLOT_ID", "TIME_VALUE"),
    "TIER": (
        "TIER_ID LINGUISTIC_TYPE_REF",
        "PARTICIPANT ANNOTATOR DEFAULT_LOCALE PARENT_REF EXT_REF LANG_REF",
    ),
    "ANNOTATION": ("", ""),
    "ALIGNABLE_ANNOTATION": (
        "ANNOTATION_ID TIME_SLOT_REF1 TIME_SLOT_REF2",
        "SVG_REF EXT_REF LANG_REF CVE_REF",
    ),
    "ANNOTATION_VALUE": ("", ""),
    "LINGUISTIC_TYPE": (
        "LINGUISTIC_TYPE_ID",
        "TIME_ALIGNABLE CONSTRAINTS GRAPHIC_REFERENCES CONTROLLED_VOCABULARY_REF LEXICON_REF",
    ),
    "CONSTRAINT": ("STEREOTYPE", "DESCRIPTION"),
}
"""Attributes that each must have, and may have."""
STEREOTYPES = {"Time_Subdivision", "Symbolic_Subdivision", "Symbolic_Association", "Included_In"}
NAME = re.compile(r"[^\W\d][\w.\-]*")


def check(root: Element) -> None:
    """Assert that a document keeps all the rules."""
    assert root.tag == "ANNOTATION_DOCUMENT"
    for element in root.iter():
        _check_element(element)
    assert datetime.fromisoformat(root.get("DATE", "")).tzinfo is not None
    header, order = root.findall("HEADER"), root.findall("TIME_ORDER")
    assert len(header) == len(order) == 1
    assert header[0].get("TIME_UNITS") in {"milliseconds", "NTSC-frames", "PAL-frames"}
    slots = {slot.get("TIME_SLOT_ID"): int(slot.get("TIME_VALUE", "")) for slot in order[0]}
    assert list(slots.values()) == sorted(slots.values())
    assert all(0 <= ms < 2**32 for ms in slots.values())
    ids = [*_ids(root)]
    assert len(ids) == len(set(ids)), "identifiers are unique in the whole document"
    assert all(NAME.fullmatch(name) for name in ids)
    types = {t.get("LINGUISTIC_TYPE_ID"): t for t in root.iterfind("LINGUISTIC_TYPE")}
    assert len(types) == len(root.findall("LINGUISTIC_TYPE"))
    for kind in types.values():
        assert kind.get("TIME_ALIGNABLE") in {"true", "false"}
        assert kind.get("GRAPHIC_REFERENCES") in {"true", "false"}
        assert kind.get("CONSTRAINTS", "Included_In") in ids
    assert {c.get("STEREOTYPE") for c in root.iterfind("CONSTRAINT")} <= STEREOTYPES
    _check_tiers(root, types, slots)


def _check_element(element: Element) -> None:
    must, may = (set(names.split()) for names in ATTRIBUTES[element.tag])
    assert must <= set(element.attrib) <= must | may, element.tag
    allowed = CHILDREN.get(element.tag, "").split()
    places = [allowed.index(child.tag) for child in element]
    assert places == sorted(places), f"order in {element.tag}"
    if element.tag in ("ANNOTATION", "ALIGNABLE_ANNOTATION"):
        assert len(element) == 1
    if element.tag not in ("ANNOTATION_VALUE", "PROPERTY"):
        assert not (element.text or "").strip()


def _ids(root: Element) -> Iterator[str]:
    for element in root.iter():
        for attribute in ("TIME_SLOT_ID", "ANNOTATION_ID", "STEREOTYPE"):
            if (name := element.get(attribute)) is not None:
                yield name


def _check_tiers(
    root: Element, types: dict[str | None, Element], slots: dict[str | None, int]
) -> None:
    tiers = {tier.get("TIER_ID"): tier for tier in root.iterfind("TIER")}
    assert len(tiers) == len(root.findall("TIER"))
    spans = {name: _spans(tier, slots) for name, tier in tiers.items()}
    for name, tier in tiers.items():
        own = spans[name]
        assert all(start < end for start, end in own)
        assert all(a[1] <= b[0] for a, b in pairwise(own)), "in order, apart"
        kind = types[tier.get("LINGUISTIC_TYPE_REF")]
        parent = tier.get("PARENT_REF")
        assert (parent is None) == (kind.get("CONSTRAINTS") is None)
        if parent is not None:
            assert parent != name
            assert kind.get("CONSTRAINTS") == "Included_In"
            above = spans[parent]
            assert all(any(a <= start and end <= b for a, b in above) for start, end in own)


def _spans(tier: Element, slots: dict[str | None, int]) -> list[tuple[int, int]]:
    return [
        (slots[a.get("TIME_SLOT_REF1")], slots[a.get("TIME_SLOT_REF2")])
        for a in tier.iter("ALIGNABLE_ANNOTATION")
    ]
