"""What came of a task, kept beside its files; and the manifest of all."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from azee.batch.task import Task
from azee.export.files import replace_file

MANIFEST = "manifest.jsonl"
RECORD = ".task.json"
"""What a body's name is followed by in the name of a record."""
Record = dict[str, Any]
"""As docs/batch.md describes it: `key`, then `error` or `rows`."""


def record_path(out: Path, task: Task) -> Path:
    """Return where the record of a task is."""
    return out / task.text.name / f"{task.body.name}{RECORD}"


def kept_record(out: Path, task: Task) -> Record | None:
    """Return the record of a task if it is done and all its files are there, else None."""
    record = _read(record_path(out, task))
    if record is None or record.get("key") != task.key:
        return None
    return record if all((out / name).is_file() for name in files_of(record)) else None


def keep_record(out: Path, task: Task, record: Record) -> None:
    """Write the record of a task; files of the record that it replaces go, if it has not them.

    Raises: OSError.
    """
    path = record_path(out, task)
    before = _read(path)
    with replace_file(path) as file:
        file.write(f"{json.dumps(record, indent=1, ensure_ascii=False)}\n".encode())
    for name in set(files_of(before or {})) - set(files_of(record)):
        (out / name).unlink(missing_ok=True)


def files_of(record: Mapping[str, Any]) -> list[str]:
    """Return the files of a record, relative to the folder of outputs."""
    return sorted({name for row in record.get("rows", ()) for name in row["files"].values()})


def passing(task: Task, errors: list[dict[str, Any]]) -> Record:
    """Return the record of a task that failed for another reason than its text.

    It is in the manifest, and not kept: the next run tries again.
    """
    return {"key": task.key, "error": errors, "passing": True}


def failure(message: str, notes: Sequence[str] = ()) -> dict[str, Any]:
    """Return, in the form of a diagnostic, why a task was not done."""
    return {"code": "failed", "severity": "error", "message": message, "notes": [*notes]}


def rows_of(task: Task, record: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield the lines of the manifest for a task: one a clip and camera, or one for an error."""
    text = task.text
    head = {
        "name": text.name,
        "body": task.body.name,
        "source": text.source.name,
        "utterance": text.utterance,
        "text": text.source.text,
        "given": dict(text.given),
        "key": task.key,
    }
    rows = record.get("rows", ())
    for row in rows:
        yield {**head, **record["outcome"], **row, "error": None}
    if not rows:
        yield {**head, "files": {}, "error": record.get("error", [])}


def write_manifest(out: Path, found: Iterable[tuple[Task, Mapping[str, Any]]]) -> None:
    """Write the manifest: a JSON object a line, in the order of texts and bodies.

    Raises: OSError.
    """
    with replace_file(out / MANIFEST) as file:
        for task, record in found:
            for row in rows_of(task, record):
                file.write(f"{json.dumps(row, ensure_ascii=False)}\n".encode())


def _read(path: Path) -> Record | None:
    try:
        found = json.loads(path.read_bytes())
    except (OSError, ValueError):
        return None
    sound = isinstance(found, dict) and isinstance(found.get("rows", []), list)
    return found if sound else None
