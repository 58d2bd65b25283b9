"""A score as an ELAN file, so that linguists see it beside their videos.

EAF 3.0 is the format of ELAN (Max Planck Institute for Psycholinguistics). Blocks of the score form
a tree of tiers: one for the whole, and under each tier one for the blocks inside its blocks. If
these overlap there are several tiers, because a tier has only one annotation at a time. A tier is
included in time in the one above it. The tracks of a solved score are tiers of their own, by part
of the body.

ELAN counts whole milliseconds and has no annotation without a length. Times are rounded, and a
block of no length gets one millisecond, inside the block around it.

The format requires a date. It is that of the environment's SOURCE_DATE_EPOCH, as in reproducible
builds, or 1970, so that the same score gives the same bytes.
"""

from __future__ import annotations

import mimetypes
import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from fractions import Fraction
from pathlib import Path
from urllib.parse import quote
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from azee.export.files import replace_file
from azee.export.score_layout import title
from azee.export.track_rows import Row
from azee.score.provenance import Provenance
from azee.score.score import Group, Score

SCHEMA = "http://www.mpi.nl/tools/elan/EAFv3.0.xsd"
SCHEMA_LOCATION = "{http://www.w3.org/2001/XMLSchema-instance}noNamespaceSchemaLocation"
STEREOTYPES = {
    "Time_Subdivision": "Annotations share out the time of the one above them, without gaps",
    "Symbolic_Subdivision": "Annotations share out the one above them, in order, without times",
    "Symbolic_Association": "One annotation for the one above it",
    "Included_In": "Annotations lie within the time of the one above them; gaps are allowed",
}
"""The four relations between tiers that ELAN has; every file of ELAN declares them."""
WHOLE, INNER, TRACK = "score", "blocks", "track"
"""Linguistic types: the whole, what is inside something, and tracks."""
_NO_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


@dataclass(frozen=True, slots=True)
class Note:
    """An annotation: its text and its interval, in milliseconds."""

    text: str
    start_ms: int
    end_ms: int


@dataclass(slots=True)
class Tier:
    """Annotations that do not overlap; they lie inside those of the tier above, if there is one."""

    name: str
    kind: str
    parent: Tier | None = None
    notes: list[Note] = field(default_factory=list)
    inner: list[Tier] = field(default_factory=list)

    def all(self) -> Iterator[Tier]:
        """Yield it and all tiers below it, parents first."""
        yield self
        for tier in self.inner:
            yield from tier.all()


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
    tiers = [*score_tiers(score, lead_s).all(), *track_tiers(rows, lead_s)]
    described = None if media is None else _media(Path(media), Path(path))
    document = _document(tiers, described, provenance)
    ElementTree.indent(document, "    ")
    with replace_file(path) as file:
        file.write(b'<?xml version="1.0" encoding="UTF-8"?>\n')
        file.write(ElementTree.tostring(document, encoding="utf-8") + b"\n")


def score_tiers(score: Score, lead_s: float = 0.0) -> Tier:
    """Return the tree of tiers of a score; its root has the whole score."""
    root = Tier(WHOLE, WHOLE)
    start = Fraction(lead_s)
    whole = _note(title("", score), start, start + score.duration)
    root.notes.append(whole)
    _fill(root, score, start, whole)
    return root


def _fill(tier: Tier, score: Score, start: Fraction, around: Note) -> None:
    """Put the blocks of a group into the tiers below that of the group."""
    if not isinstance(score, Group):
        return
    blocks = sorted(score.blocks, key=lambda b: (b.interval_in_parent.start, b.name))
    for block in blocks:
        interval = block.interval_in_parent.shifted(start)
        note = _inside(_note(title(block.name, block.score), interval.start, interval.end), around)
        below = next((t for t in tier.inner if _free(t, note)), None)
        if below is None:
            above = "" if tier.parent is None else f"{tier.name}."
            below = Tier(f"{above or f'{INNER} '}{len(tier.inner) + 1}", INNER, tier)
            tier.inner.append(below)
        below.notes.append(note)
        _fill(below, block.score, interval.start, note)


def track_tiers(rows: Sequence[Row], lead_s: float = 0.0) -> list[Tier]:
    """Return a tier for every lane of every row of tracks."""
    tiers: list[Tier] = []
    for row in rows:
        lanes: list[Tier] = []
        for bar in (bar for lane in row.lanes for bar in lane):
            text = " › ".join(bar.path) or bar.name
            note = _note(text, Fraction(bar.start_s + lead_s), Fraction(bar.end_s + lead_s))
            lane = next((t for t in lanes if _free(t, note)), None)
            if lane is None:
                number = f" {len(lanes) + 1}" if lanes else ""
                lane = Tier(f"{TRACK} {row.name}{number}", TRACK)
                lanes.append(lane)
            lane.notes.append(note)
        tiers += lanes
    return tiers


def _note(text: str, start: Fraction, end: Fraction) -> Note:
    first = max(0, round(start * 1000))
    return Note(_NO_XML.sub("", text), first, max(first + 1, round(end * 1000)))


def _inside(note: Note, around: Note) -> Note:
    """Keep a block of no length inside the block at whose end it is."""
    end = min(note.end_ms, around.end_ms)
    start = min(max(note.start_ms, around.start_ms), end - 1)
    return Note(note.text, start, end)


def _free(tier: Tier, note: Note) -> bool:
    return all(note.end_ms <= n.start_ms or n.end_ms <= note.start_ms for n in tier.notes)


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
        SubElement(header, "PROPERTY", {"NAME": name}).text = _NO_XML.sub("", value)
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
    for kind in (WHOLE, INNER, TRACK):
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
