"""The pages that are committed are those that their sources make, byte for byte."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import pytest
from programs import Node

from azee.web.bundle import DIST, LICENCES, bundle, parts

ROOT = Path(__file__).parents[2]
WEB = ROOT / "azee" / "web"
LARGEST_APP, LARGEST_VENDOR = 150_000, 800_000
"""Bytes of a script of ours, and of one with libraries."""


@pytest.mark.slow
def test_building_the_sources_gives_the_committed_bytes(web: Node, tmp_path: Path) -> None:
    copy = tmp_path / "somewhere else"
    shutil.copytree(WEB, copy, ignore=shutil.ignore_patterns("dist", "node_modules"))
    (copy / "node_modules").symlink_to(WEB / "node_modules")
    web.in_folder(copy)("node_modules/vite/bin/vite.js", "build", "--logLevel", "error")
    built = {path.name: path.read_bytes() for path in (copy / "dist").iterdir()}
    committed = {path.name: path.read_bytes() for path in bundle()}
    assert built.keys() == committed.keys()
    for name, data in built.items():
        assert data == committed[name], f"{name}: `npm run build --prefix azee/web` makes another"


@pytest.mark.slow
def test_the_types_of_the_sources_are_right(web: Node) -> None:
    assert web("node_modules/typescript/bin/tsc", "--noEmit") == ""


def test_scripts_are_small_and_name_each_other_by_relative_addresses() -> None:
    names = {path.name for path in bundle()}
    assert names >= {"player.html", "azee-player.js", "vendor-three.js", LICENCES}
    for path in bundle():
        text = path.read_text(encoding="utf-8")
        if path.suffix == ".js":
            vendor = path.name.startswith("vendor-")
            assert path.stat().st_size < (LARGEST_VENDOR if vendor else LARGEST_APP)
            imported = () if vendor else re.findall(r'(?:from|import)\s*"([^"]+)"', text)
            assert all(name.startswith("./") and name[2:] in names for name in imported)
        elif path.suffix == ".html":
            loaded = re.findall(r'(?:src|href)="([^"]+)"', text)
            assert all(a.startswith(("./", "data:")) for a in loaded)


def test_a_page_is_found_with_all_that_it_needs_and_nothing_else() -> None:
    names = {path.name for path in parts("player.html", "azee-player.js")}
    assert names >= {"player.html", "player.js", "player.css", "azee-player.js", "vendor-three.js"}
    assert LICENCES in names
    assert not any("studio" in name or "editor" in name for name in names)


def test_every_library_in_the_scripts_is_named_with_its_licence() -> None:
    package = WEB / "package.json"
    if not package.is_file():
        pytest.skip("not a checkout")
    licences = (DIST / LICENCES).read_text(encoding="utf-8")
    for name, version in json.loads(package.read_text())["dependencies"].items():
        assert f"{name} - {version}" in licences
    assert set(re.findall(r"^## .* \((.*)\)$", licences, re.MULTILINE)) <= {"MIT", "Apache-2.0"}


def test_the_lock_file_names_no_server_to_download_from() -> None:
    lock = WEB / "package-lock.json"
    if not lock.is_file():
        pytest.skip("not a checkout")
    packages = json.loads(lock.read_text())["packages"]
    assert len(packages) > 3
    assert not any("resolved" in package for package in packages.values())
