"""Bodies of many makers: their joints are told right, whatever their posture, unit and axes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from body_families import Body, declare, make_body, with_sleeves
from joint_names import FAMILIES, Family

import azee
from azee.quality.outcome import misses
from azee_rig.importing.bone_map import BONES
from azee_rig.importing.folder import write_folder
from azee_rig.importing.importer import import_body, propose_bones
from azee_rig.importing.names import Reading, read_name, read_names

EXAMPLES = Path(__file__).parents[2] / "examples"
POSES = [("t", "y", 1.0), ("a", "z", 0.01)]
"""Posture, up axis and unit in metres: in pairs, so that each value is met with every family."""
ARM = ("clav", "arm", "f_arm", "palm")
DIGITS = ("thumb", "index", "middle", "ring", "little")


def _assert_found(body: Body, path: Path, family: str = "names") -> None:
    found = propose_bones(path)
    assert found.family == family
    rest = dict(found.bones)
    back = rest.pop("back_1", ()) + rest.pop("back_2")
    assert rest == body.bones
    assert {"neck", "head", *(f"{b}_{s}" for b in ARM for s in "LR")} <= rest.keys()
    assert 2 <= len(back) <= 5
    assert back == body.names[1 : 1 + len(back)]
    assert found.root == body.names[0]
    assert len(found.kept) == 6


@pytest.mark.parametrize("family", FAMILIES.values(), ids=FAMILIES)
def test_every_joint_is_told_by_its_name(family: Family, tmp_path: Path) -> None:
    for pose, up, unit in POSES:
        for fingers in (True, False):
            body = make_body(family, fingers=fingers, eyes=fingers, pose=pose)
            digits = [bone for bone in body.bones if bone.startswith(DIGITS)]
            assert len(digits) == (2 * 5 * 3 if fingers else 0)
            path = body.file(unit=unit, up=up).write(tmp_path / "body.glb")
            _assert_found(body, path)


@pytest.mark.parametrize("version", [0, 1])
def test_a_vrm_tells_its_joints_itself(version: int, tmp_path: Path) -> None:
    for fingers in (True, False):
        body = make_body(FAMILIES["vroid"], fingers=fingers)
        file = declare(body.file(), body, version)
        number = {n: i for i, n in enumerate(body.names)}
        for node in file.nodes:
            if node["name"] in number:
                node["name"] = f"joint {number[node['name']]}"
        found = propose_bones(file.write(tmp_path / "body.vrm"))
        assert found.family == "VRM"
        assert len(body.bones) > (40 if fingers else 9)
        assert {bone: found.bones.get(bone) for bone in body.bones} == {
            bone: tuple(f"joint {number[j]}" for j in chain) for bone, chain in body.bones.items()
        }


@pytest.mark.parametrize("prefix", ["Anna_", "R2D2_", "Hero 01 ", "npc.Hair.", "Hand_", "cloth"])
@pytest.mark.parametrize("name", ["mixamo", "motive", "makehuman", "smpl-x"])
def test_prefixes_of_any_kind_are_taken_off(name: str, prefix: str, tmp_path: Path) -> None:
    body = make_body(FAMILIES[name], prefix=prefix if name != "mixamo" else f"{prefix}:")
    _assert_found(body, body.file().write(tmp_path / "body.glb"))


def test_a_word_that_few_joints_share_is_no_prefix() -> None:
    names = ["Hips", "Spine", "Neck", "Head", "Hat_Head", "LeftArm", "LeftForeArm", "LeftHand"]
    readings = read_names(names)
    assert readings == [read_name(name) for name in names]
    assert readings[4] == Reading("", "", "")


@pytest.mark.slow
def test_arms_held_out_make_no_wider_trunk(tmp_path: Path) -> None:
    widths = []
    for pose in "ta":
        path = make_body(FAMILIES["mixamo"], pose=pose).file().write(tmp_path / "body.glb")
        capsules = import_body(path, pose).rig.capsules
        trunk = [k for k, name in enumerate(capsules.names) if name.startswith("trunk_")]
        widths.append(capsules.b[trunk, 0] + capsules.radius[trunk])
    held_out, lowered = widths
    np.testing.assert_allclose(held_out, lowered, atol=0.006)


@pytest.mark.slow
def test_capsules_are_fitted_to_arms_not_to_wide_sleeves(tmp_path: Path) -> None:
    bare = make_body(FAMILIES["mixamo"])
    radii = []
    for body in (bare, with_sleeves(bare, 2.5)):
        capsules = import_body(body.file().write(tmp_path / "body.glb"), "body").rig.capsules
        radii.append({n: float(capsules.radius[k]) for k, n in enumerate(capsules.names)})
    plain, dressed = radii
    assert {n for n in plain if abs(dressed[n] - plain[n]) > 1e-9} == {"forearm_L", "forearm_R"}
    for side in "LR":
        assert dressed[f"forearm_{side}"] == pytest.approx(plain[f"forearm_{side}"], rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("widest", [1.0, 4.0])
@pytest.mark.parametrize("pose", ["t", "a"])
def test_what_the_signer_meets_is_met_in_wide_sleeves_too(
    pose: str, widest: float, tmp_path: Path
) -> None:
    body = with_sleeves(make_body(FAMILIES["mixamo"], pose=pose), widest)
    path = body.file().write(tmp_path / "body.glb")
    write_folder(import_body(path, "body"), tmp_path / "body")
    made = azee.compile(EXAMPLES / "tree" / "tree.azee", tmp_path / "body", life=False)
    # The published thumb cannot be met by anybody: its other side would be 95 degrees off.
    (missed,) = misses(made.report)
    assert missed.subject == "orient 'nrm !thumb(s, 2)"
    assert missed.residual is not None
    assert np.degrees(missed.residual) < 16.0


@pytest.mark.slow
@pytest.mark.parametrize("name", FAMILIES)
def test_bodies_of_every_family_are_taken_in(name: str, tmp_path: Path) -> None:
    lengths, palms = [], []
    for pose, up, unit in POSES:
        body = make_body(FAMILIES[name], pose=pose)
        path = body.file(unit=unit, up=up, units={"jawOpen": "jawOpen"}).write(tmp_path / "b.glb")
        made = import_body(path, name)
        assert made.report.doubts == ()
        assert made.report.lost_sites == ()
        assert set(made.rig.bones) == set(BONES)
        lengths.append(made.rig.landmarks.arm_m)
        frames = made.rig.chain.frames(made.rig.coordinates.idle)
        palms.append(frames.positions[made.rig.bones["palm_L"].node])
    assert lengths[0] == pytest.approx(lengths[1], abs=1e-5)
    assert np.linalg.norm(palms[0] - palms[1]) < 0.03
