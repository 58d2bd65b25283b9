"""A score as an ELAN file, so that linguists see it beside their videos.

EAF 3.0 is the format of ELAN (Max Planck Institute for Psycholinguistics). A score is shown from
several sides: the signs by name, what each part of the signer does, where each rule is applied, and
the blocks by nesting, whose tiers are included in time in the one above them. The tracks of a
solved score are tiers of their own, by part of the body.

The format requires a date. It is that of the environment's SOURCE_DATE_EPOCH, as in reproducible
builds, or 1970, so that the same score gives the same bytes.
"""

from __future__ import annotations

import mimetypes
import os
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from pathlib import Path
from urllib.parse import quote
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from azee.export.files import replace_file
from azee.export.formats.eaf_content import (
    ARTICULATOR,
    GLOSS,
    MOUTHING,
    RECORDED,
    RULE,
    SOUNDS,
    content_tiers,
)
from azee.export.formats.eaf_tiers import (
    INNER,
    TRACK,
    WHOLE,
    Note,
    Tier,
    score_tiers,
    track_tiers,
    xml_text,
)
from azee.export.track_rows import Row
from azee.score.provenance import Provenance
from azee.score.score import Score

SCHEMA = "http://www.mpi.nl/tools/elan/EAFv3.0.xsd"
SCHEMA_LOCATION = "{http://www.w3.org/2001/XMLSchema-instance}noNamespaceSchemaLocation"
STEREOTYPES = {
    "Time_Subdivision": "Annotations share out the time of the one above them, without gaps",
    "Symbolic_Subdivision": "Annotations share out the one above them, in order, without times",
    "Symbolic_Association": "One annotation for the one above it",
    "Included_In": "Annotations lie within the time of the one above them; gaps are allowed",
}
"""The four relations between tiers that ELAN has; every file of ELAN declares them."""


def write_eaf(
    score: Score,
    path: str | Path,
    rows: Sequence[Row] = (),
    *,
    lead_s: float = 0.0,
    media: str | Path | None = None,
    provenance: Provenance | None = None,
) -> None:
    """Write a score, and rows of tracks, as an ELAN file.

    Args: lead_s: start of the score in the film that belongs to it. media: that film, or a video of
        a signer, as a path from the current folder. provenance: of the text; a property of the
        file says how far its rules are known, and one names each library.
    Raises: OSError: the file cannot be written.
    """
    whole, *blocks = score_tiers(score, lead_s).all()
    tiers = [whole, *content_tiers(score, lead_s), *blocks, *track_tiers(rows, lead_s)]
    described = None if media is None else _media(Path(media), Path(path))
    document = _document(tiers, described, provenance)
    ElementTree.indent(document, "    ")
    with replace_file(path) as file:
        file.write(b'<?xml version="1.0" encoding="UTF-8"?>\n')
        file.write(ElementTree.tostring(document, encoding="utf-8") + b"\n")


def _document(
    tiers: Sequence[Tier], media: dict[str, str] | None, provenance: Provenance | None
) -> Element:
    root = Element(
        "ANNOTATION_DOCUMENT",
        {
            "AUTHOR": "azee",
            "DATE": _date(),
            "FORMAT": "3.0",
            "VERSION": "3.0",
            SCHEMA_LOCATION: SCHEMA,
        },
    )
    header = SubElement(root, "HEADER", {"MEDIA_FILE": "", "TIME_UNITS": "milliseconds"})
    if media is not None:
        SubElement(header, "MEDIA_DESCRIPTOR", media)
    for name, value in _properties(provenance):
        SubElement(header, "PROPERTY", {"NAME": name}).text = xml_text(value)
    last = SubElement(header, "PROPERTY", {"NAME": "lastUsedAnnotationId"})
    last.text = str(sum(len(tier.notes) for tier in tiers))
    notes = [(tier, note) for tier in tiers for note in sorted(tier.notes, key=_start)]
    slots = _slots([note for _, note in notes])
    order = SubElement(root, "TIME_ORDER")
    for slot, ms in slots:
        SubElement(order, "TIME_SLOT", {"TIME_SLOT_ID": slot, "TIME_VALUE": str(ms)})
    elements = {id(tier): SubElement(root, "TIER", _attributes(tier)) for tier in tiers}
    for number, (tier, note) in enumerate(notes, 1):
        element = SubElement(elements[id(tier)], "ANNOTATION")
        known = {f"TIME_SLOT_REF{i}": f"ts{2 * number - 2 + i}" for i in (1, 2)}
        annotation = SubElement(
            element, "ALIGNABLE_ANNOTATION", {"ANNOTATION_ID": f"a{number}", **known}
        )
        SubElement(annotation, "ANNOTATION_VALUE").text = note.text
    for kind in (WHOLE, GLOSS, RECORDED, MOUTHING, SOUNDS, ARTICULATOR, RULE, INNER, TRACK):
        constraint = {"CONSTRAINTS": "Included_In"} if kind == INNER else {}
        known = {
            "GRAPHIC_REFERENCES": "false",
            "LINGUISTIC_TYPE_ID": kind,
            "TIME_ALIGNABLE": "true",
        }
        SubElement(root, "LINGUISTIC_TYPE", constraint | known)
    for stereotype, meaning in STEREOTYPES.items():
        SubElement(root, "CONSTRAINT", {"DESCRIPTION": meaning, "STEREOTYPE": stereotype})
    return root


def _properties(provenance: Provenance | None) -> Iterator[tuple[str, str]]:
    """Yield what a file says of the rules it comes from, by the names of properties."""
    if provenance is not None:
        yield "azee:provenance", provenance.text
        for library in provenance.libraries:
            yield f"azee:library:{library.name}", library.text


def _slots(notes: Sequence[Note]) -> list[tuple[str, int]]:
    """Return names and times of the slots in order of time: two of its own for each annotation.

    ELAN moves annotations that share a slot together. At one instant first come the ends, inner
    ones first, and then the starts, outer ones first.
    """
    found = []
    for number, note in enumerate(notes):
        found.append((note.start_ms, 1, number, f"ts{2 * number + 1}"))
        found.append((note.end_ms, 0, -number, f"ts{2 * number + 2}"))
    return [(slot, ms) for ms, _, _, slot in sorted(found)]


def _attributes(tier: Tier) -> dict[str, str]:
    above = {} if tier.parent is None else {"PARENT_REF": tier.parent.name}
    return {"LINGUISTIC_TYPE_REF": tier.kind, "TIER_ID": tier.name, **above}


def _start(note: Note) -> int:
    return note.start_ms


def _media(media: Path, beside: Path) -> dict[str, str]:
    """Describe the place of a video: for this machine, and relative to the ELAN file."""
    kind = mimetypes.guess_type(media.name)[0] or "video/mp4"
    whole = media.resolve()
    try:
        relative = Path(os.path.relpath(whole, beside.resolve().parent)).as_posix()
    except ValueError:  # on another drive
        return {"MEDIA_URL": whole.as_uri(), "MIME_TYPE": kind}
    near = relative if relative.startswith("../") else f"./{relative}"
    return {"MEDIA_URL": whole.as_uri(), "MIME_TYPE": kind, "RELATIVE_MEDIA_URL": quote(near)}


def _date() -> str:
    """Date of the file, as XML Schema writes it."""
    try:
        seconds = int(os.environ.get("SOURCE_DATE_EPOCH", "0"))
        return datetime.fromtimestamp(seconds, UTC).isoformat()
    except (ValueError, OverflowError, OSError):
        return datetime.fromtimestamp(0, UTC).isoformat()
