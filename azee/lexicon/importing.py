"""Imports notated signs into a folder of rules; importing again changes nothing.

The folder has a record, `lexicon.json`: which file each rule came from, the digest of its text as
imported, and what can be searched for. A rule whose text differs from its digest was edited by
hand and stays, unless overwriting is asked for.
"""

from __future__ import annotations

import hashlib
import unicodedata
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path

from azee.lexicon.features import features_of
from azee.lexicon.model import Sign
from azee.lexicon.moving import TooLongError
from azee.lexicon.reading import Found, read_all
from azee.lexicon.record import Entry, Record, write_file
from azee.lexicon.rule_text import RuleText, rule_text
from azee_grammar.diagnostic import AZeeError, Diagnostic, Severity
from azee_grammar.format import format_file
from azee_grammar.source import Source

_DIGITS = 16


@dataclass
class Summary:
    """What an import did. Names of rules, by what became of them, and by kinds of losses."""

    written: list[str] = field(default_factory=list)
    unchanged: list[str] = field(default_factory=list)
    kept: list[str] = field(default_factory=list)
    failed: list[Found] = field(default_factory=list)
    approximations: dict[str, list[str]] = field(default_factory=dict)
    faults: dict[str, list[str]] = field(default_factory=dict)
    details: dict[str, str] = field(default_factory=dict)
    """An example of each kind of approximation or fault, in words."""

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """What kept files from being read, then which rules were edited by hand."""
        found = [problem for failed in self.failed for problem in failed.problems]
        for name in self.kept:
            message = f"`{name}` was edited by hand and stays as it is"
            found.append(
                Diagnostic(
                    "edited-by-hand",
                    message,
                    None,
                    help="`--force` writes it again",
                    severity=Severity.WARNING,
                )
            )
        return found

    def as_json(self) -> dict[str, object]:
        """Return it as docs/formats.md describes it."""

        def kinds(found: dict[str, list[str]]) -> list[dict[str, object]]:
            most = sorted(found.items(), key=lambda item: (-len(item[1]), item[0]))
            return [
                {"kind": kind, "example": self.details[kind], "rules": names}
                for kind, names in most
            ]

        return {
            "written": self.written,
            "unchanged": self.unchanged,
            "kept": self.kept,
            "failed": [found.origin for found in self.failed],
            "approximations": kinds(self.approximations),
            "faults": kinds(self.faults),
        }


def import_signs(
    paths: Iterable[Path],
    folder: Path,
    language: str,
    source: str,
    *,
    force: bool = False,
    tell: Callable[[str], None] = lambda _: None,
) -> Summary:
    """Write the rules of all signs in files, archives and folders.

    Args: language: what names of rules begin with. source: what rules say of where they are from.
        force: rules that were edited by hand are overwritten. tell: hears each name.

    Raises: OSError: the folder cannot be written. AZeeError: its record cannot be read.
    """
    folder.mkdir(parents=True, exist_ok=True)
    record = Record.read(folder)
    summary = Summary()
    names = _Names(language)
    entries: dict[str, Entry] = {}
    for path in paths:
        for found in read_all(path):
            if found.sign is None:
                summary.failed.append(found)
                continue
            name = names.of(found.stem)
            tell(name)
            try:
                entries[name] = _write(
                    found, found.sign, name, folder, record, source, summary, force=force
                )
            except TooLongError:
                message = f"`{found.stem}` in `{found.origin}` moves more often than any sign"
                problem = Diagnostic("size-limit", message, None)
                summary.failed.append(Found(found.stem, found.origin, problems=(problem,)))
    Record(language, source, {**record.entries, **entries}).write(folder)
    return summary


def _write(
    found: Found,
    sign: Sign,
    name: str,
    folder: Path,
    record: Record,
    source: str,
    summary: Summary,
    *,
    force: bool,
) -> Entry:
    """Write one rule, if it is new or differs and nobody edited it. Returns its entry."""
    rule = rule_text(sign, name, f"{source}; read from {found.origin}")
    text = _canonical(rule.text, name)
    path = folder / f"{name.removeprefix(':')}.azee"
    before = path.read_bytes() if path.exists() else None
    recorded = record.entries.get(name)
    data = text.encode()
    if before == data:
        summary.unchanged.append(name)
    elif before is None or force or (recorded and recorded.digest == digest(before)):
        write_file(path, data)
        summary.written.append(name)
    else:
        summary.kept.append(name)
        if recorded is not None:
            data = b""  # the digest stays that of the imported text
    _count(summary, sign, rule, name)
    kept = recorded.digest if recorded is not None and not data else digest(data)
    return Entry(
        sign.gloss or found.stem,
        found.origin,
        kept,
        tuple(sorted(rule.notes)),
        tuple(sorted({fault.kind for fault in sign.faults})),
        features_of(sign),
    )


def _canonical(text: str, name: str) -> str:
    try:
        return format_file(Source(name, text))
    except AZeeError as problem:  # only a fault of ours writes what is no AZee
        raise AssertionError(f"the rule {name} cannot be read back: {problem}") from problem


def _count(summary: Summary, sign: Sign, rule: RuleText, name: str) -> None:
    for kind, detail in rule.notes.items():
        summary.approximations.setdefault(kind, []).append(name)
        summary.details.setdefault(kind, detail)
    for fault in sign.faults:
        names = summary.faults.setdefault(fault.kind, [])
        if name not in names[-1:]:
            names.append(name)
        summary.details.setdefault(fault.kind, fault.detail)


def digest(data: bytes) -> str:
    """Return the first digits of the SHA-256 of a text."""
    return hashlib.sha256(data).hexdigest()[:_DIGITS]


class _Names:
    """Names of rules: those of files in lower case, with the language before them."""

    def __init__(self, language: str) -> None:
        self._language = language
        self._taken: dict[str, int] = {}

    def of(self, stem: str) -> str:
        """Return a name that no other sign has."""
        name = f"{self._language}-{plain_name(stem)}"
        count = self._taken.get(name, 0) + 1
        self._taken[name] = count
        return name if count == 1 else self.of(f"{stem}-{count}")


def plain_name(text: str) -> str:
    """Return a gloss as names of rules are written: lower case, words joined by hyphens."""
    letters = unicodedata.normalize("NFC", text).casefold()
    words = "".join(c if c.isalnum() else " " for c in letters).split()
    return "-".join(words) or "sign"
