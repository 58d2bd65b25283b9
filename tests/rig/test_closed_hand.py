"""A closed hand on the mesh itself: fingers lie on the palm and do not pass through it."""

from __future__ import annotations

import numpy as np
import pytest
from capsule_gaps import POSTURES, posture
from numpy.typing import NDArray
from scipy.interpolate import LinearNDInterpolator

from azee_rig.rig import Rig
from azee_solver.handshape import straight

Floats = NDArray[np.float64]
FINGERS = {"index": 2, "middle": 3, "ring": 4, "little": 5}


def depths(rig: Rig, q: Floats) -> dict[str, float]:
    """How far each finger's skin lies behind the palm's, metres; negative in front of it."""
    mesh, names = rig.mesh, rig.skeleton.names
    frames = rig.chain.frames(q)
    node = rig.bones["palm_R"].node
    local = (rig.skin(rig.pose(q)) - frames.positions[node]) @ frames.rotations[node]
    skin = next(p for p in mesh.parts if p.name == "skin")
    used = np.unique(mesh.triangles[skin.start : skin.stop])

    def share(*starts: str) -> Floats:
        columns = [j for j, n in enumerate(names) if n.startswith(starts) and n.endswith(".R")]
        return np.asarray(mesh.dense_weights[used][:, columns].sum(axis=1))

    bind = rig.chain.frames(rig.coordinates.bind).rotations[node]
    faces_out = (mesh.normals[used] @ bind)[:, 2] > 0.3
    palm = used[(share("wrist", "carpus") > 0.6) & faces_out]
    height = LinearNDInterpolator(local[palm][:, :2], local[palm][:, 2])
    found = {}
    for finger, number in FINGERS.items():
        rows = used[share(f"finger{number}-2", f"finger{number}-3") > 0.9]
        below = height(local[rows][:, :2]) - local[rows][:, 2]
        found[finger] = float(np.nanmax(below)) if np.isfinite(below).any() else -np.inf
    return found


def test_a_fist_lies_on_the_palm(signer: Rig) -> None:
    fist = depths(signer, posture(signer, POSTURES["hands"]["fist"]))
    assert max(fist.values()) < 0.003
    assert min(fist.values()) > -0.008, "and is closed"


@pytest.mark.parametrize("morphs", [("bend", "hook"), ("closed",)])
def test_morphs_close_a_hand_without_passing_through_it(
    signer: Rig, morphs: tuple[str, ...]
) -> None:
    q = posture(signer)
    for finger in FINGERS:
        for k in (1, 2, 3):
            name = f"{finger}_R_{k}.flexion"
            q[signer.coordinates.index[name]] = straight(name)
        for morph in morphs:
            for name, angle in signer.skeletal_morphs[f"{finger}_{morph}_R"].items():
                q[signer.coordinates.index[name]] += angle
    assert max(depths(signer, q).values()) < 0.005


def test_the_measure_sees_a_finger_in_the_palm(signer: Rig) -> None:
    through = {f"{f}_R_{k}.flexion": a for f in FINGERS for k, a in ((1, 88), (2, 100), (3, 70))}
    assert max(depths(signer, posture(signer, through)).values()) > 0.01
