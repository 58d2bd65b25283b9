"""Keeps the trees of texts that are read again and again, such as those of libraries.

A tree is kept under the digest of its text and of the parser's own sources, so neither a changed
text nor a changed parser meets an old tree. What is read back is made of our own classes only:
a file that names any other is as good as none.
"""

from __future__ import annotations

import hashlib
import io
import pickle
from functools import cache
from pathlib import Path
from typing import Any

from azee_grammar.cache import keep, kept
from azee_grammar.parser import Parsed, parse
from azee_grammar.source import Source

_FOLDER = "trees"
_OURS = ("azee_grammar.syntax", "azee_grammar.source", "azee_grammar.parser")
_PLAIN = ("getattr",)
"""What pickle itself needs for members of an enumeration."""


def parse_kept(source: Source) -> Parsed:
    """Parse a text, or return the tree that was kept of it. Texts with mistakes are not kept."""
    file = f"{_FOLDER}/{_key(source)}"
    data = kept(file)
    if data is not None and (found := _restored(data, source)) is not None:
        return found
    parsed = parse(source)
    if not parsed.diagnostics:
        stream = io.BytesIO()
        _Pickler(stream, pickle.HIGHEST_PROTOCOL).dump(parsed)
        keep(file, stream.getvalue())
    return parsed


def _key(source: Source) -> str:
    digest = hashlib.sha256(_parser_digest() + source.text.encode("utf-8", "surrogatepass"))
    name = digest.hexdigest()[:32]
    return f"{name[:2]}/{name[2:]}"


@cache
def _parser_digest() -> bytes:
    """Return a digest of the modules that make trees."""
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parent.glob("*")):
        if path.suffix in (".py", ".lark"):
            digest.update(path.read_bytes())
    return digest.digest()


class _Pickler(pickle.Pickler):
    def persistent_id(self, obj: Any) -> str | None:
        return "source" if isinstance(obj, Source) else None


class _Unpickler(pickle.Unpickler):
    def __init__(self, data: bytes, source: Source) -> None:
        super().__init__(io.BytesIO(data))
        self._source = source

    def persistent_load(self, pid: Any) -> Source:
        return self._source

    def find_class(self, module: str, name: str) -> Any:
        if module in _OURS or (module == "builtins" and name in _PLAIN):
            return super().find_class(module, name)
        raise pickle.UnpicklingError(f"{module}.{name} is no part of a tree")


def _restored(data: bytes, source: Source) -> Parsed | None:
    try:
        found = _Unpickler(data, source).load()
    except Exception:  # damaged data raises whatever it likes
        return None
    return found if isinstance(found, Parsed) else None
