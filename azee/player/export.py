"""The player page as a folder for any web server: no azee is needed to show it.

The folder holds the page, a body, its idle loop and a clip a sign. The page joins the clips of what
is typed, the decay of each blended with the attack of the next.
"""

from __future__ import annotations

import json
import shutil
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from azee.clip.clip import Clip
from azee.export.files import replace_file
from azee.export.formats.glb import write_body
from azee.export.formats.web_clip import web_clip
from azee.player.idle import idle_loop
from azee.player.performing import Kind
from azee.web.bundle import parts
from azee_rig.rig import Rig

CATALOGUE = "catalogue.json"
PAGE = "player.html"
ELEMENT = "azee-player.js"
"""The script of the element, which pages of others may use too."""


class NotAnExportError(ValueError):
    """The folder holds something else, which would be lost."""


@dataclass(frozen=True, eq=False)
class Entry:
    """A sign of a vocabulary. attack_s, decay_s: parts of the clip outside of what it means."""

    name: str
    clip: Clip
    attack_s: float = 0.0
    decay_s: float = 0.0


@dataclass(frozen=True, eq=False)
class Vocabulary:
    """Signs that can be typed: one a word, or one a character.

    locale: whose capitals the names have. entries: are made one by one while they are written.
    """

    id: str
    kind: Kind
    title: str
    locale: str
    count: int
    entries: Callable[[], Iterator[Entry]]


def export_page(
    folder: Path,
    rig: Rig,
    vocabularies: Sequence[Vocabulary],
    *,
    text: str = "",
    progress: Callable[[int, int], None] | None = None,
) -> int:
    """Write the page into a folder, which it replaces as a whole; return the number of signs.

    Args: progress: is told of the signs written, and all.
    Raises: OSError: it cannot be written. NotAnExportError: the folder holds something else.
    """
    with _replaced(folder) as part:
        for path in parts(PAGE, ELEMENT):
            shutil.copyfile(path, part / ("index.html" if path.name == PAGE else path.name))
        for name in ("body", "idle", "sign"):
            (part / name).mkdir()
        write_body(rig, part / "body" / f"{rig.name}.glb")
        _write(part / "idle" / f"{rig.name}.azwc", web_clip(idle_loop(rig), rig))
        total, done = sum(v.count for v in vocabularies), 0
        listed = []
        for number, vocabulary in enumerate(vocabularies):
            signs: dict[str, str] = {}
            for entry in vocabulary.entries():
                address = f"sign/{number}-{len(signs)}.azwc"
                extras = {"attack_s": entry.attack_s, "decay_s": entry.decay_s}
                _write(part / address, web_clip(entry.clip, rig, extras))
                signs[entry.name] = address
                done += 1
                if progress:
                    progress(done, total)
            listed.append(_listed(vocabulary, signs))
        catalogue = {
            "live": False, "bodies": [rig.name], "body": rig.name, "sources": listed,
            "source": listed[0]["id"] if listed else "", "text": text,
        }  # fmt: skip
        _write(part / CATALOGUE, json.dumps(catalogue, ensure_ascii=False, indent=1).encode())
    return done


def _listed(vocabulary: Vocabulary, signs: Mapping[str, str]) -> dict[str, Any]:
    return {
        "id": vocabulary.id, "kind": vocabulary.kind, "title": vocabulary.title,
        "locale": vocabulary.locale, "signs": dict(signs),
    }  # fmt: skip


def _write(path: Path, data: bytes) -> None:
    with replace_file(path) as file:
        file.write(data)


@contextmanager
def _replaced(folder: Path) -> Iterator[Path]:
    """Give an empty folder that takes the place of `folder` if there was no error."""
    target = folder.resolve()
    if target.exists():
        if not target.is_dir():
            raise NotADirectoryError(20, "it is a file", str(folder))
        if any(target.iterdir()) and not (target / CATALOGUE).is_file():
            raise NotAnExportError(f"`{folder}` holds something else than an exported player")
    part = Path(tempfile.mkdtemp(prefix=f".{target.name[:40]}.", dir=target.parent))
    try:
        yield part
        part.chmod(0o755)
        old = part.with_name(f"{part.name}.old")
        if target.exists():
            target.rename(old)
        part.rename(target)
        shutil.rmtree(old, ignore_errors=True)
    except BaseException:
        shutil.rmtree(part, ignore_errors=True)
        raise
