"""Lexicons that other distributions ship as notation: their rules are written on first use."""

from __future__ import annotations

import hashlib
import shutil
import sys
import tempfile
from functools import cache
from pathlib import Path

from azee_grammar.cache import cache_folder

_FOLDER = "lexicons"


@cache
def rules_of(archive: Path, language: str, source: str) -> Path:
    """Return a folder with the rules of an archive of notated signs.

    It is in the user's cache folder, under the digest of the archive and of the converter. It is
    written whole or not at all, also where several processes need it at once. Where nothing can
    be kept, it is a temporary folder.
    """
    name = f"{_digest(archive, source)}"
    home = cache_folder()
    if home is not None:
        kept = home / _FOLDER / name / language
        if kept.is_dir():
            return kept
    from azee.lexicon.importing import import_signs

    print(f"Writing the rules of the lexicon {language}, once …", file=sys.stderr)
    part = _temporary(home)
    import_signs([archive], part / language, language, source)
    if home is None or part.parent != home / _FOLDER:
        return part / language
    try:
        part.rename(kept.parent)
    except OSError:  # another process was faster
        if not kept.is_dir():
            return part / language
        shutil.rmtree(part, ignore_errors=True)
    return kept


def _temporary(home: Path | None) -> Path:
    """Return a new folder in the cache, else among temporary files."""
    if home is not None:
        try:
            (home / _FOLDER).mkdir(parents=True, exist_ok=True)
            return Path(tempfile.mkdtemp(prefix=".", dir=home / _FOLDER))
        except OSError:
            pass
    return Path(tempfile.mkdtemp(prefix="azee-lexicon-"))


def _digest(archive: Path, source: str) -> str:
    digest = hashlib.sha256(archive.read_bytes() + source.encode())
    for path in sorted(Path(__file__).parent.glob("*")):
        if path.suffix in (".py", ".lark"):
            digest.update(path.read_bytes())
    return digest.hexdigest()[:32]
