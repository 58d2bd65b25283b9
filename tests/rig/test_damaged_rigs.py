"""Folders of rigs that are damaged, mixed or from elsewhere: one message, never a crash."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.cli.main import run
from azee_rig.build.pack import write_arrays
from azee_rig.load import RigError, load_rig
from azee_rig.rig import Rig
from azee_rig.rig_json import MESH_DIGEST

Arrays = dict[str, NDArray[Any]]
Spoil = Callable[[dict[str, Any]], object]


@pytest.fixture(scope="module")
def child() -> Path:
    return load_rig("child").folder


def _described(folder: Path) -> dict[str, Any]:
    content: dict[str, Any] = json.loads((folder / "rig.json").read_text(encoding="utf-8"))
    return content


def _folder(child: Path, folder: Path, content: Mapping[str, Any], mesh: Arrays | None) -> Path:
    """Write a folder without a digest, as older ones are, so that every check is reached."""
    plain = {key: value for key, value in content.items() if key != MESH_DIGEST}
    (folder / "rig.json").write_text(json.dumps(plain), encoding="utf-8")
    if mesh is None:
        shutil.copy(child / "mesh.npz", folder)
    else:
        write_arrays(folder / "mesh.npz", mesh)
    return folder


def _arrays(child: Path) -> Arrays:
    with np.load(child / "mesh.npz") as packed:
        return dict(packed)


def test_a_folder_without_a_digest_is_read(child: Path, tmp_path: Path) -> None:
    rig = load_rig(_folder(child, tmp_path, _described(child), None))
    assert rig.mesh.joint_count == len(rig.skeleton.names)


@pytest.mark.parametrize("digest", [True, False])
@pytest.mark.parametrize("other", ["signer", "heavy", "game"])
def test_the_mesh_of_another_body_is_refused(
    child: Path, tmp_path: Path, other: str, digest: bool
) -> None:
    content = _described(child)
    if not digest:
        del content[MESH_DIGEST]
    (tmp_path / "rig.json").write_text(json.dumps(content), encoding="utf-8")
    shutil.copy(load_rig(other).folder / "mesh.npz", tmp_path)
    said = "not the one" if digest else "another body's|hangs on|other face units"
    with pytest.raises(RigError, match=said):
        load_rig(tmp_path)


@pytest.mark.long
def test_every_rig_that_ships_names_its_mesh_and_is_sound(tmp_path: Path) -> None:
    for name in ("signer", "child", "heavy", "game"):
        folder = load_rig(name).folder
        assert MESH_DIGEST in _described(folder)
        copy = tmp_path / name
        shutil.copytree(folder, copy)
        assert load_rig(copy).units == load_rig(name).units


BEYOND = 10**400


def _row(key: str, number: int, name: str, value: object) -> Spoil:
    return lambda c: c[key][number].update({name: value})


def _in(key: str, name: str, value: object) -> Spoil:
    return lambda c: c[key].update({name: value})


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (_row("drive", 5, "node", 10_000), "names node 10000"),
        (_row("drive", 5, "node", -2), "names node -2"),
        (_row("drive", 5, "twist", 10_000), "names coordinate 10000"),
        (_row("drive", 5, "helper_of", 10_000), "names joint 10000"),
        (_row("drive", 5, "helper_of", 3), "helper"),
        (lambda c: c["drive"].pop(), "rows for"),
        (_row("nodes", 9, "parent", 10_000), "10000 is no parent"),
        (_row("nodes", 9, "parent", -1), "more than one root"),
        (_row("nodes", 9, "parent", 2.5), "whole numbers"),
        (_row("nodes", 9, "turns", [[3, 1.0, "head.axial"]]), "names axis 3"),
        (_row("nodes", 9, "turns", [[-1, 1.0, "head.axial"]]), "names axis -1"),
        (_row("nodes", 9, "turns", [[0, 1.0, "head.axiom"]]), "head.axiom"),
        (_row("nodes", 9, "turns", {"0": 1}), "list of axis, scale and coordinate"),
        (_row("nodes", 9, "zero", [[2, 0, 0], [0, 2, 0], [0, 0, 2]]), "no rotation"),
        (_row("nodes", 9, "offset_m", [0, BEYOND, 0]), "63 × 3 numbers"),
        (_row("nodes", 9, "offset_m", [0, float("nan"), 0]), "infinite or none"),
        (_row("nodes", 9, "offset_m", [0, 1e300, 0]), "no body has"),
        (_row("capsules", 0, "node", 10_000), "names node 10000"),
        (_row("capsules", 0, "radius_m", -1.0), "radius below zero"),
        (lambda c: c["pairs"].append([0, 10_000]), "names capsule 10000"),
        (lambda c: c["finger_pairs"].append([-1, 0]), "names capsule -1"),
        (lambda c: c["pairs"].append([BEYOND, 0]), "`pairs` is not an array"),
        (_row("sites", 7, "node", 10_000), "names node 10000"),
        (_row("sites", 7, "node", "7"), "a number is wanted"),
        (_row("sites", 7, "bone", "tail"), "bone `tail`"),
        (_row("sites", 7, "name", "\ud800"), "no Unicode"),
        (lambda c: c["sites"].append(c["sites"][0]), "twice"),
        (_in("bones", "head", [10_000, 0]), "names node 10000"),
        (_in("bones", "head", [1]), "2 whole numbers"),
        (lambda c: c["bones"].pop("head"), "no `head`"),
        (lambda c: c["bones"].pop("index_R_2"), "not all of `index_R_1`"),
        (lambda c: c["coordinates"].pop(), "has no `"),
        (_row("coordinates", 0, "lower", 9.0), "lower limit"),
        (_in("skeleton", "parents", [-1]), "skeleton.parents"),
        (_in("skeletal_morphs", "fist", {"nothing.there": 1.0}), "nothing.there"),
        (_in("face_morphs", "grin", {"nothing": 1.0}), "face unit `nothing`"),
        (_in("lids", "nothing", ["eye_L.yaw", 1.0]), "face unit `nothing`"),
        (_in("landmarks", "arm_m", 0.0), "arm of no length"),
        (_in("landmarks", "arm_m", None), "None where a number"),
        (lambda c: c["signing_space_m"].pop("Mssp"), "'Mssp' is missing"),
        (lambda c: c.update(units=c["units"][:-1], lids={}, face_morphs={}), "other face units"),
        (lambda c: c.pop("drive"), "'drive' is missing"),
    ],
)
def test_a_description_that_does_not_hold_together_is_refused(
    child: Path, tmp_path: Path, spoil: Spoil, said: str
) -> None:
    content = _described(child)
    spoil(content)
    with pytest.raises(RigError, match=said):
        load_rig(_folder(child, tmp_path, content, None))


def _set(name: str, row: int, value: float) -> Callable[[Arrays], object]:
    def change(arrays: Arrays) -> None:
        arrays[name] = np.array(arrays[name])
        arrays[name][row] = value

    return change


@pytest.mark.long
@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (_set("joints", 0, 255), "joints outside of 0"),
        (_set("triangles", 0, 65_535), "triangles outside of 0"),
        (_set("unit_rows", 0, 65_535), "unit_rows outside of 0"),
        (_set("unit_start", 1, 10**6), "follow each other"),
        (_set("unit_start", -1, 10**6), "follow each other"),
        (_set("vertices", 3, np.nan), "infinite or none"),
        (_set("weights", 3, 0), "no joint carries"),
        (lambda a: a.update(triangles=a["triangles"][:, :2]), "triangles of shape"),
        (lambda a: a.update(colours=a["colours"][:-1]), "colours of shape"),
        (lambda a: a.update(unit_deltas=a["unit_deltas"][:-1]), "unit_deltas of shape"),
        (lambda a: a.update(joints=a["joints"].astype(np.float32)), "joints of type"),
        (lambda a: a.pop("joints"), "joints"),
        (lambda a: a.update(described=np.frombuffer(b"[]", np.uint8)), "not an object"),
    ],
)
def test_a_mesh_that_points_outside_itself_is_refused(
    child: Path, tmp_path: Path, spoil: Callable[[Arrays], object], said: str
) -> None:
    arrays = _arrays(child)
    spoil(arrays)
    with pytest.raises(RigError, match=said):
        load_rig(_folder(child, tmp_path, _described(child), arrays))


@pytest.mark.parametrize(
    "spoil",
    [
        lambda data: b"",
        lambda data: b"PK\3\4",
        lambda data: data[:5000],
        lambda data: data[: len(data) // 2],
        lambda data: data[5000:],
        lambda data: data[:400] + bytes(4000) + data[4400:],
        lambda data: b"\x93NUMPY" + data[6:],
        lambda data: json.dumps([1, 2]).encode(),
        lambda data: None,
    ],
    ids=range(9),
)
def test_a_mesh_file_that_is_none_is_refused(
    child: Path, tmp_path: Path, spoil: Callable[[bytes], bytes | None]
) -> None:
    _folder(child, tmp_path, _described(child), None)
    data = spoil((child / "mesh.npz").read_bytes())
    (tmp_path / "mesh.npz").unlink()
    if data is not None:
        (tmp_path / "mesh.npz").write_bytes(data)
    with pytest.raises(RigError, match="cannot read the rig in"):
        load_rig(tmp_path)


def test_a_description_that_is_nested_too_deeply_is_refused(tmp_path: Path) -> None:
    (tmp_path / "rig.json").write_text("[" * 200_000, encoding="utf-8")
    with pytest.raises(RigError, match="cannot read the rig in"):
        load_rig(tmp_path)


def test_a_command_says_so_and_ends(
    child: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arrays = _arrays(child)
    _set("joints", 0, 255)(arrays)
    folder = _folder(child, tmp_path, _described(child), arrays)
    assert run(["rig", "check", "--rig", str(folder)]) == 2
    assert "joints outside of 0" in capsys.readouterr().err


def test_what_compiled_loops_read_is_checked_where_it_is_made(signer: Rig) -> None:
    """A mesh made in Python is held to the same: no index reaches a loop unseen."""
    code = (
        "import dataclasses, numpy as np; from azee_rig.load import load_rig\n"
        "mesh = load_rig('child').mesh\n"
        "try: dataclasses.replace(mesh, joints=mesh.joints + 10**9)\n"
        "except ValueError as error: print(error)\n"
    )
    shown = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout
    assert "joints outside of 0" in shown
