"""The pages of the site: which files of the project become which documents, and their links.

The documents of this project link each other and its sources by relative paths, so that they can be
read in any checkout. For the site they are copied into one tree, and each link is changed to where
its target is then: another page, a picture, or a file to download.
"""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

ROOT = Path(__file__).parents[2]
ROOTS = ("CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md")
LINK = re.compile(
    r"(?P<bang>!?)\[(?P<text>[^\]]*)\]\((?!\w+:|#)(?P<to>[^)#\s]+)(?P<anchor>#[^)]*)?\)"
)
FENCED = re.compile(r"^(?P<fence>`{3,}).*?^(?P=fence)$", re.M | re.S)
TREE = "\n\n```{{toctree}}\n:hidden:\n\n{entries}\n```\n"
TOP = (
    "/contents", "/gallery", "/examples/index", "/api/index", "/adr/index", "/contributing",
    "/changelog", "/security",
)  # fmt: skip
"""What the first page has below it."""
DECISIONS = """# Decisions

What was measured, and why we chose as we did.

```{toctree}
:glob:

[0-9]*
```
"""


def sources() -> dict[PurePosixPath, PurePosixPath]:
    """Return the documents of the project, each with its path on the site, without a suffix.

    They are those of the folders `docs` and `examples`, and others that these link.
    """
    found = [ROOT / name for name in ROOTS]
    found += sorted([*ROOT.glob("docs/**/*.md"), *ROOT.glob("examples/**/*.md")])
    known: dict[PurePosixPath, PurePosixPath] = {PurePosixPath("README.md"): PurePosixPath("index")}
    while found:
        path = found.pop(0)
        name = PurePosixPath(path.relative_to(ROOT).as_posix())
        if name in known:
            continue
        known[name] = _place(name)
        for m in LINK.finditer(path.read_text(encoding="utf-8")):
            target = ROOT / os.path.normpath(name.parent / m["to"])
            target = target / "README.md" if target.is_dir() else target
            if target.suffix == ".md" and target.is_file():
                found.append(target)
    return known


def _place(name: PurePosixPath) -> PurePosixPath:
    """Return where a document goes: docs/ is the root, the README of a folder its index."""
    if name == PurePosixPath("docs/README.md"):
        return PurePosixPath("contents")
    if len(name.parts) == 1:
        return PurePosixPath(name.stem.lower())
    plain = name.relative_to("docs") if name.parts[0] == "docs" else name
    return plain.with_name("index") if plain.name == "README.md" else plain.with_suffix("")


class Pages:
    """The tree of documents that Sphinx reads. folder: where it is made."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.known = sources()
        self.copied: set[PurePosixPath] = set()

    def write(self) -> None:
        """Write all documents, with the pictures and files that they link."""
        trees = {name: self._below(name, place) for name, place in self.known.items()}
        listed = {entry for tree in trees.values() for entry in tree}
        rest = (place for name, place in self.known.items() if name.parts[:2] != ("docs", "adr"))
        trees[PurePosixPath("CONTRIBUTING.md")] = [
            f"/{place}" for place in rest if f"/{place}" not in listed and str(place) != "index"
        ]
        for name, place in self.known.items():
            text = (ROOT / name).read_text(encoding="utf-8")
            text = self.rewritten(text, name.parent, place.parent)
            entries = "\n".join(trees[name])
            self.put(place, text + (TREE.format(entries=entries) if entries else ""))
        self.put(PurePosixPath("adr/index"), DECISIONS)

    def put(self, place: PurePosixPath, text: str) -> None:
        """Write one document."""
        path = self.folder / f"{place}.md"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def rewritten(self, text: str, folder: PurePosixPath, place: PurePosixPath) -> str:
        """Return a text whose links lead to where their targets are on the site.

        Args: folder: of the text in the project. place: its folder on the site.
        """

        def link(m: re.Match[str]) -> str:
            target = PurePosixPath(os.path.normpath(folder / m["to"]))
            found = self._target(target)
            if found is None:
                return m["text"]
            return f"{m['bang']}[{m['text']}]({os.path.relpath(found, place)}{m['anchor'] or ''})"

        return "".join(part if fenced else LINK.sub(link, part) for fenced, part in _parts(text))

    def _target(self, target: PurePosixPath) -> PurePosixPath | None:
        """Return the path of a link's target on the site; None for a folder without a page."""
        if target == PurePosixPath("docs/adr"):
            return PurePosixPath("adr/index.md")
        path = ROOT / target
        name = target / "README.md" if path.is_dir() else target
        if name in self.known:
            return self.known[name].with_suffix(".md")
        if path.is_dir():
            return None
        place = target.relative_to("docs") if target.parts[0] == "docs" else target
        if place not in self.copied:
            self.copied.add(place)
            (self.folder / place).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, self.folder / place)
        return place

    def _below(self, name: PurePosixPath, place: PurePosixPath) -> list[str]:
        """Return the pages below a page in the tree of contents, in the order of its links.

        The index of a folder has those in its folder below it; the contents have any page.
        """
        if place == PurePosixPath("index"):
            return list(TOP)
        entries = []
        if name.name == "README.md":
            for m in LINK.finditer((ROOT / name).read_text(encoding="utf-8")):
                target = PurePosixPath(os.path.normpath(name.parent / m["to"]))
                target = target / "README.md" if (ROOT / target).is_dir() else target
                if target != name and target in self.known and target.is_relative_to(name.parent):
                    entries.append(f"/{self.known[target]}")
        return list(dict.fromkeys(entries))


def _parts(text: str) -> Iterator[tuple[bool, str]]:
    """Yield the parts of a text, and whether each is a fenced block."""
    end = 0
    for m in FENCED.finditer(text):
        yield False, text[end : m.start()]
        yield True, m[0]
        end = m.end()
    yield False, text[end:]
