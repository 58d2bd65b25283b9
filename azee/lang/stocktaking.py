"""Takes stock of a library as it is now: that of its files, or what a manifest says."""

from __future__ import annotations

from pathlib import Path

from azee.lang.library import shipped_library
from azee.lang.library_folder import texts
from azee.lang.manifest import FIELDS, Manifest, read_beside
from azee.lang.program import load
from azee.lang.scope import Namespace
from azee_grammar.diagnostic import AZeeError, Diagnostic, Severity
from azee_grammar.files import is_file, is_folder
from azee_grammar.library import shipped, shipped_names
from azee_grammar.nearest import nearest
from azee_grammar.source import Source

NOTHING_SAID = dict.fromkeys(FIELDS, "")


def library_now(name: str) -> Manifest:
    """Return the state of a library: a folder of rules, a manifest's file, or one that ships.

    What people say of a folder is taken from its manifest, if it has one.

    Raises: AZeeError: cannot-read, bad-manifest, library-not-found, or the mistakes in its rules.
    """
    path = Path(name)
    if is_file(path):
        return Manifest.read(path)
    folder = path if is_folder(path) else shipped() / name
    if not is_folder(path) and name not in shipped_names():
        raise _missing(name)
    recorded = read_beside(folder)
    said = NOTHING_SAID if recorded is None else recorded.said
    return Manifest.of(namespace_of(folder), said)


def namespace_of(folder: Path) -> Namespace:
    """Return the rules of a library in a folder; it is read as a `use` would read it.

    Raises: AZeeError: its mistakes; library-not-found: no text is in it.
    """
    place = folder.resolve()
    if place.parent == shipped().resolve():
        return shipped_library(place.name).namespace
    if not texts(place):
        raise _defines_nothing(folder)
    program = load(Source("<none>", f"use '{place.name}\n"), [place.parent])
    mistakes = [found for found in program.check() if found.severity is Severity.ERROR]
    if mistakes:
        raise AZeeError(*mistakes)
    for library in program.librarian.libraries:
        if library.namespace.name == place.name and library.namespace.rules:
            return library.namespace
    raise _defines_nothing(folder)


def _defines_nothing(folder: Path) -> AZeeError:
    message = f"`{folder}` is no library: no file in it defines a rule"
    return AZeeError(Diagnostic("library-not-found", message, None))


def _missing(name: str) -> AZeeError:
    found = [f"`{known}`" for known in nearest(name, shipped_names())]
    known = ", ".join(f"`{known}`" for known in shipped_names())
    hint = f"did you mean {' or '.join(found)}?" if found else f"name a folder, or one of {known}"
    message = f"there is no library `{name}`: no folder, no manifest, and none that ships"
    return AZeeError(Diagnostic("library-not-found", message, None, help=hint))
