"""Glosses as AZee: each a sign of a lexicon, or spelled where the lexicon has none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from azee.lexicon.importing import plain_name
from azee.lexicon.record import Record

GAP_S = 0.2
"""The pause between signs."""


@dataclass(frozen=True, slots=True)
class GlossedText:
    """An AZee text of glosses, and those that the lexicon does not have."""

    text: str
    unknown: tuple[str, ...]


def rule_of(gloss: str, record: Record) -> str | None:
    """Return the rule of a gloss: by the name of a rule, else the first with that gloss.

    Capitals, and marks between words, do not matter.
    """
    plain = plain_name(gloss)
    for name in (gloss, f"{record.language}-{plain}", plain):
        if name in record.entries:
            return name
    same = (name for name, entry in record.entries.items() if plain_name(entry.gloss) == plain)
    return min(same, default=None)


def glossed(glosses: Sequence[str], record: Record, library: str) -> GlossedText:
    """Return a text that signs glosses one after the other.

    What the lexicon does not have is a comment: its letters can only be spelled with rules of a
    manual alphabet.
    """
    signs: list[str] = []
    unknown: list[str] = []
    for gloss in glosses:
        rule = rule_of(gloss, record)
        if rule is None:
            unknown.append(gloss)
            signs.append(f"        # {' '.join(gloss.split())}: not in the lexicon, to be spelled")
        else:
            signs.append(f"        :{rule}")
    lines = [f"use '{library}", ""]
    known = len(glosses) - len(unknown)
    if known:
        lines += ["seq", "    list", *signs, f"    'gap {GAP_S:.1f}".replace("0.", ".")]
    else:
        lines += [sign.strip() for sign in signs]
    return GlossedText("\n".join(lines) + "\n", tuple(unknown))
