"""`azee rules --diff`: how two states of a library differ, rule by rule."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import click

from azee.cli.console import show_json

if TYPE_CHECKING:
    from azee.lang.manifest import Change, Manifest

WORDS = {
    "added": "added",
    "removed": "removed",
    "form": "with another form",
    "status": "with another status",
    "header": "with another description",
}
"""Kinds of changes in words, the weightiest first."""


def show_difference(first: str, second: str, *, form: str) -> None:
    """Print what differs between two libraries, as text or JSON.

    Raises: AZeeError: a library cannot be found or read.
    """
    from azee.lang.manifest import changes
    from azee.lang.stocktaking import library_now

    before, after = library_now(first), library_now(second)
    found = changes(before, after)
    if form == "json":
        show_json(
            {
                "before": _named(before),
                "after": _named(after),
                "changes": [_as_json(change) for change in found],
            }
        )
    else:
        click.echo("\n".join(_lines(before, after, found)))


def _named(manifest: Manifest) -> dict[str, str]:
    return {"name": manifest.name, "version": manifest.version, "digest": manifest.digest}


def _as_json(change: Change) -> dict[str, object]:
    return {
        "name": change.name,
        "kind": change.kind,
        "before": change.before.as_json() if change.before else None,
        "after": change.after.as_json() if change.after else None,
    }


def _lines(before: Manifest, after: Manifest, found: Sequence[Change]) -> Iterator[str]:
    counts = Counter(change.kind for change in found)
    told = ", ".join(f"{counts[kind]} {word}" for kind, word in WORDS.items() if counts[kind])
    yield f"{_title(before)} → {_title(after)}: {told or 'no rule differs'}"
    width = max((len(change.name) for change in found), default=0)
    for change in found:
        yield f"  {change.name:<{width}}  {_told(change)}"


def _title(manifest: Manifest) -> str:
    return " ".join(part for part in (manifest.name, manifest.version) if part)


def _told(change: Change) -> str:
    text = WORDS[change.kind]
    before, after = change.before, change.after
    if after is not None and before is None:
        return f"{text}, {after.status or 'without a status'}"
    if before is not None and after is not None and before.status != after.status:
        return f"{text}: {before.status or 'none'} → {after.status or 'none'}"
    return text
