"""The signer that ships: the sign tree, touches of the face, both hands, and what stays apart."""

from __future__ import annotations

import hashlib
import math
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tree_sign import DIR, NRM, UP, S, W, along, straight_fingers, tasks, tree

from azee_rig.rig import Rig
from azee_solver.constraint import Constraint, Place
from azee_solver.geometry import (
    Bone,
    FreePoint,
    NamedPoint,
    Nrm,
    Opp,
    Out,
    Side,
    SigningSpace,
    Site,
    SitePoint,
    Vec,
    WorldPoint,
)
from azee_solver.penetration import mesh_penetration
from azee_solver.solve import solve
from azee_solver.solve_report import SolveReport
from azee_solver.task import Task

MSSP = NamedPoint(SigningSpace.MSSP)
DEEPEST_M = 3e-3


def run(rig: Rig, *constraints: Constraint) -> SolveReport:
    return solved(rig, tasks(*constraints))


def solved(rig: Rig, asked: Sequence[Task]) -> SolveReport:
    """Solve from the idle posture; each constraint has its line in the report."""
    idle = rig.coordinates.idle
    report = solve(rig, asked, dominant=Side.RIGHT, start=idle, reference=idle)
    assert len(report.constraints) == len(asked) > 0
    return report


def missed(report: SolveReport) -> list[tuple[str, float, str | None]]:
    return [(c.kind, c.residual, c.reason) for c in report.constraints if not c.met]


def site(rig: Rig, report: SolveReport, name: str) -> NDArray[np.float64]:
    return rig.sites[name].point(rig.chain.frames(report.coordinates))


def axis(rig: Rig, report: SolveReport, bone: str, column: int) -> NDArray[np.float64]:
    frames = rig.chain.frames(report.coordinates)
    return np.asarray(frames.rotations[rig.bones[bone].node][:, column])


def inside(
    rig: Rig, report: SolveReport, deepest_m: float = DEEPEST_M
) -> list[tuple[str, str, float]]:
    """Arms and hands deep in trunk or head, on the posed skin."""
    return [
        (p.limb, p.body, p.depth_m)
        for p in mesh_penetration(rig, report.coordinates)
        if p.body in ("trunk", "head") and p.depth_m > deepest_m
    ]


def in_chest(rig: Rig) -> NDArray[np.float64]:
    """A posture (V,) with the right hand in the chest."""
    q, index = rig.coordinates.idle.copy(), rig.coordinates.index
    turned = {"arm_R.rotation": 80, "arm_R.flexion": 0, "f_arm_R.flexion": 110}
    for name, angle in (turned | {"arm_R.abduction": 0}).items():
        q[index[name]] = math.radians(angle)
    return q


def test_a_hand_in_the_chest_is_seen_inside(signer: Rig, planted: SolveReport) -> None:
    """What the tests below ask to find nothing finds a hand that is there."""
    found = inside(signer, replace(planted, coordinates=in_chest(signer)))
    deep = [(limb, body) for limb, body, depth_m in found if depth_m > 0.05]
    assert ("arm_R", "trunk") in deep
    assert {body for _, body in deep} == {"trunk"}
    assert all(limb.endswith("_R") for limb, _ in deep)


@pytest.mark.long
def test_parts_that_hang_loose_on_a_limb_enter_nothing(signer: Rig) -> None:
    """Were the hands hair, only the sleeves would be in the chest."""
    entered = {p.limb for p in mesh_penetration(signer, in_chest(signer)) if p.body == "trunk"}
    assert {"arm_R", "thumb_R"} <= entered
    parts = tuple(
        replace(part, name="hair") if part.name == "skin" else part for part in signer.mesh.parts
    )
    assert parts != signer.mesh.parts
    loose = replace(signer)
    vars(loose)["mesh"] = replace(signer.mesh, parts=parts)  # in place of what its file has
    found = {p.limb for p in mesh_penetration(loose, in_chest(signer))}
    assert found == {"arm_R"}


@pytest.fixture(scope="module")
def planted(signer: Rig) -> SolveReport:
    return solved(signer, tree())


def test_tree_meets_everything(signer: Rig, planted: SolveReport) -> None:
    assert not missed(planted)
    elbow, palm = site(signer, planted, "EL_R"), site(signer, planted, "PA_L")
    assert np.linalg.norm(elbow - palm) < 1e-3
    upright = axis(signer, planted, "f_arm_R", 1)[1]
    assert math.degrees(math.acos(min(1.0, upright))) < 0.5


def test_tree_is_eleven_problems_and_says_what_was_merged(planted: SolveReport) -> None:
    names = [p.name for p in planted.problems]
    assert len(names) == 11
    assert names.index("place @EL(s) @PA(w) 'contact") == 1
    assert "@H_BACK(w)" in names[0]
    assert planted.problems[2].merged_into == names[0]


def test_tree_keeps_arms_out_of_the_body_and_the_head_level(
    signer: Rig, planted: SolveReport
) -> None:
    assert not inside(signer, planted)
    level = axis(signer, planted, "head", 1)[1]
    assert math.degrees(math.acos(min(1.0, level))) < 3
    # Beside the face, not in front of it.
    assert site(signer, planted, "PA_R")[0] < site(signer, planted, "CK_R")[0]


def test_the_published_thumb_misses_by_its_limits_and_nothing_else_does(signer: Rig) -> None:
    report = solved(signer, tree(thumb=True))
    assert len(report.problems) == 11
    ((kind, residual, reason),) = missed(report)
    assert kind == "orient 'nrm !thumb(s, 2)"
    assert 1 < math.degrees(residual) < 20
    assert reason is not None
    assert reason.startswith("conflicts with")


@pytest.mark.parametrize(
    ("target", "deepest_m"),
    [
        (Site("CH"), DEEPEST_M),
        (Site("FH"), DEEPEST_M),
        (Site("CK", S), DEEPEST_M),
        (Site("NO"), 5e-3),  # the nose stands out of the face's capsules
        (Site("CK", W), 8e-3),  # the upper arm is stiff_descent against the chest
        (Site("SH", W), 8e-3),
    ],
    ids=lambda v: v.name if isinstance(v, Site) else "",
)
def test_a_fingertip_touches_face_and_shoulder(signer: Rig, target: Site, deepest_m: float) -> None:
    report = run(signer, Place(Site("I_TIP", S), SitePoint(target), contact=True))
    assert not missed(report)
    assert not inside(signer, report, deepest_m)


def test_a_straight_hand_touches_the_temple(signer: Rig) -> None:
    report = run(
        signer,
        Place(Site("M_TIP", S), SitePoint(Site("FH", S)), contact=True),
        along(NRM, Bone("palm", S), Vec(0.0, -1.0, 0.0)),
        *straight_fingers(S),
    )
    assert not missed(report)
    assert not inside(signer, report)


def test_all_fingertips_meet(signer: Rig) -> None:
    report = run(
        signer,
        Place(Site("M_TIP", S), MSSP),
        *(
            Place(Site(f"{f}_TIP", W), SitePoint(Site(f"{f}_TIP", S)), contact=True)
            for f in "TIMRL"
        ),
    )
    assert not missed(report)
    for f in "TIMRL":
        left, right = (site(signer, report, f"{f}_TIP_{side}") for side in "LR")
        assert np.linalg.norm(left - right) < 1e-3
    assert not inside(signer, report)


def test_two_palms_face_each_other_at_a_distance(signer: Rig) -> None:
    report = run(
        signer,
        Place(Site("PA", W), MSSP),
        Place(Site("PA", S), SitePoint(Site("PA", W)), 0.1),
        along(NRM, Bone("palm", W), Out(S)),
        along(NRM, Bone("palm", S), Out(W)),
        along(DIR, Bone("palm", S), UP),
    )
    assert not missed(report)
    left, right = (site(signer, report, f"PA_{side}") for side in "LR")
    assert np.linalg.norm(left - right) == pytest.approx(0.1, abs=1e-3)


def test_every_limit_holds_to_the_bit(signer: Rig) -> None:
    """Points out of reach draw the body on until limits stop it."""
    limits, unmet = signer.coordinates, 0
    for x in (-0.6, 0.0, 0.6):
        for y in (-0.6, 0.4):
            report = run(signer, Place(Site("I_TIP", S), FreePoint(x, y, 0.5)))
            q = report.coordinates
            assert np.all(q >= limits.lower)
            assert np.all(q <= limits.upper)
            stopped = (q != limits.idle) & ((q == limits.lower) | (q == limits.upper))
            assert report.met or stopped.any()
            unmet += not report.met
    assert 0 < unmet < 6


def test_out_of_reach_is_the_nearest_posture_any_start_finds(signer: Rig) -> None:
    idle = signer.coordinates.idle
    asked = tasks(Place(Site("I_TIP", S), FreePoint(-0.5, 0.3, 1.2)))
    report = solve(signer, asked, dominant=Side.RIGHT, start=idle, reference=idle)
    assert not report.met
    reason = report.constraints[0].reason
    assert reason is not None
    assert reason.startswith("out of reach by")
    for seed in range(4):
        begin = np.random.default_rng(seed).uniform(
            signer.coordinates.lower, signer.coordinates.upper
        )
        other = solve(signer, asked, dominant=Side.RIGHT, start=begin, reference=idle)
        assert report.constraints[0].residual < other.constraints[0].residual + 0.5e-3


@pytest.mark.long
def test_hands_touch_close_to_the_body(signer: Rig) -> None:
    weak, strong = Bone("palm", W), Bone("palm", S)
    crowded: list[list[Constraint]] = [
        [  # where arms held in unlike ways keep out of the trunk
            Place(Site("PA", W), WorldPoint(0.097, 0.997, 0.291)),
            Place(Site("PA", S), SitePoint(Site("PA", W)), contact=True),
        ],
        [  # where the way there leads through the body
            Place(Site("PA", W), WorldPoint(-0.131, 1.219, 0.25)),
            Place(Site("I_TIP", S), SitePoint(Site("H_BACK", W)), contact=True),
            along(NRM, weak, Vec(0.0, 0.0, -1.0)),
            along(NRM, strong, Opp(Nrm(weak))),
        ],
    ]
    for constraints in crowded:
        report = run(signer, *constraints)
        assert not missed(report)
        touch = constraints[1]
        assert isinstance(touch, Place)
        assert isinstance(touch.point, SitePoint)
        ends = f"{touch.site.name}_R", f"{touch.point.site.name}_L"
        gap = np.subtract(*(site(signer, report, name) for name in ends))
        assert np.linalg.norm(gap) < 1e-3
        assert all(overlap.depth_m <= DEEPEST_M for overlap in report.penetration)
        assert not inside(signer, report)


def test_a_place_inside_the_chest_is_not_entered(signer: Rig) -> None:
    report = run(
        signer,
        Place(Site("PA", S), FreePoint(0.0, -0.15, 0.04)),
        along(DIR, Bone("back_2"), UP),
        along(NRM, Bone("back_2"), Vec(0.0, 0.0, 1.0)),
        along(NRM, Bone("palm", S), Opp(Vec(0.0, 0.0, 1.0))),
    )
    unmet = missed(report)
    assert unmet
    assert any("the body is in the way" in str(reason) for _, _, reason in unmet)


def fingerprint(report: SolveReport) -> str:
    return hashlib.sha256(report.coordinates.tobytes()).hexdigest()


def test_the_same_bytes_three_times(signer: Rig, planted: SolveReport) -> None:
    idle = signer.coordinates.idle
    for _ in range(2):
        again = solve(signer, tree(), dominant=Side.RIGHT, start=idle, reference=idle)
        assert fingerprint(again) == fingerprint(planted)


@pytest.mark.slow
def test_the_same_bytes_from_another_process(planted: SolveReport) -> None:
    paths = [p for p in sys.path if p]
    script = f"""
import sys
sys.path[:0] = {[str(Path(__file__).parent), *paths]!r}
from azee_rig.load import load_rig
from azee_solver.geometry import Side
from azee_solver.solve import solve
from test_signing_body import fingerprint
from tree_sign import tree
rig = load_rig()
idle = rig.coordinates.idle
print(fingerprint(solve(rig, tree(), dominant=Side.RIGHT, start=idle, reference=idle)))
"""
    run_ = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert run_.stdout.strip() == fingerprint(planted)
