"""Faces that others made: which target is which unit, textures, and where the sites lie."""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from body_families import Body, make_body
from drawn_faces import drawn
from glb_file import GlbFile
from joint_names import FAMILIES
from numpy.typing import NDArray
from PIL import Image

from azee_rig.importing import importer
from azee_rig.importing.container import read_gltf
from azee_rig.importing.face import map_face, pack_units
from azee_rig.importing.importer import import_body
from azee_rig.importing.scene import Target, read_scene
from azee_rig.load import load_rig
from azee_rig.rig import Rig

DATA = Path(importer.DATA)
TABLE = json.loads((DATA / "face_morphs.json").read_text(encoding="utf-8"))


@pytest.fixture
def rigid(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave sites in their nodes' frames: what they ride on is tested elsewhere, and slow."""
    monkeypatch.setattr(importer, "riding", lambda rig, mesh: rig.sites)


@pytest.fixture(scope="module")
def plain_body() -> Body:
    return make_body(FAMILIES["vroid"])


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize(
    ("exact", "alias"),
    [
        ("jawOpen", "viseme_aa"),
        ("jawOpen", "mouthOpen"),
        ("mouthFunnel", "viseme_O"),
        ("mouthPucker", "viseme_U"),
        ("mouthPucker", "kiss"),
        ("browInnerUp", "Fcl_BRW_Sorrow"),
    ],
)
def test_a_units_own_name_counts_before_another(exact: str, alias: str, order: int) -> None:
    targets = [alias, exact][::order]
    face = map_face(targets, {}, DATA, TABLE, {exact: ("a", 1.0)})
    assert list(face.lids) == [exact]
    only = map_face([alias], {}, DATA, TABLE, {exact: ("a", 1.0)})
    assert list(only.lids) == [alias]


def test_a_vrm_that_has_the_unit_itself_uses_it() -> None:
    said = {"aa": {"Fcl_MTH_A": 1.0}}
    face = map_face(["Fcl_MTH_A", "jawOpen"], said, DATA, TABLE, {"jawOpen": ("a", 1.0)})
    assert list(face.lids) == ["jawOpen"]


def test_a_vrm_that_leaves_a_word_empty_says_nothing_about_it() -> None:
    said: dict[str, dict[str, float]] = {"jawOpen": {}, "aa": {}}
    face = map_face(["jawOpen"], said, DATA, TABLE, {"jawOpen": ("a", 1.0)})
    assert face.lids == {"jawOpen": ("a", 1.0)}


@pytest.mark.parametrize(
    "name",
    ["jawOpen", "JawOpen", "jaw_open", "Face.jawOpen", "Anna_Face_jawOpen", "head-JawOpen",
     "Face.M_F00_000_00_Fcl_MTH_A"],
)  # fmt: skip
def test_a_target_is_known_by_the_end_of_its_name(name: str) -> None:
    face = map_face([name], {}, DATA, TABLE, {"jawOpen": ("a", 1.0)})
    assert list(face.lids) == [name]


@pytest.mark.parametrize(
    ("name", "side"),
    [
        ("eyeBlink_L", "left"),
        ("EyeBlinkLeft", "left"),
        ("Blink-l", "left"),
        ("eyeBlink_R", "right"),
        ("EyeBlinkRight", "right"),
        ("Blink.r", "right"),
    ],
)
def test_a_letter_at_the_end_of_a_name_is_its_side(name: str, side: str) -> None:
    lids = {"eyeBlinkLeft": ("left", 1.0), "eyeBlinkRight": ("right", 1.0)}
    assert map_face([name], {}, DATA, TABLE, lids).lids == {name: (side, 1.0)}


@pytest.mark.parametrize(
    ("word", "unit", "known"), [("tongue", "tongueOut", True), ("kiss", "mouthPucker", False)]
)
def test_the_end_of_a_name_counts_from_six_letters_on(word: str, unit: str, known: bool) -> None:
    lids = {unit: ("a", 1.0)}
    assert list(map_face([word], {}, DATA, TABLE, lids).lids) == [word]
    assert bool(map_face([f"Anna_{word}"], {}, DATA, TABLE, lids).lids) == known


def test_a_unit_that_a_face_lacks_borrows_of_a_near_one_that_is_not_asked_for_itself() -> None:
    near, lacking = "browInnerUp", "mh_eyebrows-left-inner-up"
    table = {
        "expressed": {"alone": {lacking: 0.8}, "both": {lacking: 0.8, near: 0.6}},
        "not_expressed": {},
    }
    face = map_face([near], {}, DATA, table, {})
    assert face.expressed["alone"] == pytest.approx({near: 0.4})
    assert "both" not in face.expressed
    table["expressed"]["both"][near] = 0.9
    face = map_face([near], {}, DATA, table, {})
    assert face.expressed["both"] == pytest.approx({near: 0.9})
    assert face.partly == ("alone", "both")
    lids = {"eyeBlinkLeft": ("eye_L.pitch", 1.0)}
    assert map_face(["eyeBlinkLeft", near], {}, DATA, table, lids).targets == (near, "eyeBlinkLeft")


def test_a_unit_borrows_of_a_near_one_that_no_morph_and_no_lid_asks_for() -> None:
    near, lacking = "noseSneerLeft", "mh_nose-left-elevation"
    for weight in (0.8, -0.8):
        table = {"expressed": {"X": {lacking: weight}}, "not_expressed": {}}
        face = map_face([near], {}, DATA, table, {})
        assert face.expressed == {"X": {near: pytest.approx(0.6 * weight)}}


@pytest.mark.parametrize("in_table", [True, False])
def test_a_unit_that_only_the_signer_knows_is_one_of_that_name(in_table: bool) -> None:
    """A table of morphs or a lid may ask for what no other face is known to call so."""
    lids = {} if in_table else {"ourOwn": ("a", 1.0)}
    expressed = {"X": {"ourOwn": 0.7}} if in_table else {}
    face = map_face(["ourOwn"], {}, DATA, {"expressed": expressed, "not_expressed": {}}, lids)
    assert (face.expressed, face.lids) == (expressed, lids)
    assert face.targets == ("ourOwn",)


def test_the_end_of_another_word_is_no_name() -> None:
    face = map_face(["Shirt_puff", "toothsmile"], {}, DATA, TABLE, {"jawOpen": ("a", 1.0)})
    assert not face.expressed


@pytest.mark.slow
def test_a_target_moves_the_vertices_that_the_file_says(tmp_path: Path, rigid: None) -> None:
    """In metres of the body that stands, though the file is in centimetres with z up."""
    unit = "jawOpen"
    body = make_body(FAMILIES["ready-player-me"])
    path = body.file(unit=0.01, up="z", units={"other": "cheekPuff", unit: unit})
    made = import_body(path.write(tmp_path / "body.glb"), "face")
    rows, deltas = made.mesh.unit(unit)
    there, moves = body.units[unit]
    expected = {}
    for row, move in zip(there.tolist(), moves, strict=True):
        if np.abs(move).max() > 1e-6:
            expected[tuple(np.round(body.vertices[row], 4))] = move
    assert len(expected) > 20
    found = {
        tuple(np.round(made.mesh.vertices[row], 4)): move
        for row, move in zip(rows.tolist(), deltas, strict=True)
    }
    near = [key for key in expected if key in found]
    assert len(near) > 0.9 * len(expected)
    for key in near:
        assert np.allclose(found[key], expected[key], atol=2e-5)
    assert "cheekPuff" not in made.mesh.units


@pytest.mark.long
@pytest.mark.parametrize(
    "shape",
    [
        {"apart_m": 0.12},
        pytest.param({"apart_m": 0.095}, marks=pytest.mark.slow),
        pytest.param({"apart_m": 0.035, "deep_m": 0.05}, marks=pytest.mark.slow),
    ],
    ids=["far", "less far", "deep"],
)
def test_every_site_of_a_drawn_face_is_placed(
    plain_body: Body, tmp_path: Path, rigid: None, shape: dict[str, float]
) -> None:
    body = drawn(plain_body, **shape)
    made = import_body(body.file().write(tmp_path / "drawn.glb"), "drawn")
    assert made.report.lost_sites == ()
    assert set(made.rig.sites) == set(load_rig("signer").sites)
    at = _places(made.rig)
    assert at["CH"][1] < at["MO"][1] < at["NSP"][1] <= at["NO"][1] < at["EYE_L"][1]
    assert at["EYE_L"][1] < at["EB_L"][1] < at["FH"][1] < at["HEAD"][1]
    assert 0.0 < at["EBi_L"][0] < at["EB_L"][0] < at["EBe_L"][0] < at["EAR_L"][0]
    assert 0.01 < at["NO_L"][0] < 0.03
    chin = body.vertices[body.weights[:, body.names.index("J_Bip_C_Head")] > 0.9][:, 1].min()
    assert chin - 0.01 < at["CH"][1] < chin + 0.03
    for name, place in at.items():
        assert np.linalg.norm(made.mesh.vertices - place, axis=1).min() < 0.02, name


def _places(rig: Rig) -> dict[str, NDArray[np.float64]]:
    frames = rig.chain.frames(rig.coordinates.bind)
    return {n: s.point(frames) for n, s in rig.sites.items() if s.bone == "head"}


def _image(form: str) -> bytes:
    """Return a picture whose left half is red and whose right half is blue."""
    pixels = np.zeros((4, 8, 3), np.uint8)
    pixels[:, :4], pixels[:, 4:] = (255, 0, 0), (0, 0, 255)
    out = io.BytesIO()
    Image.fromarray(pixels).save(out, form, **({"lossless": True} if form == "WEBP" else {}))
    return out.getvalue()


@pytest.fixture(scope="module")
def textured() -> GlbFile:
    """A body whose first material has a texture: its vertices look at the left half."""
    file = make_body(FAMILIES["ready-player-me"]).file()
    document = file.document
    primitive = document["meshes"][0]["primitives"][0]
    count = document["accessors"][primitive["attributes"]["POSITION"]]["count"]
    at = np.tile(np.array([0.25, 0.5], np.float32), (count, 1)).tobytes()
    document["bufferViews"].append(
        {"buffer": 0, "byteOffset": len(file.binary), "byteLength": len(at)}
    )
    document["accessors"].append(
        {"bufferView": len(document["bufferViews"]) - 1, "componentType": 5126, "count": count,
         "type": "VEC2"}
    )  # fmt: skip
    file.binary += at
    document["buffers"][0]["byteLength"] = len(file.binary)
    primitive["attributes"]["TEXCOORD_0"] = len(document["accessors"]) - 1
    material = document["materials"][primitive["material"]]
    material["pbrMetallicRoughness"] = {"baseColorTexture": {"index": 0}}
    document["textures"] = [{"source": 0}]
    document["images"] = [{"uri": "skin%20of%20it.png"}]
    return file


def _loose(file: GlbFile, folder: Path) -> Path:
    """Write it as a .gltf with its buffer beside."""
    (folder / "body.bin").write_bytes(file.binary)
    file.document["buffers"][0]["uri"] = "body.bin"
    path = folder / "body.gltf"
    path.write_text(json.dumps(file.document), encoding="utf-8")
    return path


def _colour(path: Path) -> tuple[list[float], tuple[str, ...]]:
    scene = read_scene(read_gltf(path))
    first = scene.triangles[scene.parts[0].start, 0]
    return np.round(scene.colours[first], 3).tolist(), scene.notes


def test_a_texture_beside_a_gltf_is_read(textured: GlbFile, tmp_path: Path) -> None:
    (tmp_path / "skin of it.png").write_bytes(_image("PNG"))
    assert _colour(_loose(textured.copy(), tmp_path)) == ([1.0, 0.0, 0.0], ())


def _webp(extension: str) -> Callable[[GlbFile], None]:
    def change(file: GlbFile) -> None:
        file.document["textures"] = [{"extensions": {extension: {"source": 0}}}]
        file.document["extensionsRequired"] = [extension]

    return change


def _transformed(file: GlbFile) -> None:
    material = file.document["materials"][0]["pbrMetallicRoughness"]
    material["baseColorTexture"]["extensions"] = {
        "KHR_texture_transform": {"offset": [0.5, 0.0], "scale": [0.5, 1.0]}
    }
    file.document["extensionsRequired"] = ["KHR_texture_transform"]


def _glossy(file: GlbFile) -> None:
    material = file.document["materials"][0]
    look = material.pop("pbrMetallicRoughness")
    material["extensions"] = {
        "KHR_materials_pbrSpecularGlossiness": {"diffuseTexture": look["baseColorTexture"]}
    }


@pytest.mark.parametrize(
    ("change", "form", "colour"),
    [
        (_webp("EXT_texture_webp"), "WEBP", [1.0, 0.0, 0.0]),
        (_webp("XX_texture_of_ours"), "PNG", [1.0, 0.0, 0.0]),
        (_transformed, "PNG", [0.0, 0.0, 1.0]),
        (_glossy, "PNG", [1.0, 0.0, 0.0]),
    ],
)
def test_extensions_that_decorate_are_no_reason_to_refuse(
    textured: GlbFile,
    tmp_path: Path,
    change: Callable[[GlbFile], None],
    form: str,
    colour: list[float],
) -> None:
    file = textured.copy()
    change(file)
    (tmp_path / "skin of it.png").write_bytes(_image(form))
    assert _colour(_loose(file, tmp_path)) == (colour, ())


@pytest.mark.parametrize("extension", ["KHR_texture_basisu", "KHR_materials_clearcoat", "XX_glow"])
def test_extensions_on_looks_never_refuse_a_body(
    textured: GlbFile, tmp_path: Path, extension: str
) -> None:
    file = textured.copy()
    file.document["materials"][0]["extensions"] = {extension: {}}
    file.document["extensionsRequired"] = [extension]
    assert read_scene(read_gltf(file.write(tmp_path / "body.glb"))).joints


@pytest.mark.parametrize("data", [None, b"", b"no image", _image("PNG")[:30]])
def test_a_texture_that_cannot_be_read_is_told(
    textured: GlbFile, tmp_path: Path, data: bytes | None
) -> None:
    if data is not None:
        (tmp_path / "skin of it.png").write_bytes(data)
    colour, notes = _colour(_loose(textured.copy(), tmp_path))
    assert colour == [1.0, 1.0, 1.0]
    assert "its texture could not be read: there its materials' plain colours are seen" in notes


@pytest.mark.parametrize(
    ("units", "shown", "partly"),
    [
        ({"jawOpen": 0.5, "mouthPucker": 0.5}, True, True),
        ({"jawOpen": 0.49, "mouthPucker": 0.51}, False, False),
        ({"jawOpen": 0.9995, "mouthPucker": 0.0005}, True, False),
        ({"jawOpen": 0.999, "mouthPucker": 0.001}, True, False),
        ({"jawOpen": 0.99, "mouthPucker": 0.01}, True, True),
        ({"jawOpen": -0.7, "mouthPucker": 0.3}, True, True),
        ({"mouthPucker": 1.0}, False, False),
    ],
)
def test_a_morph_is_shown_if_half_of_it_is_there(
    units: dict[str, float], shown: bool, partly: bool
) -> None:
    table = {"expressed": {"X": units}, "not_expressed": {}}
    face = map_face(["jawOpen"], {}, DATA, table, {})
    assert ("X" in face.expressed) == shown
    assert face.partly == (("X",) if partly else ())
    if shown:
        assert face.expressed["X"] == {"jawOpen": units["jawOpen"]}
    else:
        assert face.unexpressed["X"] == "this body's face has no morph target for mouthPucker"


def test_a_target_for_both_sides_stands_for_two_units_of_one_weight() -> None:
    both = {"expressed": {"X": {"eyeBlinkLeft": 0.8, "eyeBlinkRight": 0.8}}, "not_expressed": {}}
    face = map_face(["Blink"], {}, DATA, both, {})
    assert face.expressed["X"] == {"Blink": 0.8}
    assert face.partly == ()
    uneven = {"expressed": {"X": {"eyeBlinkLeft": 0.8, "eyeBlinkRight": 0.3}}, "not_expressed": {}}
    assert map_face(["Blink"], {}, DATA, uneven, {}).expressed == {}
    even = {"expressed": {"X": {"eyeBlinkLeft": -0.8, "eyeBlinkRight": -0.8}}, "not_expressed": {}}
    assert map_face(["Blink"], {}, DATA, even, {}).expressed == {"X": {"Blink": -0.8}}
    for one in ("Blink_L", "Blink_R"):
        assert map_face(["Blink", one], {}, DATA, both, {}).expressed["X"] == {"Blink": 0.8}
    sides = map_face(["Blink", "Blink_L", "Blink_R"], {}, DATA, both, {})
    assert sides.expressed["X"] == {"Blink_L": 0.8, "Blink_R": 0.8}


def test_a_target_that_shows_a_unit_in_part_is_set_to_a_part_of_its_weight() -> None:
    """A preset of a VRM may set half a target; two units may share one."""
    said = {"aa": {"Mouth": 0.5}}
    table = {"expressed": {"X": {"jawOpen": 0.8}}, "not_expressed": {}}
    face = map_face(["Mouth"], said, DATA, table, {"jawOpen": ("a", 0.6)})
    assert face.expressed == {"X": {"Mouth": 0.4}}
    assert face.lids == {"Mouth": ("a", 0.3)}


def test_a_weight_has_six_digits_behind_the_point() -> None:
    table = {"expressed": {"X": {"jawOpen": 0.12345678}}, "not_expressed": {}}
    assert map_face(["jawOpen"], {}, DATA, table, {}).expressed["X"] == {"jawOpen": 0.123457}


def test_targets_of_one_name_are_joined_and_sorted_by_the_vertices_they_move() -> None:
    """Skin, lashes and teeth may each have their own, in meshes of their own."""

    def target(mesh: int, name: str, rows: list[int]) -> Target:
        return Target(mesh, 0, name, np.array(rows), np.outer(rows, [1.0, 2.0, 3.0]))

    targets = [target(0, "a", [7, 2]), target(0, "b", [4]), target(1, "a", [5]),
               target(1, "other", [1])]  # fmt: skip
    units = pack_units(targets, ["b", "none", "a"])
    assert units.names == ("b", "none", "a")
    assert units.start.tolist() == [0, 1, 1, 4]
    assert units.rows.tolist() == [4, 2, 5, 7]
    np.testing.assert_array_equal(units.deltas, np.outer(units.rows, [1.0, 2.0, 3.0]))


def test_without_targets_there_are_no_units() -> None:
    units = pack_units([], [])
    assert units.start.tolist() == [0]
    assert (units.rows.shape, units.deltas.shape) == ((0,), (0, 3))


@pytest.mark.parametrize(("other", "shown"), [(1.5, True), (1.7, False)])
def test_a_target_for_both_sides_counts_as_two_units_of_what_is_shown(
    other: float, shown: bool
) -> None:
    """Of two lids at .8 and a mouth that the face lacks, half is shown up to a mouth of 1.6."""
    units = {"eyeBlinkLeft": 0.8, "eyeBlinkRight": 0.8, "mouthPucker": other}
    table = {"expressed": {"X": units}, "not_expressed": {}}
    assert ("X" in map_face(["Blink"], {}, DATA, table, {}).expressed) == shown
