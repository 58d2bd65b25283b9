"""The wheel holds the four packages and their data, and nothing generic."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.slow
def test_the_wheel_holds_four_packages_with_their_data(tmp_path: Path) -> None:
    subprocess.run(
        [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", tmp_path, ROOT],
        check=True,
        capture_output=True,
    )
    (wheel,) = tmp_path.glob("*.whl")
    assert wheel.name.endswith("-py3-none-any.whl")
    names = zipfile.ZipFile(wheel).namelist()
    tops = {name.split("/")[0] for name in names if ".dist-info/" not in name}
    assert tops == {"azee", "azee_grammar", "azee_rig", "azee_solver"}
    for name in (
        "azee/py.typed",
        "azee/export/pictures/opengl/shade.frag",
        "azee/web/dist/player.html",
        "azee/web/dist/vendor-three.js",
        "azee/spelling/study/templates/page.html",
        "azee/spelling/timing/data/normal.json",
        "azee_grammar/azee.lark",
        "azee_grammar/data/azee.tables.json",
        "azee_grammar/rules/core/not-but.azee",
        "azee_rig/data/signer/rig.json",
        "azee_rig/data/signer/mesh.npz",
    ):
        assert name in names
    assert not any(name.startswith(("azee/web/src", "azee_rig/compiled")) for name in names)
    assert any(n.endswith("licenses/LICENSE") for n in names)
    assert any(n.endswith("licenses/NOTICE") for n in names)
