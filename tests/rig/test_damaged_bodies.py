"""Files of bodies with something wrong in them: each gives one clear message, and no traceback."""

from __future__ import annotations

import base64
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from body_families import make_body
from glb_file import GlbFile
from joint_names import FAMILIES

from azee.cli.main import run
from azee_rig.importing.container import read_gltf
from azee_rig.importing.fault import BodyError
from azee_rig.importing.importer import import_body
from azee_rig.importing.scene import read_scene

Change = Callable[[GlbFile], object]
MANY_DIGITS = 10**400


@pytest.fixture(scope="module")
def whole() -> GlbFile:
    return make_body(FAMILIES["ready-player-me"]).file(units={"jawOpen": "jawOpen"})


def _put(value: object, *path: str | int) -> Change:
    def change(file: GlbFile) -> None:
        at: Any = file.document
        for key in path[:-1]:
            at = at[key]
        at[path[-1]] = value

    return change


def _drop(*path: str | int) -> Change:
    def change(file: GlbFile) -> None:
        at: Any = file.document
        for key in path[:-1]:
            at = at[key]
        del at[path[-1]]

    return change


def _accessor(file: GlbFile, attribute: str) -> dict[str, Any]:
    primitive = file.document["meshes"][0]["primitives"][0]
    found: dict[str, Any] = file.document["accessors"][primitive["attributes"][attribute]]
    return found


def _rows(file: GlbFile, attribute: str, dtype: Any, width: int, value: float) -> None:
    """Write the same number over all of an attribute."""
    accessor = _accessor(file, attribute)
    view = file.document["bufferViews"][accessor["bufferView"]]
    data = np.full((accessor["count"], width), value, dtype).tobytes()
    start = view["byteOffset"]
    file.binary = file.binary[:start] + data + file.binary[start + len(data) :]


def _all_on_one_joint(file: GlbFile) -> None:
    _rows(file, "JOINTS_0", np.uint16, 4, 0)


def _small_mesh(file: GlbFile) -> None:
    """Make the mesh a thousand times too small, with its bones where they were."""
    accessor = _accessor(file, "POSITION")
    start = file.document["bufferViews"][accessor["bufferView"]]["byteOffset"]
    size = accessor["count"] * 12
    small = np.frombuffer(file.binary[start : start + size], np.float32) / 1000.0
    file.binary = file.binary[:start] + small.tobytes() + file.binary[start + size :]


def _above(scale: float) -> Change:
    """Hang the skeleton on a node of some scale."""

    def change(file: GlbFile) -> None:
        roots = file.document["scenes"][0]["nodes"]
        file.nodes.append({"name": "Above", "children": [roots[0]], "scale": [scale] * 3})
        roots[0] = len(file.nodes) - 1

    return change


def _required(value: object) -> Change:
    return _put(value, "extensionsRequired")


def _needing(extension: str, *path: str | int) -> Change:
    """Require an extension, and put it on something."""

    def change(file: GlbFile) -> None:
        _required([extension])(file)
        _put({extension: {}}, *path, "extensions")(file)

    return change


def _forearm_at_wrist(file: GlbFile) -> None:
    number = {node.get("name"): i for i, node in enumerate(file.nodes)}
    file.nodes[number["LeftHand"]]["translation"] = [0, 0, 0]
    skin = file.document["skins"][0]
    view = file.document["accessors"][skin["inverseBindMatrices"]]["bufferView"]
    start = file.document["bufferViews"][view]["byteOffset"]
    at = [start + 64 * skin["joints"].index(number[name]) for name in ("LeftForeArm", "LeftHand")]
    matrix = file.binary[at[0] : at[0] + 64]
    file.binary = file.binary[: at[1]] + matrix + file.binary[at[1] + 64 :]


@pytest.mark.parametrize(
    ("change", "code", "said"),
    [
        (_required([["KHR_mesh_quantization"]]), "body-unreadable", "`extensionsRequired`"),
        (_required([{}]), "body-unreadable", "`extensionsRequired` is not a list of names"),
        (_required("KHR_mesh_quantization"), "body-unreadable", "`extensionsRequired`"),
        (_required([7]), "body-unreadable", "`extensionsRequired`"),
        (_needing("XX_\ud800", "skins", 0), "body-unsupported", "which is not read"),
        (_needing("XX_shape", "nodes", 1), "body-unsupported", "`XX_shape`"),
        (_needing("XX_shape", "meshes", 0, "primitives", 0), "body-unsupported", "`XX_shape`"),
        (_put(MANY_DIGITS, "nodes", 3, "translation", 1), "body-unreadable", "node 3"),
        (_put(1e200, "nodes", 3, "translation", 1), "body-unreadable", "node 3"),
        (_put([0, 0, 0, 0], "nodes", 3, "rotation"), "body-unreadable", "rotation that is none"),
        (_put([1e300] * 4, "nodes", 3, "rotation"), "body-unreadable", "node 3"),
        (_put(MANY_DIGITS, "accessors", 1, "count"), "body-unreadable", "more than thirty digits"),
        (_put(MANY_DIGITS, "bufferViews", 1, "byteOffset"), "body-unreadable", "thirty digits"),
        (_put(MANY_DIGITS, "buffers", 0, "byteLength"), "body-unreadable", "thirty digits"),
        (_put(MANY_DIGITS, "skins", 0, "joints", 1), "body-unreadable", "thirty digits"),
        (_put(True, "skins", 0, "joints", 1), "body-unreadable", "True"),
        (_put([0, 0], "skins", 0, "joints"), "body-unreadable", "joint twice"),
        (_put([], "skins", 0, "joints"), "body-unreadable", "no joints"),
        (_put({"version": ["2.0"]}, "asset"), "body-unreadable", "no `asset.version`"),
        (_put({}, "nodes"), "body-unreadable", "`nodes` is not a list of objects"),
        (_put([None], "accessors"), "body-unreadable", "`accessors` is not a list of objects"),
        (_put(["VEC3"], "accessors", 1, "type"), "body-unreadable", "a list"),
        (_put([5126], "accessors", 1, "componentType"), "body-unreadable", "a list"),
        (_put([0], "nodes", 3, "mesh"), "body-unreadable", "a list is none"),
        (_put("data:;base64,ÄÖÜ", "buffers", 0, "uri"), "body-unreadable", "base64"),
        (_put("data:;base64,===", "buffers", 0, "uri"), "body-unreadable", "base64"),
        (_put("a\0b.bin", "buffers", 0, "uri"), "body-unreadable", "is not there"),
        (_put("a%00b.bin", "buffers", 0, "uri"), "body-unreadable", "is not there"),
        (_put("\ud800.bin", "buffers", 0, "uri"), "body-unreadable", "is not there"),
        (_put("../body.bin", "buffers", 0, "uri"), "body-unreadable", "does not lie beside"),
        (_put(["body.bin"], "buffers", 0, "uri"), "body-unreadable", "not a text"),
        (_all_on_one_joint, "body-incomplete", "no skin hangs on the left arm"),
        (_small_mesh, "body-incomplete", "times the size of its skeleton"),
        (_above(0.0), "body-incomplete", "scaled to nothing"),
        (_forearm_at_wrist, "body-incomplete", "`f_arm_L` has no length"),
        (lambda f: _rows(f, "POSITION", np.float32, 3, 0.0), "body-incomplete", "no height"),
        (lambda f: _rows(f, "POSITION", np.float32, 3, np.nan), "body-unreadable", "infinite"),
        (lambda f: _rows(f, "POSITION", np.float32, 3, 1e30), "body-unreadable", "numbers reach"),
        (lambda f: _rows(f, "JOINTS_0", np.uint16, 4, 999), "body-unreadable", "joint 999"),
    ],
)
def test_one_clear_message(
    whole: GlbFile, tmp_path: Path, change: Change, code: str, said: str
) -> None:
    file = whole.copy()
    change(file)
    with pytest.raises(BodyError) as caught:
        import_body(file.write(tmp_path / "bad.glb"), "bad")
    assert caught.value.code == code
    assert said in caught.value.message
    caught.value.message.encode()
    assert len(caught.value.message) < 250


def test_a_root_called_head(whole: GlbFile, tmp_path: Path) -> None:
    file = whole.copy()
    for node in file.nodes:
        node["name"] = {"Hips": "Head", "Head": "Skull"}.get(node["name"], node["name"])
    made = read_scene(read_gltf(file.write(tmp_path / "head.glb")))
    assert made.joints[0] == "Head"
    for node in file.nodes[:]:
        node.pop("children", None)
    file.nodes[0]["children"] = list(range(1, len(file.nodes) - 1))
    with pytest.raises(BodyError, match="no joints were found"):
        import_body(file.write(tmp_path / "flat.glb"), "flat")


def test_half_a_surrogate_pair_in_a_name_is_replaced(whole: GlbFile, tmp_path: Path) -> None:
    file = whole.copy()
    file.nodes[0]["name"] = "Hips\ud800"
    file.document["materials"][0]["name"] = "\udfff"
    file.document["meshes"][0]["extras"]["targetNames"] = ["jaw\udc00"]
    scene = read_scene(read_gltf(file.write(tmp_path / "names.glb")))
    for name in (*scene.joints, *(p.name for p in scene.parts), *(t.name for t in scene.targets)):
        assert name.encode()
    assert scene.joints[0] == "Hips?"


def test_a_mesh_without_a_skin_that_is_scaled_to_nothing_is_left_out(
    whole: GlbFile, tmp_path: Path
) -> None:
    file = whole.copy()
    plain = read_scene(read_gltf(file.write(tmp_path / "plain.glb")))
    hand = next(node for node in file.nodes if node["name"] == "LeftHand")
    mesh = json.loads(json.dumps(file.document["meshes"][0]))
    for primitive in mesh["primitives"]:
        for name in ("JOINTS_0", "WEIGHTS_0"):
            del primitive["attributes"][name]
    file.document["meshes"].append(mesh)
    file.nodes.append({"name": "Sword", "mesh": 1, "scale": [0, 0, 0]})
    hand["children"].append(len(file.nodes) - 1)
    scene = read_scene(read_gltf(file.write(tmp_path / "sword.glb")))
    assert len(scene.vertices) == len(plain.vertices)
    file.nodes[-1]["scale"] = [0.1, 0.1, 0.1]
    scene = read_scene(read_gltf(file.write(tmp_path / "sword.glb")))
    assert len(scene.vertices) == 2 * len(plain.vertices)


@pytest.mark.parametrize("form", ["base64", "percent", "bom"])
def test_buffers_inside_a_text_file_are_read(whole: GlbFile, tmp_path: Path, form: str) -> None:
    file = whole.copy()
    if form == "percent":
        coded = "data:application/octet-stream," + "".join(f"%{byte:02x}" for byte in file.binary)
    else:
        coded = "data:;base64," + base64.b64encode(file.binary).decode()
    file.document["buffers"][0]["uri"] = coded
    text = json.dumps(file.document).encode()
    path = tmp_path / "body.gltf"
    path.write_bytes(b"\xef\xbb\xbf" + text if form == "bom" else text)
    assert read_gltf(path).buffers[0] == file.binary


def test_an_accessor_without_data_may_not_claim_more_than_the_file_has(
    whole: GlbFile, tmp_path: Path
) -> None:
    file = whole.copy()
    accessor = _accessor(file, "POSITION")
    del accessor["bufferView"]
    accessor["count"] = 20_000_000
    with pytest.raises(BodyError, match="claims 20000000 elements and has no data"):
        read_scene(read_gltf(file.write(tmp_path / "claims.glb")))


def test_a_command_says_it_and_leaves_nothing_behind(
    whole: GlbFile, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = whole.copy()
    _above(0.0)(file)
    path = file.write(tmp_path / "flat.glb")
    assert run(["rig", "import", str(path), "-o", str(tmp_path / "rig")]) == 1
    assert "error[body-incomplete]" in capsys.readouterr().err
    assert [p.name for p in tmp_path.iterdir()] == ["flat.glb"]
