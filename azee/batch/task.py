"""One text on one body: what a worker is given, and how it is told from all others."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from azee.batch.dependencies import Dependencies
from azee.batch.options import Options
from azee.batch.text import Text
from azee.batch.version import installed_version
from azee_rig.load import MOST_KEPT, load_rig, shipped_rigs
from azee_rig.rig import Rig


@dataclass(frozen=True, slots=True)
class Body:
    """A body: its name among the outputs, the name or folder to load it by, and its content."""

    name: str
    place: str
    digest: str


@dataclass(frozen=True, slots=True)
class Task:
    """A text on a body, with everything that decides what comes of it.

    key: a hash of text, libraries, options, body and version. libraries: folders for `use`.
    version: of the azee that made the task, and is to do it.
    """

    key: str
    text: Text
    body: Body
    options: Options
    libraries: tuple[Path, ...]
    version: str

    @property
    def title(self) -> str:
        """What it is called in messages."""
        return f"{self.text.name} on {self.body.name}"


def body_of(place: str) -> Body:
    """Return the body of a name or a folder.

    Raises: RigError: there is none, or it cannot be read.
    """
    rig = load_rig(place)
    kept = place if place in shipped_rigs() else str(rig.folder)
    return Body(rig.name, kept, _digest(rig))


@lru_cache(maxsize=MOST_KEPT)
def _digest(rig: Rig) -> str:
    """Return a digest of the files of a body; a process reads them once, as it does the body."""
    digest = hashlib.sha256()
    for path in sorted(rig.folder.iterdir()):
        if path.is_file():
            digest.update(f"{path.name}\n".encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()


def tasks_of(
    texts: Sequence[Text], bodies: Sequence[Body], options: Options, libraries: Sequence[Path]
) -> Iterator[Task]:
    """Yield the tasks of a batch, all of one body before those of the next.

    So a worker seldom changes its body.
    """
    version = installed_version()
    dependencies = Dependencies(libraries)
    found = tuple(folder.resolve() for folder in libraries)
    used = [dependencies.digest(text) for text in texts]
    for body in bodies:
        for text, digest in zip(texts, used, strict=True):
            decides = {
                "text": text.source.text,
                "name": text.name,
                "given": text.given,
                "utterance": text.utterance,
                "libraries": digest,
                "body": [body.name, body.digest],
                "options": options.as_json(),
                "version": version,
            }
            data = json.dumps(decides, sort_keys=True, ensure_ascii=True).encode()
            key = hashlib.sha256(data).hexdigest()[:32]
            yield Task(key, text, body, options, found, version)
