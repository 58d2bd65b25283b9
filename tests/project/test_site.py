"""The site of the documentation: its pages, its docstrings, its links; twice the same bytes."""

from __future__ import annotations

import hashlib
import json
import math
import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath
from typing import Any

import pytest
from programs import Node
from served import web_server

ROOT = Path(__file__).parents[2]
SITE = ROOT / "docs" / "site"
SCRIPT = """
import sys
sys.path.insert(0, sys.argv[1])
import api, build
from pathlib import Path
api.PACKAGES = ("azee.clip",)
sys.exit(bool(build.build(Path(sys.argv[2]), [build.FIRST])))
"""


@pytest.fixture
def site(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """Import a module of the site, whatever module of a test has its name."""
    import importlib

    monkeypatch.syspath_prepend(str(SITE))
    names = {path.stem for path in SITE.glob("*.py")}
    others = {name: sys.modules.pop(name) for name in names & sys.modules.keys()}
    yield importlib.import_module
    for name in names & sys.modules.keys():
        del sys.modules[name]
    sys.modules.update(others)


@pytest.mark.parametrize(
    ("docstring", "lines"),
    [
        (["Return `x_` of *a*."], [r"Return \ ``x_``\  of \*a\*."]),
        (["One.", "Two."], ["One. Two."]),
        (["Args: q: (T, V).", "Returns: a_ b"], [r"**Args:** q\: (T, V).", r"**Returns:** a\_ b"]),
        (["Args:", "    q: one", "        more"], [r"**Args:** q\: one more"]),
        (["So:", "", "    x = *y*", "", "end"], [r"So\:", "::", " " * 8 + "x = *y*", "end"]),
    ],
)
def test_docstrings_are_plain_text(site: Any, docstring: Sequence[str], lines: list[str]) -> None:
    assert [line for line in site("docstrings").as_rst(docstring) if line] == lines


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[a](formats.md#x)", "[a](formats.md#x)"),
        ("[a](language/README.md)", "[a](language/index.md)"),
        ("[a](../CONTRIBUTING.md)", "[a](contributing.md)"),
        ("[a](../README.md)", "[a](index.md)"),
        ("[a](adr/)", "[a](adr/index.md)"),
        ("[a](../examples/tree/)", "[a](examples/tree/index.md)"),
        ("[a](gallery.py)", "[a](gallery.py)"),
        ("[a](../grammar/azee_grammar/rules)", "a"),
        ("[a](#here) and [b](https://example.org)", "[a](#here) and [b](https://example.org)"),
        ("```text\n[a](language/README.md)\n```", "```text\n[a](language/README.md)\n```"),
    ],
)
def test_links_lead_to_where_pages_are_on_the_site(
    site: Any, text: str, expected: str, tmp_path: Path
) -> None:
    pages = site("pages").Pages(tmp_path)
    assert pages.rewritten(text, PurePosixPath("docs"), PurePosixPath(".")) == expected


def test_every_page_is_in_the_contents(site: Any, tmp_path: Path) -> None:
    pages = site("pages").Pages(tmp_path)
    pages.write()
    listed = set()
    for path in tmp_path.rglob("*.md"):
        listed |= {
            line for line in path.read_text(encoding="utf-8").splitlines() if line[:1] == "/"
        }
    places = {f"/{place}" for name, place in pages.known.items() if name.parts[1:2] != ("adr",)}
    assert places - listed == {"/index"}


@pytest.mark.parametrize(
    ("link", "told"),
    [
        ('<a href="b.html#there">', []),
        ('<a href="b.html#gone">', ["a.html: b.html#gone has no such anchor"]),
        ('<a href="c.html">', ["a.html: c.html is not there"]),
        ('<a href="../c.html">', ["a.html: ../c.html is not there"]),
        ('<a href="https://example.org/">', []),
        ('<img src="https://example.org/a.png">', ["a.html: loads https://example.org/a.png"]),
        ('<azee-player src="clip.azwc">', ["a.html: clip.azwc is not there"]),
    ],
)
def test_links_that_lead_nowhere_are_told(
    site: Any, link: str, told: list[str], tmp_path: Path
) -> None:
    (tmp_path / "a.html").write_text(link, encoding="utf-8")
    (tmp_path / "b.html").write_text('<p id="there">', encoding="utf-8")
    assert list(site("links").broken(tmp_path)) == told


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Sequence[Path]:
    """The site, built twice: a part of the reference and one example. `make docs` builds all."""
    sites = []
    for seed in ("1", "2"):
        out = tmp_path_factory.mktemp("site") / "site"
        path = os.pathsep.join(p for p in sys.path if p)
        done = subprocess.run(
            [sys.executable, "-c", SCRIPT, str(SITE), str(out)],
            env=os.environ | {"PYTHONPATH": path, "PYTHONHASHSEED": seed},
            capture_output=True,
            encoding="utf-8",
            check=False,
        )
        assert done.returncode == 0, done.stdout + done.stderr
        sites.append(out)
    return sites


def _digests(folder: Path) -> dict[str, str]:
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in files
    }


@pytest.mark.slow
def test_the_site_is_built_without_a_warning_and_twice_the_same(built: Sequence[Path]) -> None:
    first, second = map(_digests, built)
    assert first == second
    assert {"index.html", "language/tutorial.html", "api/azee.clip.html"} <= set(first)


@pytest.mark.slow
def test_the_first_page_shows_a_moving_signer(browser: Node, built: Sequence[Path]) -> None:
    with web_server(built[0]) as url:
        seen = json.loads(browser("site_first_page.mjs", url))
    assert (seen["complaints"], seen["foreign"]) == ([], [])
    assert seen["hidden"]
    assert math.dist(seen["before"], seen["after"]) > 0.02
