"""Bodies of others become rigs: whatever their names, axes, units; bad ones are refused clearly."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from glb_file import GlbFile

from azee.cli.main import run
from azee.clip.clip import Clip
from azee.export.formats.glb import write_glb
from azee_rig.importing.bone_map import BONES
from azee_rig.importing.fault import BodyError
from azee_rig.importing.importer import import_body, propose_bones
from azee_rig.importing.names import read_name
from azee_rig.load import load_rig
from azee_rig.rig import Rig


def _exported(rig: Rig, folder: Path) -> GlbFile:
    c = rig.coordinates
    still = Clip(np.array([0.0, 1.0]), np.stack([c.idle, c.idle]), (), np.zeros((2, 0)))
    write_glb(still, rig, folder / "body.glb")
    return GlbFile.read(folder / "body.glb")


@pytest.fixture(scope="module")
def game_file(tmp_path_factory: pytest.TempPathFactory) -> GlbFile:
    """The body of a game, as a file."""
    return _exported(load_rig("game"), tmp_path_factory.mktemp("game"))


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("mixamorig:LeftForeArm", "f_arm L"),
        ("mixamorig9:RightHandThumb2", "digit R thumb"),
        ("lowerarm_l", "f_arm L"),
        ("DEF-upper_arm.R.001", "arm R"),
        ("J_Bip_L_UpperArm", "arm L"),
        ("J_Bip_C_UpperChest", "spine "),
        ("Bip01 R Finger12", "finger R 1"),
        ("finger2-3.L", "finger L 2"),
        ("ValveBiped.Bip01_L_Clavicle", "clav L"),
        ("rightLittleProximal", "digit R little"),
        ("lhand", "palm L"),
        ("LeftHandIndex4_end", "digit L index"),
        ("index_metacarpal_r", "digit R index"),
        ("CC_Base_L_Hand", "palm L"),
        ("hand_ik_l", " L"),
        ("LeftEyeLid", " L"),
        ("Sphere.003", " "),
    ],
)
def test_names_of_many_families(name: str, said: str) -> None:
    r = read_name(name)
    assert f"{r.kind} {r.side} {r.digit}".strip() == said.strip()


@pytest.mark.slow
def test_our_own_body_comes_back(signer: Rig, tmp_path: Path) -> None:
    _exported(signer, tmp_path)
    made = import_body(tmp_path / "body.glb", "again")
    assert made.report.family == "names"
    assert made.report.without == ()
    assert set(made.rig.sites) == set(signer.sites)
    assert set(made.rig.face_morphs) == set(signer.face_morphs)
    ours, theirs = (r.joint_positions(r.pose(r.coordinates.bind)) for r in (signer, made.rig))
    for name, place in zip(made.rig.skeleton.names, theirs, strict=True):
        at = ours[signer.skeleton.names.index(name)]
        assert np.linalg.norm(place - at) < 1e-5, name
    at_bind = [r.chain.frames(r.coordinates.bind) for r in (signer, made.rig)]
    for name, site in made.rig.sites.items():
        off = signer.sites[name].point(at_bind[0]) - site.point(at_bind[1])
        assert np.linalg.norm(off) < 0.003, name


def _nameless(file: GlbFile) -> None:
    for number, node in enumerate(file.nodes):
        node["name"] = f"node {number}"


def _turned(file: GlbFile) -> None:
    """Hang the skeleton on a node that turns and scales it and takes it elsewhere."""
    half = math.sqrt(0.5)
    scene = file.document["scenes"][0]["nodes"]
    root = next(n for n in scene if "skin" not in file.nodes[n])
    file.nodes.append({"children": [root], "scale": [100.0] * 3, "rotation": [half, 0, 0, half],
                       "translation": [300.0, 5.0, -70.0]})  # fmt: skip
    scene[scene.index(root)] = len(file.nodes) - 1


def _declared(file: GlbFile) -> None:
    """Take the names away and declare the bones as a VRM does."""
    words = {"hips": "pelvis", "spine": "spine_01", "chest": "spine_02", "upperChest": "spine_03",
             "neck": "neck_01", "head": "head"}  # fmt: skip
    for side, s in (("left", "l"), ("right", "r")):
        for word, name in (("Shoulder", "clavicle"), ("UpperArm", "upperarm"),
                           ("LowerArm", "lowerarm"), ("Hand", "hand")):  # fmt: skip
            words[f"{side}{word}"] = f"{name}_{s}"
        for word, name in (("Thumb", "thumb"), ("Index", "index"), ("Middle", "middle"),
                           ("Ring", "ring"), ("Little", "pinky")):  # fmt: skip
            thirds = ("Metacarpal", "Proximal", "Distal")
            parts = thirds if word == "Thumb" else ("Proximal", "Intermediate", "Distal")
            for k, part in enumerate(parts, 1):
                words[f"{side}{word}{part}"] = f"{name}_{k:02}_{s}"
    number = {node["name"]: i for i, node in enumerate(file.nodes)}
    bones = {word: {"node": number[name]} for word, name in words.items()}
    file.document["extensions"] = {"VRMC_vrm": {"humanoid": {"humanBones": bones}}}
    file.document["extensionsUsed"] = ["VRMC_vrm"]
    _nameless(file)


@pytest.mark.parametrize(
    ("change", "family"), [(_nameless, "shape"), (_declared, "VRM"), (_turned, "names")]
)
def test_the_same_bones_are_found(
    game_file: GlbFile, tmp_path: Path, change: Callable[[GlbFile], None], family: str
) -> None:
    plain = propose_bones(game_file.write(tmp_path / "plain.glb"))
    file = game_file.copy()
    change(file)
    found = propose_bones(file.write(tmp_path / "changed.glb"))
    assert found.family == family
    names = [node["name"] for node in game_file.nodes]
    called = {node.get("name"): name for node, name in zip(file.nodes, names, strict=False)}
    for bone in BONES:
        if not bone.startswith("eye"):
            chain = tuple(called[j] for j in found.bones.get(bone, ()))
            assert chain == plain.bones.get(bone, ()), bone


@pytest.mark.slow
def test_units_axes_and_a_turned_root_do_not_matter(game_file: GlbFile, tmp_path: Path) -> None:
    file = game_file.copy()
    _turned(file)
    made = import_body(file.write(tmp_path / "turned.glb"), "turned")
    assert any("turned by 90°" in note for note in made.report.notes)
    assert any("taken for cm" in note for note in made.report.notes)
    game = load_rig("game")
    q = game.coordinates.idle
    assert made.rig.landmarks.arm_m == pytest.approx(game.landmarks.arm_m, abs=1e-5)
    at, there = (r.chain.frames(q) for r in (game, made.rig))
    for name in ("PA_L", "I_TIP_R", "EL_R", "CH", "NO"):
        a = game.sites[name].point(at) - game.landmarks.shoulder_middle
        b = made.rig.sites[name].point(there) - made.rig.landmarks.shoulder_middle
        assert np.linalg.norm(a - b) < 0.001, name


@pytest.mark.slow
def test_a_corrected_map_is_used_and_fingers_that_are_not_there_are_refused(
    game_file: GlbFile, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    body = game_file.write(tmp_path / "body.glb")
    proposal, folder = tmp_path / "map.json", tmp_path / "mitten"
    assert run(["rig", "import", str(body), "--propose", str(proposal)]) == 0
    bones = json.loads(proposal.read_text(encoding="utf-8"))
    for bone in BONES:
        if bone.startswith(("thumb", "index", "middle", "ring", "little")):
            bones["bones"][bone] = []
    bones["tips"] = {}
    proposal.write_text(json.dumps(bones), encoding="utf-8")
    command = ["rig", "import", str(body), "-o", str(folder), "--map", str(proposal)]
    assert run(command) == 0
    assert "no fingers on the left hand" in capsys.readouterr().err
    rig = load_rig(folder)
    assert "index_R_1" not in rig.bones
    assert "I_TIP_R" not in rig.sites
    assert "PA_R" in rig.sites
    text = tmp_path / "text.azee"
    text.write_text("key 1 (place @I_TIP(s) @CH)\n", encoding="utf-8")
    assert run(["check", "--rig", str(folder), str(text), "--strict-body"]) == 1
    assert "error[rig-lacks-site]" in capsys.readouterr().err
    both = "key .2\n    cstr\n        place @PA(s) ^Mssp\n        place @I_TIP(s) @CH\n"
    text.write_text(both, encoding="utf-8")
    outputs = ["-o", str(tmp_path / "x.npz"), "--report", str(tmp_path / "r.json")]
    assert run(["compile", str(text), "--rig", str(folder), *outputs]) == 0
    assert "warning[rig-lacks-site]" in capsys.readouterr().err
    report = json.loads((tmp_path / "r.json").read_text(encoding="utf-8"))
    assert [(row["code"], row["message"].count("`@I_TIP(s)`")) for row in report["left_out"]] == [
        ("rig-lacks-site", 1)
    ]
    assert [c["met"] for c in report["constraints"]] == [True]


def _no_skin(file: GlbFile) -> None:
    del file.document["skins"]


def _own_ancestor(file: GlbFile) -> None:
    file.nodes[5].setdefault("children", []).append(0)


def _compressed(file: GlbFile) -> None:
    file.document["extensionsRequired"] = ["KHR_draco_mesh_compression"]


def _old(file: GlbFile) -> None:
    file.document["asset"]["version"] = "1.0"


def _beyond(file: GlbFile) -> None:
    file.document["accessors"][0]["count"] = 10**9


def _no_such_accessor(file: GlbFile) -> None:
    file.document["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 10**6


def _headless(file: GlbFile) -> None:
    for number, node in enumerate(file.nodes):
        node["name"] = f"part {number}"
        node.pop("children", None)
    root = next(n for n in range(len(file.nodes)) if "skin" not in file.nodes[n])
    joints = [n for n in range(len(file.nodes)) if "skin" not in file.nodes[n] and n != root]
    file.nodes[root]["children"] = joints
    file.document["scenes"][0]["nodes"] = [root]


@pytest.mark.parametrize(
    ("change", "code", "said"),
    [
        (_no_skin, "body-incomplete", "no skin"),
        (_own_ancestor, "body-unreadable", "ancestor|two parents"),
        (_compressed, "body-unsupported", "Draco"),
        (_old, "body-unsupported", "glTF 1.0"),
        (_beyond, "body-unreadable", "do not fit"),
        (_no_such_accessor, "body-unreadable", "there is no 1000000 in `accessors`"),
        (_headless, "body-incomplete", "no joints were found for `head`"),
    ],
)
def test_a_bad_body_has_one_clear_message(
    game_file: GlbFile,
    tmp_path: Path,
    change: Callable[[GlbFile], None],
    code: str,
    said: str,
) -> None:
    file = game_file.copy()
    change(file)
    with pytest.raises(BodyError, match=said) as caught:
        import_body(file.write(tmp_path / "bad.glb"), "bad")
    assert caught.value.code == code


@pytest.mark.parametrize("part", [0, 3, 11, 19, 500, 200_000, 2_000_000])
def test_a_file_that_was_cut_off_is_refused(game_file: GlbFile, tmp_path: Path, part: int) -> None:
    path = tmp_path / "cut.glb"
    path.write_bytes(game_file.data()[:part])
    with pytest.raises(BodyError) as caught:
        import_body(path, "cut")
    assert caught.value.code == "body-unreadable"


def test_two_thousand_joints_are_merged(game_file: GlbFile, tmp_path: Path) -> None:
    file = game_file.copy()
    head = next(n for n, node in enumerate(file.nodes) if node["name"] == "head")
    last = head
    for number in range(2000):
        file.nodes.append({"name": f"hair {number}", "translation": [0, 0.001, 0]})
        file.nodes[last].setdefault("children", []).append(len(file.nodes) - 1)
        last = head if number % 20 == 19 else len(file.nodes) - 1
    found = propose_bones(file.write(tmp_path / "many.glb"))
    assert found.lacking == ()
    assert found.bones["head"] == ("head",)


def test_a_body_that_fails_leaves_the_folder_as_it_was(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "notes.glb").write_text("not a body", encoding="utf-8")
    folder = tmp_path / "kept"
    folder.mkdir()
    (folder / "letter.txt").write_text("keep me", encoding="utf-8")
    assert run(["rig", "import", str(tmp_path / "notes.glb"), "-o", str(folder)]) == 1
    assert "body-folder" in capsys.readouterr().err
    assert run(["rig", "import", str(tmp_path / "notes.glb"), "-o", str(tmp_path / "new")]) == 1
    assert "body-unreadable" in capsys.readouterr().err
    assert (
        run(["rig", "import", str(tmp_path / "notes.glb"), "-o", str(tmp_path / "notes.glb")]) == 1
    )
    assert "notes.glb` is a file" in capsys.readouterr().err
    (tmp_path / "notes.glb").write_bytes(b"glTF")
    assert run(["rig", "import", str(tmp_path / "notes.glb"), "-o", str(tmp_path / "new")]) == 1
    assert "notes.glb`: the file ends" in capsys.readouterr().err
    assert sorted(p.name for p in tmp_path.iterdir()) == ["kept", "notes.glb"]
    assert [p.name for p in folder.iterdir()] == ["letter.txt"]
