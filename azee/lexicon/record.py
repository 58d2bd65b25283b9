"""The record of a folder of imported rules: where each is from, and what is searched for."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from azee.export.files import replace_path
from azee_grammar.diagnostic import AZeeError, Diagnostic

FILE = "lexicon.json"
_VERSION = 1


@dataclass(frozen=True, slots=True)
class Entry:
    """An imported rule.

    digest: of its text as imported. notes: kinds of what was approximated. faults: kinds of faults
    of its notation. features: what it is made of, by kind (features.py).
    """

    gloss: str
    origin: str
    digest: str
    notes: tuple[str, ...] = ()
    faults: tuple[str, ...] = ()
    features: Mapping[str, tuple[str, ...]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Record:
    """All imported rules of a folder, by name."""

    language: str = ""
    source: str = ""
    entries: Mapping[str, Entry] = field(default_factory=dict)

    @classmethod
    def read(cls, folder: Path) -> Record:
        """Read the record of a folder; one without is empty.

        Raises: AZeeError: bad-record.
        """
        path = folder / FILE
        if not path.exists():
            return cls()
        try:
            document = json.loads(path.read_text(encoding="utf-8"))
            entries = {str(name): _entry(found) for name, found in document["rules"].items()}
            return cls(str(document["language"]), str(document["source"]), entries)
        except (OSError, ValueError, KeyError, TypeError, AttributeError):
            message = f"`{path.name}` is no record of an imported lexicon"
            hint = "delete it: importing writes it again"
            raise AZeeError(Diagnostic("bad-record", message, None, help=hint)) from None

    def write(self, folder: Path) -> None:
        """Write the record, unless it is there already.

        Raises: OSError.
        """
        document = {
            "version": _VERSION,
            "language": self.language,
            "source": self.source,
            "rules": {name: _as_json(self.entries[name]) for name in sorted(self.entries)},
        }
        data = (json.dumps(document, ensure_ascii=False, indent=0) + "\n").encode()
        path = folder / FILE
        if not path.exists() or path.read_bytes() != data:
            write_file(path, data)


def _entry(found: Any) -> Entry:
    return Entry(
        str(found["gloss"]),
        str(found["file"]),
        str(found["digest"]),
        tuple(map(str, found.get("approximations", ()))),
        tuple(map(str, found.get("faults", ()))),
        {str(k): tuple(map(str, v)) for k, v in found.get("features", {}).items()},
    )


def _as_json(entry: Entry) -> dict[str, object]:
    document: dict[str, object] = {
        "gloss": entry.gloss,
        "file": entry.origin,
        "digest": entry.digest,
        "features": dict(entry.features),
    }
    if entry.notes:
        document["approximations"] = entry.notes
    if entry.faults:
        document["faults"] = entry.faults
    return document


def write_file(path: Path, data: bytes) -> None:
    """Write a file whole or not at all.

    Raises: OSError.
    """
    with replace_path(path) as part:
        part.write_bytes(data)
