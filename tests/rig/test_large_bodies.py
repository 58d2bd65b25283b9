"""Bodies that cost much: thousands of joints, and skin that follows none of them."""

from __future__ import annotations

import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from body_families import make_body
from joint_names import FAMILIES

from azee_rig.build import riding
from azee_rig.importing import skeleton_tree
from azee_rig.importing.container import read_gltf
from azee_rig.importing.importer import import_body, propose_bones
from azee_rig.importing.scene import read_scene
from azee_rig.importing.skeleton_tree import nearest_of


def test_the_nearest_of_many_places_is_found_piece_by_piece(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    random = np.random.default_rng(5)
    points, places = random.normal(size=(50, 3)), random.normal(size=(31, 3))
    gaps = np.linalg.norm(points[:, None] - places[None], axis=2)
    for at_once in (1, 31, 100, 10_000):
        monkeypatch.setattr(skeleton_tree, "AT_ONCE", at_once)
        found, away = nearest_of(points, places)
        assert np.array_equal(found, gaps.argmin(axis=1))
        assert np.allclose(away, gaps.min(axis=1))


@pytest.mark.slow
@pytest.mark.parametrize("chained", [True, False])
def test_five_thousand_joints_take_little_room(tmp_path: Path, chained: bool) -> None:
    body = make_body(FAMILIES["vroid"])
    file = body.file()
    for number in range(len(body.names)):
        file.nodes[number]["name"] = f"joint {number}"
    head = last = body.names.index("J_Bip_C_Head")
    for number in range(5000):
        file.nodes.append(
            {
                "name": f"hair {number}",
                "translation": [0.001 * (number * 7 % 13 - 6), 0.001, 0.0005 * (number % 5)],
            }
        )
        file.nodes[last].setdefault("children", []).append(len(file.nodes) - 1)
        last = len(file.nodes) - 1 if chained or number % 20 < 19 else head
    path = file.write(tmp_path / "many.glb")
    tracemalloc.start()
    found = propose_bones(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert found.lacking == ()
    assert peak < 150e6, "an array of joints by joints takes 600 MB"


def test_vertices_without_weight_follow_the_nearest_joint(tmp_path: Path) -> None:
    body = make_body(FAMILIES["vroid"])
    loose = replace(body, weights=np.where(np.arange(len(body.vertices))[:, None] % 7, 1.0, 0.0))
    weights = body.weights * loose.weights
    bare = weights.sum(axis=1) <= 0.0
    weights[bare] = 1e-12
    file = replace(body, weights=weights).file()
    primitive = file.document["meshes"][0]["primitives"][0]
    accessor = file.document["accessors"][primitive["attributes"]["WEIGHTS_0"]]
    start = file.document["bufferViews"][accessor["bufferView"]]["byteOffset"]
    rows = np.frombuffer(file.binary, np.float32, 4 * len(bare), start).reshape(-1, 4).copy()
    rows[bare] = 0.0
    file.binary = file.binary[:start] + rows.tobytes() + file.binary[start + rows.nbytes :]
    scene = read_scene(read_gltf(file.write(tmp_path / "bare.glb")))
    parts = len(file.document["meshes"][0]["primitives"])
    assert f"{parts * int(bare.sum())} vertices have no weight" in " ".join(scene.notes)
    gaps = np.linalg.norm(body.vertices[bare][:, None] - body.places[None], axis=2)
    (at,) = np.nonzero(bare)
    followed = [scene.joints[j] for j in scene.influences[at, 0]]
    assert followed == [body.names[j] for j in gaps.argmin(axis=1)]


@pytest.mark.slow
def test_a_ball_for_a_body_tries_few_sets_of_nodes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    body = make_body(FAMILIES["vroid"])
    ball = trimesh.creation.icosphere(3, 0.85)
    vertices = ball.vertices * (1.05, 1.0, 0.4) + (0.0, 0.9, 0.0)
    away = np.linalg.norm(vertices[:, None] - body.places[None], axis=2)
    round_one = replace(
        body,
        vertices=vertices,
        triangles=np.asarray(ball.faces),
        weights=(away + 0.02) ** -3.0,
        parts=[("skin", 0, len(ball.faces))],
        units={},
    )
    fits: list[int] = []
    fitted = riding._Sum.fitted

    def counted(self: riding._Sum, columns: tuple[int, ...], rigid: riding.Floats) -> object:
        fits.append(len(self.columns))
        return fitted(self, columns, rigid)

    monkeypatch.setattr(riding._Sum, "fitted", counted)
    made = import_body(round_one.file().write(tmp_path / "ball.glb"), "ball")
    assert max(fits) > riding.MANY + 1, "some site has many nodes to choose from"
    assert len(fits) < 60 * len(made.rig.sites)
