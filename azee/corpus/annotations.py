"""Annotations of ELAN files, ours or a linguist's, as pympi reads them (extra `elan`)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path


class NoElanLibraryError(Exception):
    """pympi, which reads ELAN files, is not installed."""


class NotElanError(Exception):
    """A file is not one of ELAN, or not whole."""


@dataclass(frozen=True, slots=True)
class Annotation:
    """A text and its interval, in seconds of the file's time line."""

    text: str
    start_s: float
    end_s: float


def read_tiers(path: str | Path) -> Mapping[str, Sequence[Annotation]]:
    """Return the annotations of every tier of an ELAN file, in order of time.

    Annotations whose time is not known, and those without a length, are left out.

    Raises: NoElanLibraryError: pympi is missing. NotElanError: the file is damaged or something
        else. OSError: it cannot be opened.
    """
    try:
        from pympi import Eaf
    except ImportError as error:
        raise NoElanLibraryError("reading an ELAN file needs pympi") from error
    with Path(path).open("rb"):
        pass  # pympi has no error of its own for a file that cannot be opened
    try:
        file = Eaf(str(path), suppress_version_warning=True)
        rows = {name: file.get_annotation_data_for_tier(name) for name in file.get_tier_names()}
    except Exception as error:  # of any class: pympi does not check what it reads
        raise NotElanError(f"`{path}` is no ELAN file, or a damaged one") from error
    return {
        name: sorted(
            (
                Annotation(row[2] or "", row[0] / 1000, row[1] / 1000)
                for row in found
                if row[0] is not None and row[1] is not None and row[0] < row[1]
            ),
            key=lambda a: (a.start_s, a.end_s, a.text),
        )
        for name, found in rows.items()
    }
