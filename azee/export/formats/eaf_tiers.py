"""The tiers of an ELAN file: what is annotated when, by nesting and by track.

Blocks of a score form a tree of tiers: one for the whole, and under each tier one for the blocks
inside its blocks. If these overlap there are several tiers, because a tier has only one annotation
at a time. ELAN counts whole milliseconds and has no annotation without a length: times are rounded,
and a block of no length gets one millisecond, inside the block around it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from azee.export.score_layout import title
from azee.export.track_rows import Row
from azee.score.score import Group, Score

WHOLE, INNER, TRACK = "score", "blocks", "track"
"""Linguistic types: the whole, what is inside something, and tracks."""
_NO_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def xml_text(text: str) -> str:
    """Return a text without the characters that XML cannot have."""
    return _NO_XML.sub("", text)


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


def score_tiers(score: Score, lead_s: float = 0.0) -> Tier:
    """Return the tree of tiers of a score; its root has the whole score."""
    root = Tier(WHOLE, WHOLE)
    start = Fraction(lead_s)
    whole = note_of(title("", score), start, start + score.duration)
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
        note = _inside(
            note_of(title(block.name, block.score), interval.start, interval.end), around
        )
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
        notes: list[Note] = []
        for bar in (bar for lane in row.lanes for bar in lane):
            text = " › ".join(bar.path) or bar.name
            times = Fraction(bar.start_s + lead_s), Fraction(bar.end_s + lead_s)
            notes.append(note_of(text, *times))
        tiers += in_lanes(f"{TRACK} {row.name}", TRACK, notes)
    return tiers


def in_lanes(name: str, kind: str, notes: Iterable[Note]) -> list[Tier]:
    """Return tiers for annotations that may overlap: `name`, and `name 2` … where they do."""
    lanes: list[Tier] = []
    for note in notes:
        lane = next((tier for tier in lanes if _free(tier, note)), None)
        if lane is None:
            lane = Tier(f"{name} {len(lanes) + 1}" if lanes else name, kind)
            lanes.append(lane)
        lane.notes.append(note)
    return lanes


def note_of(text: str, start: Fraction, end: Fraction) -> Note:
    """Return an annotation from its times in seconds."""
    first = max(0, round(start * 1000))
    return Note(xml_text(text), first, max(first + 1, round(end * 1000)))


def _inside(note: Note, around: Note) -> Note:
    """Keep a block of no length inside the block at whose end it is."""
    end = min(note.end_ms, around.end_ms)
    start = min(max(note.start_ms, around.start_ms), end - 1)
    return Note(note.text, start, end)


def _free(tier: Tier, note: Note) -> bool:
    return all(note.end_ms <= n.start_ms or n.end_ms <= note.start_ms for n in tier.notes)
