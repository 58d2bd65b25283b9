"""Follows every link inside a built site: its file is there, and has the anchor.

Usage: links.py FOLDER
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LINKS = {"href", "src", "poster"}


@dataclass
class Page(HTMLParser):
    """What a page links, what it loads, and the anchors that it has."""

    links: list[str] = field(default_factory=list)
    loads: list[str] = field(default_factory=list)
    anchors: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        super().__init__()

    def handle_starttag(self, tag: str, attrs: Sequence[tuple[str, str | None]]) -> None:
        """Note the links and the anchor of an element."""
        for name, value in attrs:
            if value is None:
                continue
            if name in LINKS:
                (self.links if tag == "a" else self.loads).append(value)
            elif name == "id" or (name == "name" and tag == "a"):
                self.anchors.add(value)


def read(path: Path) -> Page:
    """Return the links and anchors of a page."""
    page = Page()
    page.feed(path.read_text(encoding="utf-8"))
    return page


def broken(folder: Path) -> Iterator[str]:
    """Yield a line for each link that leads nowhere, and for what is loaded from elsewhere."""
    folder = folder.resolve()
    pages = {path: read(path) for path in sorted(folder.rglob("*.html"))}
    for path, page in pages.items():
        shown = path.relative_to(folder).as_posix()
        for link in page.loads:
            if urlsplit(link).netloc:
                yield f"{shown}: loads {link}"
        for link in [*page.links, *page.loads]:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = path if not parts.path else (path.parent / unquote(parts.path)).resolve()
            target = target / "index.html" if target.is_dir() else target
            anchor = unquote(parts.fragment)
            if not target.is_relative_to(folder) or not target.is_file():
                yield f"{shown}: {link} is not there"
            elif anchor and target in pages and anchor not in pages[target].anchors:
                yield f"{shown}: {link} has no such anchor"


def main(arguments: Sequence[str]) -> int:
    """Print what is broken; 1 if anything is."""
    found = list(broken(Path(arguments[0])))
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
