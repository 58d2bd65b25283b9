"""Builds a page that plays every example: one body, a clip an example, the element <azee-player>.

It is a folder for any web server; opened from the disk, a browser does not load its scripts.
"""

from __future__ import annotations

import argparse
import html
import shutil
import sys
from collections.abc import Sequence
from pathlib import Path

import azee
from azee.export.files import replace_file
from azee.export.formats.glb import write_body
from azee.export.formats.web_clip import write_web_clip
from azee.web.bundle import parts
from azee_rig.load import load_rig

ROOT = Path(__file__).parents[1]
EXAMPLES = sorted(ROOT.glob("examples/*/*.azee"))
PAGE = """<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>azee: examples</title>
<link rel="icon" href="data:,">
<style>
body {{ font: 16px/1.45 system-ui, sans-serif; }}
body {{ margin: 1.5rem auto; max-width: 76rem; padding: 0 1rem; }}
main {{ display: grid; gap: 1.5rem; grid-template-columns: repeat(auto-fill, minmax(17rem, 1fr)); }}
figure {{ margin: 0; }}
pre {{ overflow: auto; max-height: 9rem; background: #f3f5f7; padding: .6rem; font-size: .85rem; }}
</style>
<h1>Examples</h1>
<p>Drag to turn the signer; the wheel comes nearer. Each movement is made from the text below.</p>
<main>
{figures}
</main>
<script type="module" src="azee-player.js"></script>
"""
FIGURE = """<figure>
<azee-player src="{clip}" speed="1" restrictview></azee-player>
<figcaption><h2>{name}</h2><pre tabindex="0">{text}</pre></figcaption>
</figure>"""


def build(folder: Path, sources: Sequence[Path] = EXAMPLES) -> None:
    """Write the page into a folder, which is made."""
    folder.mkdir(parents=True, exist_ok=True)
    write_players(folder, sources)
    figures = "\n".join(figure(source, f"clip/{source.stem}.azwc") for source in sources)
    with replace_file(folder / "index.html") as file:
        file.write(PAGE.format(figures=figures).encode())


def write_players(folder: Path, sources: Sequence[Path]) -> None:
    """Write the script of the element, a body, and a clip for each example."""
    body = load_rig("signer")
    for name in ("body", "clip"):
        (folder / name).mkdir(exist_ok=True)
    for path in parts("azee-player.js"):
        shutil.copyfile(path, folder / path.name)
    write_body(body, folder / "body" / f"{body.name}.glb")
    for source in sources:
        write_web_clip(azee.compile(source, body).clip, body, folder / f"clip/{source.stem}.azwc")


def figure(source: Path, clip: str) -> str:
    """Return the player of an example over its text. clip: address of its clip."""
    text = html.escape(source.read_text(encoding="utf-8").strip())
    return FIGURE.format(name=html.escape(source.stem), clip=clip, text=text)


def main() -> int:
    """Build what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "gallery")
    parser.add_argument("--only", metavar="NAME", nargs="*", help="names of examples")
    options = parser.parse_args()
    build(options.out, [p for p in EXAMPLES if not options.only or p.stem in options.only])
    print(f"wrote {options.out}: python -m http.server -b 127.0.0.1 -d {options.out}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
