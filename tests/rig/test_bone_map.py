"""Bones-maps that were edited by hand: what is wrong is told by its entry."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from body_families import make_body
from joint_names import FAMILIES

from azee.cli.main import run
from azee_rig.importing.bone_map import read_bone_map
from azee_rig.importing.fault import BodyError
from azee_rig.importing.importer import import_body, propose_bones

Change = Callable[[dict[str, Any]], object]


@pytest.fixture(scope="module")
def body(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small body under the names of Mixamo, without its prefix."""
    file = make_body(FAMILIES["ready-player-me"]).file()
    return file.write(tmp_path_factory.mktemp("maps") / "body.glb")


@pytest.fixture(scope="module")
def proposal(body: Path) -> str:
    return json.dumps(propose_bones(body).as_json())


def _swap(first: str, second: str) -> Change:
    def change(content: dict[str, Any]) -> None:
        bones = content["bones"]
        bones[first], bones[second] = bones[second], bones[first]

    return change


def _set(group: str, key: str, value: object) -> Change:
    return lambda content: content[group].update({key: value})


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (_set("tips", "index_L", "LeftHandIndex3"), r"`bones.index_L_3` and for `tips.index_L`"),
        (_set("tips", "index_L", "LeftHandMiddle3"), r"`bones.middle_L_3` and for `tips.index_L`"),
        (_set("tips", "index_L", "Head"), r"`bones.head` and for `tips.index_L`"),
        (_set("tips", "index_L", "LeftFoot"), r"`tips.index_L` is `LeftFoot`, which does not hang"),
        (_set("tips", "index", "LeftFoot"), r"`tips` has no place for `index`"),
        (_set("tips", "index_L", {"a": 1}), r"`tips.index_L` has an object"),
        (_set("tips", "index_L", ["LeftHandIndex4"]), r"`tips.index_L` has a list"),
        (_swap("arm_L", "f_arm_L"), r"`bones.arm_L` is `LeftForeArm`.*|`bones.f_arm_L` is"),
        (_swap("arm_L", "arm_R"), r"`bones.arm_L` is `RightArm`, which does not hang on `LeftSh"),
        (_swap("head", "neck"), r"`bones.head` is `Neck`, which does not hang on `Head`"),
        (_swap("index_R_1", "index_R_2"), r"`bones.index_R_2`"),
        (_swap("index_R_1", "palm_R"), r"`bones.index_R_1`|`bones.palm_R`"),
        (_set("bones", "arm_L", [["LeftArm"]]), r"`bones.arm_L` has a list where a text"),
        (_set("bones", "arm_L", {"0": "LeftArm"}), r"`bones.arm_L` is not a list of names"),
        (_set("bones", "arm_L", 7), r"`bones.arm_L` is not a list of names"),
        (_set("bones", "arm_L", ["LeftArm", "LeftArm"]), r"`bones.arm_L` has `LeftArm` twice"),
        (_set("bones", "arm_L", ["Left\ud800"]), r"`bones.arm_L` has a text that is no Unicode"),
        (_set("bones", "arm_L", ["LeftArn"]), r"no joint `LeftArn` \(`bones.arm_L`\)"),
        (_set("bones", "arm_L", []), r"no joints were found for `arm_L`"),
        (_set("bones", "elbow_L", ["LeftArm"]), r"AZee has no bone `elbow_L`"),
        (_set("twists", "palm_L", ["LeftHand"]), r"`twists` has no place for `palm_L`"),
        (_set("twists", "arm_L", ["LeftArm"]), r"stands for two bones, `bones.arm_L` and `twist"),
        (lambda c: c.update(kept="LeftFoot"), r"`kept` is not a list"),
        (lambda c: c.update(root=["Hips"]), r"`root` has a list"),
        (lambda c: c.update(root="LeftHand"), r"does not hang on the root, `LeftHand`"),
        (lambda c: c.update(bones=[]), r"`bones` is not an object"),
        (lambda c: c.pop("bones"), r"'bones' is missing"),
    ],
)
def test_the_entry_that_is_wrong_is_named(
    body: Path, proposal: str, tmp_path: Path, change: Change, said: str
) -> None:
    content = json.loads(proposal)
    change(content)
    path = tmp_path / "map.json"
    path.write_text(json.dumps(content), encoding="utf-8")
    with pytest.raises(BodyError) as caught:
        import_body(body, "x", path)
    told = "\n".join([caught.value.message, *caught.value.notes])
    assert caught.value.code in ("body-map", "body-incomplete")
    assert re.search(said, told), told


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"[" * 100_000, "nested too deeply"),
        (b'{"bones": ' + b"[" * 50_000, "nested too deeply"),
        (b"\xff\xfe\x00", "it is no JSON"),
        (b"{}", "'bones' is missing"),
        (b'{"bones": {}\n\n"root"', "line 3"),
        (b"7", "the whole file"),
        (b"", "line 1"),
    ],
)
def test_a_file_that_is_no_map(
    body: Path, tmp_path: Path, data: bytes, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "map.json"
    path.write_bytes(data)
    command = ["rig", "import", str(body), "-o", str(tmp_path / "rig"), "--map", str(path)]
    assert run(command) == 1
    told = capsys.readouterr().err
    assert "error[body-map]" in told
    assert said in told


def test_a_joint_alone_may_stand_without_a_list(proposal: str, tmp_path: Path) -> None:
    content = json.loads(proposal)
    content["bones"] |= {"arm_L": "LeftArm", "neck": None}
    path = tmp_path / "map.json"
    path.write_text(json.dumps(content), encoding="utf-8")
    found = read_bone_map(path)
    assert found.bones["arm_L"] == ("LeftArm",)
    assert "neck" not in found.bones
