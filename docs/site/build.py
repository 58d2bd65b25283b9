"""Builds the site: the documents, the reference of the API, and the examples as players.

Without a network and without a warning; twice the same bytes. Afterwards every link inside the site
is followed. It is a folder for any web server; opened from the disk, pages can be read, but a
browser does not run the players.
"""

from __future__ import annotations

import argparse
import html
import os
import shutil
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path, PurePosixPath

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

import api  # noqa: E402 - beside this file
import gallery  # noqa: E402
import links  # noqa: E402
from pages import LINK, ROOT, Pages  # noqa: E402

FIRST = ROOT / "examples" / "not-but" / "not-but.azee"
"""The example that the first page plays."""
SCRIPT = '<script type="module" src="_static/azee-player.js"></script>\n'
PLAYER = """<azee-player class="first" src="_static/clip/{name}.azwc" autoplay loop restrictview>
<img src="_static/{picture}" alt="{text}">
</azee-player>

"""
GALLERY = """# Gallery

Drag to turn a signer; the wheel comes nearer. Each movement is made from the text below it.
[The player](player.md) tells how other pages show a clip.

<div class="gallery">
{figures}
</div>

"""


def build(out: Path, sources: Sequence[Path] = gallery.EXAMPLES) -> list[str]:
    """Write the site into a folder, which it replaces; return the links that lead nowhere.

    Args: sources: the examples that are played; the first page needs `FIRST`.
    Raises: SystemExit: Sphinx has a warning or an error, which it prints.
    """
    out = out.resolve()
    out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f".{out.name}.", dir=out.parent) as temporary:
        work = Path(temporary)
        write_documents(work / "source", sources)
        write_static(work / "static", sources)
        run_sphinx(work)
        (work / "site" / ".buildinfo").unlink(missing_ok=True)  # what Sphinx keeps to build again
        broken = list(links.broken(work / "site"))
        if not broken:
            shutil.rmtree(out, ignore_errors=True)
            (work / "site").rename(out)
    return broken


def write_documents(folder: Path, sources: Sequence[Path]) -> None:
    """Write the tree that Sphinx reads."""
    pages = Pages(folder)
    pages.write()
    for place, text in api.pages():
        pages.put(place, text)
    figures = "\n".join(
        gallery.figure(source, f"_static/clip/{source.stem}.azwc") for source in sources
    )
    figures = figures.replace("\n\n", "\n&#10;")  # an empty line would end the HTML in Markdown
    pages.put(PurePosixPath("gallery"), GALLERY.format(figures=figures) + SCRIPT)
    index = folder / "index.md"
    text = index.read_text(encoding="utf-8")
    (picture, *_) = (m for m in LINK.finditer(text) if m["bang"])
    player = PLAYER.format(
        name=FIRST.stem, picture=Path(picture["to"]).name, text=html.escape(picture["text"])
    )
    text = f"{text[: picture.start()]}{player}{SCRIPT}{text[picture.end() :].lstrip()}"
    index.write_text(text, encoding="utf-8")


def write_static(folder: Path, sources: Sequence[Path]) -> None:
    """Write the style, the picture of the first page, and what players need."""
    folder.mkdir()
    for path in (HERE / "site.css", ROOT / "docs" / "pictures" / "readme.webp"):
        shutil.copyfile(path, folder / path.name)
    gallery.write_players(folder, sources)


def run_sphinx(work: Path) -> None:
    """Make the pages of HTML. Raises: SystemExit: there is a warning or an error."""
    from sphinx.cmd.build import build_main

    static = os.path.relpath(work / "static", HERE)
    code = build_main(
        [
            *("-q", "-W", "--keep-going", "-b", "html", "-c", str(HERE)),
            *("-d", str(work / "doctrees"), "-D", f"html_static_path={static}"),
            *(str(work / "source"), str(work / "site")),
        ]
    )
    if code:
        raise SystemExit(code)


def main() -> int:
    """Build the site."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "docs")
    parser.add_argument("--only", metavar="NAME", nargs="*", help="names of examples to play")
    options = parser.parse_args()
    only = {FIRST.stem, *(options.only or [])}
    chosen = [p for p in gallery.EXAMPLES if options.only is None or p.stem in only]
    if broken := build(options.out, chosen):
        print("\n".join(broken), file=sys.stderr)
        return 1
    print(f"wrote {options.out}: python -m http.server -b 127.0.0.1 -d {options.out}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
