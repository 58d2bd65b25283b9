"""Handshapes fit the hand: thumbs on the fingers, judged on the skin."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sign import S, along, tasks

from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver.binding import Binding
from azee_solver.constraint import BoneAxis, Constraint, Morph
from azee_solver.geometry import Bone, Dir, Side
from azee_solver.handshape import STRAIGHT, fitted, straight
from azee_solver.penetration import Contact, mesh_penetration
from azee_solver.solve import solve
from azee_solver.solve_report import SolveReport

DEEPEST_M = 3e-3
FINGERS = ("index", "middle", "ring", "little")


def morphs(**weights: float) -> list[Constraint]:
    return [Morph(name, S, weight) for name, weight in weights.items()]


FLAT = {f"{f}_{kind}": 0.0 for f in FINGERS for kind in ("bend", "hook")} | {
    "thumb_spread": 0.0,
    "thumb_opposed": 0.0,
    "thumb_bend": 0.0,
    "thumb_hook": 0.0,
}
SHAPES: dict[str, dict[str, float]] = {
    "flat": FLAT,
    "fist": {"fist_close": 1.0},
    "index": {"M_closed": 1.0, "R_closed": 1.0, "L_closed": 1.0, "T_closed": 1.0}
    | {"index_bend": 0.0, "index_hook": 0.0},
    "index, thumb straight": FLAT | {"middle_bend": 1.0, "middle_hook": 1.0},
}


def run(rig: Rig, *constraints: Constraint) -> SolveReport:
    idle = rig.coordinates.idle
    return solve(rig, tasks(*constraints), dominant=Side.RIGHT, start=idle, reference=idle)


@pytest.mark.parametrize("shape", SHAPES)
def test_a_thumb_lies_on_its_hand_and_the_shape_counts_as_met(signer: Rig, shape: str) -> None:
    report = run(signer, *morphs(**SHAPES[shape]))
    assert report.met, [(c.kind, c.residual, c.reason) for c in report.constraints if not c.met]
    deep = [
        (p.limb, p.body, p.depth_m)
        for p in mesh_penetration(signer, report.coordinates)
        if p.depth_m > DEEPEST_M
    ]
    assert deep == []


def test_without_giving_way_the_skin_would_enter_itself(signer: Rig) -> None:
    """What the judge must see: the presets as they are, put into the hand."""
    q = np.array(signer.coordinates.idle)
    for constraint in morphs(**FLAT):
        assert isinstance(constraint, Morph)
        for v, angle in Binding(signer, Side.RIGHT).preset(constraint).items():
            q[v] = straight(signer.coordinates.names[v]) + angle
    worst = mesh_penetration(signer, q)[0]
    assert worst.limb == "thumb_R"
    assert worst.depth_m > 8e-3
    near = mesh_penetration(signer, q, [Contact(np.array(worst.point), 0.02)])
    assert all(np.linalg.norm(np.array(p.point) - worst.point) > 0.02 for p in near)


def test_only_thumbs_give_way_and_only_where_something_is_in_their_way(signer: Rig) -> None:
    index = signer.coordinates.index
    spread = {"thumb_R_1.flexion": -0.9, "thumb_R_1.abduction": 0.2, "index_R_2.flexion": 1.0}
    asked = {index[name]: angle for name, angle in spread.items()}
    assert fitted(signer, asked) == asked
    closed = {
        index[name]: straight(name) + angle
        for name, angle in signer.skeletal_morphs["fist_close_R"].items()
    }
    changed = {v for v, angle in fitted(signer, closed).items() if angle != closed[v]}
    assert changed
    assert all(signer.coordinates.names[v].startswith("thumb_R") for v in changed)


def test_nobody_stretches_straight_fingers_to_zero(signer: Rig) -> None:
    report = run(signer, *morphs(**FLAT))
    angles = {
        f: [report.coordinates[signer.coordinates.index[f"{f}_R_{k}.flexion"]] for k in (1, 2, 3)]
        for f in FINGERS
    }
    assert all(3.0 <= np.degrees(a) <= 15.0 for joints in angles.values() for a in joints)
    assert len({tuple(joints) for joints in angles.values()}) >= 3, (
        "and no finger is another's copy"
    )
    assert all(name.split("_")[0] in (*FINGERS, "thumb") for name in STRAIGHT)


@pytest.mark.parametrize("body", ["signer", "child", "heavy", "game"])
def test_a_fist_bends_the_end_joints_and_the_thumb_lies_across_it(body: str) -> None:
    rig = load_rig(body)
    report = run(rig, Morph("fist_close", S, 1.0))
    assert report.met
    for finger in FINGERS:
        end = report.coordinates[rig.coordinates.index[f"{finger}_R_3.flexion"]]
        assert 35.0 <= np.degrees(end) <= 60.0, finger
    frames = rig.chain.frames(report.coordinates)
    tip, index = (rig.sites[name].point(frames) for name in ("T_TIP_R", "I_KN_R_2"))
    towards_thumb = frames.rotations[rig.bones["palm_R"].node][:, 0]
    beyond_index = towards_thumb @ (index - tip) / rig.landmarks.arm_m
    assert 0.04 < beyond_index < 0.12, "before the middle and ring fingers"


def test_each_hand_is_fitted_by_itself_and_both_alike(signer: Rig) -> None:
    index, names = signer.coordinates.index, signer.coordinates.names
    asked = {
        side: {
            index[name]: straight(name) + angle
            for name, angle in signer.skeletal_morphs[f"fist_close_{side}"].items()
        }
        for side in "LR"
    }
    found = {side: fitted(signer, asked[side]) for side in "LR"}
    assert fitted(signer, asked["L"] | asked["R"]) == found["L"] | found["R"]
    assert found["L"] != asked["L"]
    left = {names[v].replace("_L_", "_R_"): angle for v, angle in found["L"].items()}
    right = {names[v]: angle for v, angle in found["R"].items()}
    assert left == pytest.approx(right, abs=1e-3)
    # Fingers alone, with no thumb among what is asked, stay as they are.
    fingers = {v: a for v, a in asked["R"].items() if not names[v].startswith("thumb")}
    assert fitted(signer, fingers) == fingers
    # A thumb moves as little as will do, and from where it lies then nothing moves it again.
    again = fitted(signer, found["R"])
    assert max(abs(again[v] - found["R"][v]) for v in again) < 0.1
    assert max(abs(found["R"][v] - asked["R"][v]) for v in again) < 0.5


def test_an_orientation_of_a_thumb_is_not_held_back_by_this(signer: Rig) -> None:
    thumb = along(BoneAxis.DIR, Bone("thumb", S, 3), Dir(Bone("thumb", S, 2)))
    assert run(signer, thumb).met
