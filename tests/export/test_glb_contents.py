"""What a GLB says, array for array, told by a reader that shares nothing with the writer."""

from __future__ import annotations

import re
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from glb_arrays import GlbArrays
from numpy.typing import NDArray
from small_rig import SMALL, SmallRig, tumbling

from azee.clip.clip import Clip
from azee.export.formats.glb import write_glb
from azee.export.formats.gltf.document import COMPONENT_TYPES, Document
from azee_rig.mesh import BodyMesh
from azee_rig.rig import Rig
from azee_rig.skeleton import Skeleton


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> GlbArrays:
    path = tmp_path_factory.mktemp("contents") / "small.glb"
    write_glb(tumbling(), SMALL, path)
    return GlbArrays.read(path)


def _still(rig: Rig) -> Clip:
    rest = rig.coordinates.idle
    return Clip(np.array([0.0, 1.0]), np.stack([rest, rest]), (), np.zeros((2, 0)))


def _primitives(file: GlbArrays) -> list[dict[str, Any]]:
    (mesh,) = file.document["meshes"]
    primitives: list[dict[str, Any]] = mesh["primitives"]
    return primitives


def _used(mesh: BodyMesh, part: int) -> NDArray[np.int64]:
    at = mesh.parts[part]
    return np.unique(mesh.triangles[at.start : at.stop])


def test_the_hierarchy_is_the_skeletons(small: GlbArrays) -> None:
    skeleton = SMALL.skeleton
    found = small.joints()
    assert list(found) == list(skeleton.names)
    for j, (name, (parent, offset, inverse)) in enumerate(found.items()):
        up = int(skeleton.parents[j])
        assert parent == (skeleton.names[up] if up >= 0 else ""), name
        assert np.allclose(offset, skeleton.offsets[j], atol=1e-7), name
        expected = np.eye(4)
        expected[:3, 3] = -skeleton.rest_positions[j]
        assert np.allclose(inverse, expected, atol=1e-6), name
    (scene,) = small.document["scenes"]
    roots = [small.document["nodes"][node]["name"] for node in scene["nodes"]]
    assert roots == ["root", "small_mesh"]


def test_the_skin_hangs_on_the_root_and_the_mesh_begins_without_any_unit(
    small: GlbArrays,
) -> None:
    (skin,) = small.document["skins"]
    assert small.document["nodes"][skin["skeleton"]]["name"] == "root"
    assert [node["skin"] for node in small.document["nodes"] if "mesh" in node] == [0]
    (mesh,) = small.document["meshes"]
    assert mesh["weights"] == [0.0] * len(SMALL.mesh.units)
    assert mesh["extras"]["targetNames"] == list(SMALL.mesh.units)


def test_the_root_goes_its_way_from_where_it_rests(small: GlbArrays) -> None:
    (told,) = small.document["animations"]
    (channel,) = (c for c in told["channels"] if c["target"]["path"] == "translation")
    assert small.document["nodes"][channel["target"]["node"]]["name"] == "root"
    found = small.array(told["samplers"][channel["sampler"]]["output"])
    way = tumbling().coordinates[:, :3] + SMALL.skeleton.offsets[0]
    assert np.allclose(found, way, atol=1e-6)


def test_of_the_two_quaternions_of_a_turn_the_one_of_less_than_half_a_turn_comes_first(
    small: GlbArrays, tmp_path: Path
) -> None:
    clip = tumbling()
    other = clip.coordinates.copy()
    other[:, 3:] *= -1.0
    write_glb(replace(clip, coordinates=other), SMALL, tmp_path / "other.glb")
    again = GlbArrays.read(tmp_path / "other.glb")
    (told,) = small.document["animations"]
    compared = 0
    for channel, other_channel in zip(
        told["channels"], again.document["animations"][0]["channels"], strict=True
    ):
        assert channel["target"] == other_channel["target"]
        rows, others = (
            file.array(file.document["animations"][0]["samplers"][c["sampler"]]["output"])
            for file, c in ((small, channel), (again, other_channel))
        )
        assert np.allclose(rows, others, atol=1e-6)
        if channel["target"]["path"] == "rotation":
            assert rows[0, 3] >= 0.0
            compared += 1
    assert compared == 5


def test_bounds_are_told_where_readers_look_for_them(small: GlbArrays) -> None:
    """Of places, of their changes and of times, and truly; nothing else needs the room."""
    bounded = [p["attributes"]["POSITION"] for p in _primitives(small)]
    bounded += [t["POSITION"] for p in _primitives(small) for t in p["targets"]]
    bounded += [s["input"] for a in small.document["animations"] for s in a["samplers"]]
    assert len(bounded) > 8
    for number in bounded:
        accessor, rows = small.document["accessors"][number], small.array(number)
        assert accessor["min"] == pytest.approx(rows.min(axis=0).tolist(), abs=1e-6)
        assert accessor["max"] == pytest.approx(rows.max(axis=0).tolist(), abs=1e-6)
    others = [a for n, a in enumerate(small.document["accessors"]) if n not in bounded]
    assert others
    assert not any("min" in accessor or "max" in accessor for accessor in others)


@pytest.mark.parametrize(
    ("rows", "least", "largest"),
    [([0, 1], [1, 2, -4], [3, 5, -1]), ([0, 2], [0, 0, -4], [3, 5, 0])],
)
def test_bounds_count_the_zeros_of_rows_that_are_not_written(
    rows: list[int], least: list[float], largest: list[float]
) -> None:
    document = Document("test")
    values = np.array([[1, 5, -4], [3, 2, -1]], np.float32)
    document.sparse_accessor(rows[-1] + 1, np.array(rows), values, bounds=True)
    (accessor,) = document.objects["accessors"]
    assert (accessor["min"], accessor["max"]) == (least, largest)


@pytest.mark.parametrize(("count", "kind"), [(3, "uint16"), (70_000, "uint32")])
def test_rows_are_counted_in_as_few_bytes_as_hold_them(count: int, kind: str) -> None:
    document = Document("test")
    document.sparse_accessor(count, np.array([0, count - 1]), np.ones((2, 3), np.float32))
    (accessor,) = document.objects["accessors"]
    indices = accessor["sparse"]["indices"]
    assert indices["componentType"] == COMPONENT_TYPES[kind]
    start = document.objects["bufferViews"][indices["bufferView"]]["byteOffset"]
    assert np.frombuffer(document.buffer, kind, 2, start).tolist() == [0, count - 1]


def test_a_single_row_of_zeros_is_written_out() -> None:
    document = Document("test")
    document.sparse_accessor(1, np.empty(0, np.intp), np.empty((0, 3), np.float32))
    (accessor,) = document.objects["accessors"]
    assert accessor["bufferView"] == 0
    assert np.frombuffer(document.buffer, np.float32, 3).tolist() == [0.0, 0.0, 0.0]


def test_every_view_begins_at_a_multiple_of_four_bytes() -> None:
    document = Document("test")
    for count in (1, 2, 3, 4, 5, 1):
        document.accessor(np.ones(count, np.uint8))
    views = document.objects["bufferViews"]
    assert [view["byteLength"] for view in views] == [1, 2, 3, 4, 5, 1]
    assert [view["byteOffset"] for view in views] == [0, 4, 8, 12, 16, 24]
    assert len(document.buffer) == 28


def test_every_vertex_hangs_on_its_joints(small: GlbArrays) -> None:
    mesh = SMALL.mesh
    assert len([*_primitives(small)]) == len(mesh.parts) > 1
    for number, primitive in enumerate(_primitives(small)):
        attributes = primitive["attributes"]
        used = _used(mesh, number)
        dense = np.zeros((len(used), mesh.joint_count))
        for i in range(4):
            if f"JOINTS_{i}" in attributes:
                joints = small.array(attributes[f"JOINTS_{i}"]).astype(int)
                weights = small.array(attributes[f"WEIGHTS_{i}"])
                np.add.at(dense, (np.arange(len(used))[:, None], joints), weights)
        assert np.abs(dense - mesh.dense_weights[used]).max() < 1e-4
        assert np.abs(dense.sum(axis=1) - 1.0).max() < 1e-12
        assert np.allclose(small.array(attributes["POSITION"]), mesh.vertices[used], atol=1e-6)
        assert np.allclose(small.array(attributes["NORMAL"]), mesh.normals[used], atol=1e-6)
        colours = small.array(attributes["COLOR_0"])
        assert np.allclose(colours[:, :3], mesh.colours[used], atol=1e-4)
        corners = small.array(primitive["indices"]).reshape(-1, 3)
        part = mesh.parts[number]
        assert np.array_equal(used[corners], mesh.triangles[part.start : part.stop])


class ManyJoints(SmallRig):
    """The small body on 300 joints; vertices hang on the last ones."""

    skeleton = Skeleton(
        (*SMALL.skeleton.names, *(f"more {n}" for n in range(6, 300))),
        np.r_[SMALL.skeleton.parents, np.zeros(294, dtype=np.int64)],
        np.vstack([SMALL.skeleton.offsets, np.full((294, 3), 0.01)]),
    )

    @property
    def mesh(self) -> BodyMesh:
        mesh = super().mesh
        return replace(mesh, joints=299 - mesh.joints, joint_count=300)


def test_joints_beyond_256_keep_their_numbers(tmp_path: Path) -> None:
    rig = ManyJoints()
    rest = np.tile(np.r_[np.zeros(3), np.tile([1.0, 0.0, 0.0, 0.0], 300)], (2, 1))
    write_glb(Clip(np.arange(2) / 25, rest, (), np.zeros((2, 0))), rig, tmp_path / "many.glb")
    file = GlbArrays.read(tmp_path / "many.glb")
    for number, primitive in enumerate(_primitives(file)):
        joints = file.array(primitive["attributes"]["JOINTS_0"]).astype(int)
        weights = file.array(primitive["attributes"]["WEIGHTS_0"])
        dense = rig.mesh.dense_weights[_used(rig.mesh, number)]
        rows = np.arange(len(joints))[:, None]
        assert np.abs(dense[rows, joints] - weights)[weights > 0].max() < 1e-4
        assert joints.max() > 255


def test_every_target_moves_what_its_unit_moves(small: GlbArrays) -> None:
    mesh = SMALL.mesh
    moved = 0
    for number, primitive in enumerate(_primitives(small)):
        used = _used(mesh, number)
        assert len(primitive["targets"]) == len(mesh.units)
        for unit, target in zip(mesh.units, primitive["targets"], strict=True):
            rows, deltas = mesh.unit(unit)
            expected = np.zeros((len(mesh.vertices), 3))
            expected[rows] = deltas
            found = small.array(target["POSITION"])
            assert np.allclose(found, expected[used], atol=1e-7), unit
            moved += int(np.abs(found).max() > 0.0)
            weight = np.array([float(name == unit) for name in mesh.units])
            turned = replace(mesh, vertices=mesh.shaped(weight)).normals - mesh.normals
            assert np.abs(small.array(target["NORMAL"]) - turned[used]).max() < 3e-3, unit
    assert moved == sum(len(mesh.unit(unit)[0]) > 0 for unit in mesh.units) > 0


def test_every_array_has_data(small: GlbArrays) -> None:
    accessors = small.document["accessors"]
    assert all("bufferView" in a or "sparse" in a for a in accessors)
    plain = [t["POSITION"] for p in _primitives(small) for t in p["targets"]]
    still = [n for n in plain if "sparse" not in accessors[n]]
    assert still
    views = {accessors[n]["bufferView"] for n in still}
    assert len(views) == 1
    view = small.document["bufferViews"][views.pop()]
    assert view["byteStride"] == 12
    assert not any(small.binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]])
    for number in still:
        assert accessors[number]["count"] * 12 <= view["byteLength"]
        assert accessors[number]["min"] == accessors[number]["max"] == [0.0, 0.0, 0.0]


def test_cloth_has_two_sides(small: GlbArrays) -> None:
    assert [m["name"] for m in small.document["materials"]] == ["sleeve", "skin"]
    assert all(m["doubleSided"] for m in small.document["materials"])


def test_labels_and_keys_count_from_the_start_of_the_clip(tmp_path: Path) -> None:
    clip = tumbling()
    later = replace(
        clip,
        times=clip.times + 2.5,
        labels=tuple(
            replace(label, start_s=label.start_s + 2.5, end_s=label.end_s + 2.5)
            for label in clip.labels
        ),
    )
    write_glb(clip, SMALL, tmp_path / "a.glb")
    write_glb(later, SMALL, tmp_path / "b.glb")
    first, second = (GlbArrays.read(tmp_path / f"{name}.glb") for name in "ab")
    (told,) = second.document["animations"]
    assert told["extras"] == first.document["animations"][0]["extras"]
    assert told["extras"]["labels"][0]["start_s"] == 0.0
    third = replace(clip.labels[0], start_s=1 / 3, end_s=2 / 3)
    write_glb(replace(clip, labels=(third,)), SMALL, tmp_path / "c.glb")
    (label,) = GlbArrays.read(tmp_path / "c.glb").document["animations"][0]["extras"]["labels"]
    assert (label["start_s"], label["end_s"]) == (0.333333, 0.666667)  # to a microsecond
    for sampler in told["samplers"]:
        times = second.array(sampler["input"])[:, 0]
        assert times[0] == 0.0
        assert times[-1] <= clip.times[-1] - clip.times[0] + 1e-6


@pytest.mark.parametrize("last", [0.4, 1.0])
def test_what_only_sinks_or_only_rises_has_a_key_per_frame(last: float, tmp_path: Path) -> None:
    """All else is at rest, so that nothing else in the same channel tells that it moves."""
    rest = np.tile(np.r_[np.zeros(3), np.tile([1.0, 0.0, 0.0, 0.0], 6)], (5, 1))
    weights = np.linspace(0.7, last, 5)[:, None]
    clip = Clip(np.arange(5) / 25, rest, ("blink",), weights)
    write_glb(clip, SMALL, tmp_path / "one.glb")
    file = GlbArrays.read(tmp_path / "one.glb")
    (told,) = file.document["animations"]
    (channel,) = (c for c in told["channels"] if c["target"]["path"] == "weights")
    sampler = told["samplers"][channel["sampler"]]
    assert file.array(sampler["input"])[:, 0] == pytest.approx(np.arange(5) / 25)
    found = file.array(sampler["output"]).reshape(5, -1)
    assert found.max(axis=1) == pytest.approx(weights[:, 0])


@pytest.mark.slow
def test_assimp_reads_the_whole_body(assimp: str, signer: Rig, tmp_path: Path) -> None:
    path = tmp_path / "signer.glb"
    write_glb(_still(signer), signer, path)
    shown = subprocess.run([assimp, "info", path], capture_output=True, text=True, check=False)
    assert shown.returncode == 0, shown.stdout
    rows = re.findall(r"^([A-Z][a-z ]+\w):? +(.+)$", shown.stdout, re.MULTILINE)
    told = dict(reversed(rows))
    mesh = signer.mesh
    assert int(told["Meshes"]) == len(mesh.parts)
    assert int(told["Faces"]) == len(mesh.triangles)
    assert int(told["Vertices"]) == sum(len(_used(mesh, n)) for n in range(len(mesh.parts)))
    assert int(told["Nodes"]) >= len(signer.skeleton.names) + 1
    assert int(told["Animations"]) == 1
    for name, expected in (
        ("Minimum point", mesh.vertices.min(axis=0)),
        ("Maximum point", mesh.vertices.max(axis=0)),
    ):
        numbers = [float(x) for x in told[name].strip("()").split()]
        assert np.allclose(numbers, expected, atol=1e-5), name
