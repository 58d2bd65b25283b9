"""Whose testimony a score rests on: how far the forms of the rules in its text are known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

UNSTATED = "without a status"
"""What counts as the status of a rule that states none."""


@dataclass(frozen=True, slots=True)
class LibraryStamp:
    """A library that a text uses rules of, as its manifest describes it.

    All but the name is none where it has no manifest. digest: of the forms of all its rules.
    changed: rules that the text uses and that are no longer as the manifest says.
    """

    name: str
    version: str | None = None
    licence: str | None = None
    citation: str | None = None
    digest: str | None = None
    changed: tuple[str, ...] = ()

    def as_json(self) -> dict[str, object]:
        """Return it as plain data."""
        return {
            "name": self.name,
            "version": self.version,
            "licence": self.licence,
            "citation": self.citation,
            "digest": self.digest,
            "changed": [*self.changed],
        }

    @property
    def text(self) -> str:
        """Name, version and digest, such as `lsf 0.1.0 3f2a…`."""
        return " ".join(part for part in (self.name, self.version, self.digest) if part)


@dataclass(frozen=True, slots=True)
class Provenance:
    """How often a text applies rules of each status, and the libraries that they are in.

    statuses: counts, most trusted status first.
    """

    statuses: Mapping[str, int]
    libraries: tuple[LibraryStamp, ...] = ()

    @property
    def applications(self) -> int:
        """How many rules the text applies or hands over."""
        return sum(self.statuses.values())

    @property
    def text(self) -> str:
        """One line, such as `3 applications: 2 published, 1 placeholder`."""
        many = self.applications
        counts = ", ".join(f"{count} {status}" for status, count in self.statuses.items())
        noun = "application" if many == 1 else "applications"
        return f"{many} {noun}{': ' if counts else ''}{counts}"

    def as_json(self) -> dict[str, object]:
        """Return it as the report and files have it."""
        return {
            "applications": self.applications,
            "statuses": dict(self.statuses),
            "libraries": [library.as_json() for library in self.libraries],
        }
