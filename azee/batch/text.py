"""The texts of a batch: the utterances of files, and the lines of lists."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from azee.lang.library_folder import own_name
from azee.lang.places import utterances
from azee_grammar.diagnostic import AZeeError, Diagnostic, Severity
from azee_grammar.files import TEXT_SUFFIXES, is_file, is_folder, read_source
from azee_grammar.parser import parse
from azee_grammar.source import Source

LIST_SUFFIX = ".jsonl"
SUFFIXES = (*TEXT_SUFFIXES, LIST_SUFFIX)
"""What is read of a folder."""
_LONGEST = 80
_UNFIT = re.compile(r"[^\w.-]+")


@dataclass(frozen=True, slots=True)
class Text:
    """One thing to sign.

    name: of its folder among the outputs; no two texts of a batch have the same. source: the file
    and its content. folder: where `use` looks first, if there is one. utterance: its number in the
    file, from 1; none if it is the whole. given: what else a list says of it. fault: why it cannot
    be read at all.
    """

    name: str
    source: Source
    folder: Path | None = None
    utterance: int | None = None
    given: Mapping[str, Any] = field(default_factory=dict)
    fault: Diagnostic | None = None


def texts_of(sources: Sequence[Path]) -> list[Text]:
    """Return the texts of files and folders, in order, each with a name of its own.

    A file of AZee has a text for each utterance, a list (.jsonl) one for each line. Of a folder all
    files of these kinds are read, sorted, those of folders inside too. A file or a line that cannot
    be read is a text with a fault.

    Raises: AZeeError: cannot-read: there is no such file, or a folder has no text.
    """
    found = [text for source in sources for path in _files(source) for text in _texts(path)]
    return told_apart(found)


def _files(source: Path) -> Iterator[Path]:
    if not is_folder(source):
        if not is_file(source):
            read_source(source)  # says why it cannot be read
        yield source
        return
    inside = sorted(p for p in source.rglob("*") if p.suffix.lower() in SUFFIXES and is_file(p))
    if not inside:
        message = f"the folder `{source}` has no text: no {' or '.join(SUFFIXES)}"
        raise AZeeError(Diagnostic("cannot-read", message, None))
    yield from inside


def _texts(path: Path) -> Iterator[Text]:
    try:
        source = read_source(path)
    except AZeeError as error:
        yield Text(path.stem, Source(str(path), ""), fault=error.diagnostics[0])
        return
    if path.suffix.lower() == LIST_SUFFIX:
        yield from _of_list(source, path)
        return
    parsed = parse(source)
    folder = path.resolve().parent
    count = 0 if own_name(parsed.file) else sum(1 for _ in utterances(parsed.file))
    if count < 2 or any(d.severity is Severity.ERROR for d in parsed.diagnostics):
        yield Text(path.stem, source, folder)
        return
    digits = len(str(count))
    for number in range(1, count + 1):
        yield Text(f"{path.stem}-{number:0{digits}}", source, folder, number)


def _of_list(source: Source, path: Path) -> Iterator[Text]:
    lines = source.text.splitlines()
    digits = len(str(len(lines)))
    for number, line in enumerate(lines, 1):
        if not line.strip():
            continue
        name = f"{path.stem}-{number:0{digits}}"
        place = f"{path}:{number}"
        text, given = _line(line)
        if text is None:
            message = f"line {number} of `{path}` is no JSON object with a `text`"
            help_ = 'such as {"name": "hello", "text": ":bonjour"}'
            fault = Diagnostic("cannot-read", message, None, help=help_)
            yield Text(name, Source(place, line), fault=fault)
            continue
        own = given.pop("name", None)
        name = own if isinstance(own, str) and own.strip() else name
        yield Text(name, Source(place, text), path.resolve().parent, None, given)


def _line(line: str) -> tuple[str | None, dict[str, Any]]:
    """Return the text of a line and all else that it says; no text if it is none."""
    try:
        found = json.loads(line)
    except (ValueError, RecursionError):
        return None, {}
    if not isinstance(found, dict) or not isinstance(text := found.pop("text", None), str):
        return None, {}
    return text, found


def told_apart(texts: Iterable[Text]) -> list[Text]:
    """Make names fit for folders, and give those that come again a number."""
    taken: set[str] = set()
    out = []
    for text in texts:
        plain = _UNFIT.sub("_", text.name)[:_LONGEST].strip("._") or "text"
        name, again = plain, 1
        while name.casefold() in taken:
            again += 1
            name = f"{plain}.{again}"
        taken.add(name.casefold())
        out.append(replace(text, name=name))
    return out
