"""The chain against a second implementation, and the laws of a symmetrical body."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from azee_rig.load import load_rig
from azee_rig.rig import Rig

Floats = NDArray[np.float64]
RIG = load_rig("signer")
BONES = 44
UP, FORWARD, LEFT = np.eye(3)[1], np.eye(3)[2], np.eye(3)[0]
seeds = st.integers(0, 2**32 - 1)


def anywhere(seed: int) -> Floats:
    c = RIG.coordinates
    return np.random.default_rng(seed).uniform(c.lower, c.upper)


def one_by_one(rig: Rig, q: Floats) -> tuple[Floats, Floats]:
    """Forward kinematics with homogeneous matrices and rotation vectors, node by node."""
    chain = rig.chain
    made: list[Floats] = []
    for b, parent in enumerate(chain.parents):
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = chain.zero[b], chain.offsets[b]
        for d in range(chain.dof_start[b], chain.dof_start[b + 1]):
            angle = chain.dof_scale[d] * q[chain.dof_coordinate[d]]
            turn = np.eye(4)
            turn[:3, :3] = Rotation.from_rotvec(angle * np.eye(3)[chain.dof_axis[d]]).as_matrix()
            T = T @ turn
        made.append(T if parent < 0 else made[parent] @ T)
    stacked = np.array(made)
    return stacked[:, :3, 3], stacked[:, :3, :3]


@settings(max_examples=25)
@given(seeds)
def test_the_chain_agrees_with_a_second_implementation(seed: int) -> None:
    q = anywhere(seed)
    frames = RIG.chain.frames(q)
    positions, rotations = one_by_one(RIG, q)
    np.testing.assert_allclose(frames.positions, positions, atol=1e-9)
    np.testing.assert_allclose(frames.rotations, rotations, atol=1e-9)


def test_a_batch_is_its_members() -> None:
    q = np.array([[anywhere(1), anywhere(2)], [anywhere(3), anywhere(4)]])
    together = RIG.chain.frames(q)
    assert together.positions.shape == (2, 2, len(RIG.chain.names), 3)
    alone = RIG.chain.frames(q[1, 0])
    np.testing.assert_allclose(together.rotations[1, 0], alone.rotations, atol=1e-15)


@settings(max_examples=25)
@given(seeds)
def test_joints_of_the_body_are_where_the_chain_puts_them(seed: int) -> None:
    q = anywhere(seed)
    positions = RIG.joint_positions(RIG.pose(q))
    frames = RIG.chain.frames(q)
    assert len(RIG.bones) == BONES
    for bone, nodes in RIG.bones.items():
        joint = next(
            j for j, n in enumerate(RIG.drive.node) if n >= nodes.origin_node and n <= nodes.node
        )
        distance = np.abs(positions[joint] - frames.positions[nodes.origin_node]).max()
        assert distance < 1e-9, bone


@settings(max_examples=25)
@given(seeds)
def test_a_mirrored_posture_gives_the_mirrored_body(seed: int) -> None:
    """But for the mesh's own asymmetry: finger joints differ by a tenth of a millimetre."""
    q = anywhere(seed)
    mirrored = np.array(q)
    for name, i in RIG.coordinates.index.items():
        if "_L" in name or "_R" in name:
            other = name.replace("_L", "_?").replace("_R", "_L").replace("_?", "_R")
            mirrored[RIG.coordinates.index[other]] = q[i]
        if name.endswith((".axial", ".lateral", ".yaw")):
            target = name.replace("_L", "_?").replace("_R", "_L").replace("_?", "_R")
            mirrored[RIG.coordinates.index[target]] = -q[i]
    one, two = RIG.chain.frames(q), RIG.chain.frames(mirrored)
    assert len(RIG.bones) == BONES
    for bone, nodes in RIG.bones.items():
        other = bone.replace("_L", "_?").replace("_R", "_L").replace("_?", "_R")
        there = RIG.bones[other]
        np.testing.assert_allclose(
            one.positions[nodes.origin_node] * (-1, 1, 1),
            two.positions[there.origin_node],
            atol=5e-4,
        )
        for axis in (1, 2):
            np.testing.assert_allclose(
                one.rotations[nodes.node][:, axis] * (-1, 1, 1),
                two.rotations[there.node][:, axis],
                atol=0.02,
            )


def axes(q: Floats, bone: str) -> tuple[Floats, Floats]:
    R = RIG.chain.frames(q).rotations[RIG.bones[bone].node]
    return R[:, 1], R[:, 2]


def test_the_zero_pose_is_the_documented_one() -> None:
    zero = np.zeros(len(RIG.coordinates))
    for bone in ("back_1", "back_2", "neck", "head"):
        np.testing.assert_allclose(axes(zero, bone), (UP, FORWARD), atol=1e-9)
    for side, inward in (("L", -LEFT), ("R", LEFT)):
        np.testing.assert_allclose(axes(zero, f"arm_{side}"), (-UP, FORWARD), atol=1e-9)
        for bone in ("f_arm", "palm"):
            np.testing.assert_allclose(axes(zero, f"{bone}_{side}"), (-UP, inward), atol=1e-9)
        for finger in ("index", "middle", "ring", "little"):
            for k in (1, 2, 3):
                found = axes(zero, f"{finger}_{side}_{k}")
                np.testing.assert_allclose(found, (-UP, inward), atol=1e-9)
        for k in (1, 2, 3):  # the pad looks to the little finger, which is behind
            np.testing.assert_allclose(axes(zero, f"thumb_{side}_{k}"), (-UP, -FORWARD), atol=1e-9)
        np.testing.assert_allclose(axes(zero, f"eye_{side}"), (FORWARD, UP), atol=1e-9)


def moved(name: str, degrees: float) -> Floats:
    q = np.zeros(len(RIG.coordinates))
    q[RIG.coordinates.index[name]] = np.radians(degrees)
    return q


def test_signs_are_anatomical_on_both_sides() -> None:
    for side, outward in (("L", LEFT), ("R", -LEFT)):
        assert axes(moved(f"arm_{side}.flexion", 90), f"arm_{side}")[0] @ FORWARD > 0.999
        assert axes(moved(f"arm_{side}.abduction", 90), f"arm_{side}")[0] @ outward > 0.999
        assert axes(moved(f"arm_{side}.rotation", 90), f"arm_{side}")[1] @ -outward > 0.999
        assert axes(moved(f"f_arm_{side}.flexion", 90), f"f_arm_{side}")[0] @ FORWARD > 0.999
        assert axes(moved(f"f_arm_{side}.pronation", 80), f"palm_{side}")[1] @ -FORWARD > 0.98
        assert axes(moved(f"palm_{side}.flexion", 70), f"palm_{side}")[0] @ -outward > 0.9
        assert axes(moved(f"palm_{side}.deviation", 20), f"palm_{side}")[0] @ FORWARD > 0.3
        assert axes(moved(f"index_{side}_1.deviation", 20), f"index_{side}_1")[0] @ FORWARD > 0.3
        assert axes(moved(f"index_{side}_2.flexion", 90), f"index_{side}_3")[0] @ -outward > 0.999
        thumb = f"thumb_{side}_1"
        assert axes(moved(f"{thumb}.flexion", -60), thumb)[0] @ FORWARD > 0.8
        assert axes(moved(f"{thumb}.abduction", 45), thumb)[0] @ -outward > 0.7
        assert axes(moved(f"eye_{side}.yaw", 30), f"eye_{side}")[0] @ LEFT > 0.49
        assert axes(moved(f"eye_{side}.pitch", 20), f"eye_{side}")[0] @ UP > 0.3
        shoulder = RIG.bones[f"arm_{side}"].origin_node
        rise, forward = (
            RIG.chain.frames(moved(f"clav_{side}.{turn}", 15)).positions[shoulder]
            - RIG.chain.frames(np.zeros(len(RIG.coordinates))).positions[shoulder]
            for turn in ("elevation", "protraction")
        )
        assert rise[1] > 0.03
        assert forward[2] > 0.03
    for bone in ("back_1", "back_2", "neck", "head"):
        assert axes(moved(f"{bone}.flexion", 10), bone)[0] @ FORWARD > 0.17
        assert axes(moved(f"{bone}.lateral", 10), bone)[0] @ LEFT > 0.17
        assert axes(moved(f"{bone}.axial", 10), bone)[1] @ LEFT > 0.17


@settings(max_examples=20)
@given(st.floats(-30, 150), st.floats(-50, 170))
def test_a_raised_arm_lifts_its_shoulder_and_keeps_its_direction(abd: float, flex: float) -> None:
    q = moved("arm_L.abduction", abd)
    q[RIG.coordinates.index["arm_L.flexion"]] = np.radians(flex)
    a, f = np.radians([abd, flex])
    expected = np.array([np.sin(a), -np.cos(a) * np.cos(f), np.cos(a) * np.sin(f)])
    np.testing.assert_allclose(axes(q, "arm_L")[0], expected, atol=1e-9)
    shoulder = RIG.bones["arm_L"].origin_node
    rest = RIG.chain.frames(np.zeros(len(RIG.coordinates))).positions[shoulder][1]
    rise = RIG.chain.frames(q).positions[shoulder][1] - rest
    assert np.sign(np.round(rise, 6)) == np.sign(np.round(0.16 * abd + 0.10 * flex, 2))
