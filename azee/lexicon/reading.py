"""Reads files of notated signs: SiGML, archives of it, and tables with HamNoSys."""

from __future__ import annotations

import csv
import io
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from azee.lexicon.hamnosys import is_hamnosys, read_symbols
from azee.lexicon.hns_sign import read_hns_sign
from azee.lexicon.model import Sign
from azee.lexicon.sigml import read_sign
from azee.lexicon.sigml_xml import parse_xml, signs
from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.files import LARGEST_BYTES, decode

XML_SUFFIXES = (".sigml", ".xml")
TABLE_SUFFIXES = (".csv", ".tsv", ".txt")
SUFFIXES = (*XML_SUFFIXES, *TABLE_SUFFIXES, ".zip")
"""Of the files that are read."""
_LARGEST_ARCHIVE = 200 * 2**20
"""Bytes of all files of an archive together, unpacked."""


@dataclass(frozen=True, slots=True)
class Found:
    """A sign of a file, or why there is none. stem: what its rule is named after."""

    stem: str
    origin: str
    sign: Sign | None = None
    problems: tuple[Diagnostic, ...] = ()


def read_all(path: Path) -> Iterator[Found]:
    """Yield the signs of a file, an archive, or all files in a folder and below, by name."""
    if path.is_dir():
        for inner in sorted(path.rglob("*")):
            if inner.suffix.lower() in SUFFIXES and inner.is_file():
                yield from read_all(inner)
        return
    try:
        if path.suffix.lower() == ".zip":
            yield from _archive(path)
            return
        if path.stat().st_size > LARGEST_BYTES:
            raise AZeeError(_too_large(str(path)))
        data = path.read_bytes()
    except AZeeError as problem:
        yield Found(path.stem, path.name, problems=problem.diagnostics)
    except OSError as problem:
        reason = (problem.strerror or "it cannot be read").lower()
        message = f"cannot read `{path}`: {reason}"
        yield Found(path.stem, path.name, problems=(Diagnostic("cannot-read", message, None),))
    else:
        yield from read_bytes(data, path.name)


def read_bytes(data: bytes, name: str) -> Iterator[Found]:
    """Yield the signs of a file's content. Whatever is wrong with it is told, never raised."""
    try:
        if PurePosixPath(name).suffix.lower() in TABLE_SUFFIXES:
            yield from _table(data, name)
        else:
            yield from _document(data, name)
    except AZeeError as problem:
        yield Found(PurePosixPath(name).stem, name, problems=problem.diagnostics)


def _archive(path: Path) -> Iterator[Found]:
    try:
        with zipfile.ZipFile(path) as archive:
            entries = sorted(archive.infolist(), key=lambda entry: entry.filename)
            wanted = [
                entry
                for entry in entries
                if PurePosixPath(entry.filename).suffix.lower() in XML_SUFFIXES
            ]
            size = sum(entry.file_size for entry in wanted)
            if size > _LARGEST_ARCHIVE or any(e.file_size > LARGEST_BYTES for e in wanted):
                raise AZeeError(_too_large(str(path)))
            for entry in wanted:
                yield from read_bytes(archive.read(entry), PurePosixPath(entry.filename).name)
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, EOFError) as problem:
        message = f"cannot read `{path}`: {problem}"
        yield Found(path.stem, path.name, problems=(Diagnostic("cannot-read", message, None),))


def _document(data: bytes, name: str) -> Iterator[Found]:
    elements = list(signs(parse_xml(data, name)))
    if not elements:
        message = f"`{name}` has no sign: neither `hamgestural_sign` nor `hns_sign`"
        raise AZeeError(Diagnostic("bad-sigml", message, None))
    for i, element in enumerate(elements):
        stem = PurePosixPath(name).stem
        if len(elements) > 1:
            stem = element.get("gloss") or f"{stem}-{i + 1}"
        try:
            sign = read_hns_sign(element) if element.tag == "hns_sign" else read_sign(element)
        except AZeeError as problem:
            yield Found(stem, name, problems=problem.diagnostics)
        else:
            yield Found(stem, name, sign)


def _table(data: bytes, name: str) -> Iterator[Found]:
    """Yield the signs of a table: a gloss, and somewhere behind it symbols of HamNoSys."""
    text = decode(data, name).text
    delimiter = "\t" if "\t" in text else ","
    found = 0
    try:
        for row in csv.reader(io.StringIO(text), delimiter=delimiter):
            symbols = next((cell for cell in row[1:] if is_hamnosys(cell)), None)
            if symbols is None:
                continue
            found += 1
            gloss = row[0].strip()
            try:
                yield Found(gloss, name, read_symbols(symbols, gloss))
            except AZeeError as problem:
                yield Found(gloss, name, problems=problem.diagnostics)
    except csv.Error as problem:
        message = f"`{name}` is no table: {problem}"
        raise AZeeError(Diagnostic("bad-hamnosys", message, None)) from None
    if not found:
        message = f"`{name}` has no line with a gloss and HamNoSys behind it"
        hint = "symbols of HamNoSys are in the private area of Unicode, from U+E000"
        raise AZeeError(Diagnostic("bad-hamnosys", message, None, help=hint))


def _too_large(name: str) -> Diagnostic:
    return Diagnostic("size-limit", f"`{name}` is larger than {LARGEST_BYTES // 2**20} MB", None)
