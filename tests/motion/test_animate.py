"""The whole of motion on the body that ships, with scores built by hand."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from azee.animation import Animation, animate
from azee.motion.keys.rest import DEFAULT, RESTS, Rest, rest_posture
from azee.quality.motion_report import ConstraintResult
from azee.score.interval import Interval
from azee.score.score import Block, Call, Group, Hold, Key, Score
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver.collisions import Overlap
from azee_solver.constraint import (
    BoneAxis,
    Constraint,
    LookAt,
    Morph,
    Orient,
    Place,
    Relation,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.geometry import (
    Arc,
    Bone,
    Circle,
    Dir,
    FreePoint,
    Moving,
    NamedPoint,
    Opp,
    Out,
    Path,
    Scale,
    Side,
    SigningSpace,
    Site,
    SitePoint,
    Straight,
    Vec,
    VTranslate,
)

F = Fraction
S, W = Side.STRONG, Side.WEAK
UP = Vec(0, 1, 0)
INWARD = Opp(Out(S))
MIDDLE = NamedPoint(SigningSpace.MSSP)
TIP = Site("I_TIP", S)


@cache
def rig() -> Rig:
    return load_rig()


def at(site: Site, x: float, y: float, z: float) -> Place:
    return Place(site, VTranslate(MIDDLE, Vec(x, y, z)))


def block(name: str, start: str, length: str, *constraints: Constraint) -> Block:
    interval = Interval(F(start), F(start) + F(length))
    return Block(name, interval, Key(F(length), constraints=constraints))


def hold(name: str, start: str, length: str, of: str, *channels: str) -> Block:
    interval = Interval(F(start), F(start) + F(length))
    return Block(name, interval, Hold(F(length), block=of, channels=channels or ("hands",)))


def sync(*blocks: Block, rule: str | None = None) -> Group:
    calls = () if rule is None else (Call(rule),)
    return Group(max(b.interval_in_parent.end for b in blocks), blocks=blocks, calls=calls)


@cache
def played(
    score: Score, *, fps: float = 30.0, dominant: Side = Side.RIGHT, precise: bool = False
) -> Animation:
    return animate(score, rig(), fps=fps, dominant=dominant, life=False, precise=precise)


def results(animation: Animation) -> dict[str, ConstraintResult]:
    return {"/".join(c.path) + f" {c.kind}": c for c in animation.report.constraints}


def tip_track(animation: Animation, site: str = "I_TIP_R") -> np.ndarray:
    frames = rig().chain.frames(animation.clip.coordinates)
    return rig().sites[site].point(frames)


def frame_at(animation: Animation, score_s: float) -> int:
    return int(np.argmin(np.abs(animation.clip.times - animation.lead_s - score_s)))


TWO_KEYS = sync(
    block("START", "0", ".2", at(TIP, 0, 0.05, 0)),
    block("END", ".6", ".2", at(TIP, -0.1, -0.1, 0)),
    block("PALM", "0", ".8", Orient(BoneAxis.NRM, Bone("palm", S), Relation.ALONG, INWARD)),
)
PATH = sync(
    block("START", "0", ".2", at(TIP, 0, 0.1, 0)),
    block("MOVE", ".2", ".6", Transpath(TIP, Straight())),
    block("END", ".8", ".2", at(TIP, 0, -0.1, 0)),
)
SHAKE = sync(
    block("SIGN", "0", "1.2", at(TIP, 0, 0.05, 0)),
    block("R", ".3", ".1", Rotate(Bone("head"), UP, math.radians(-15))),
    block("L", ".6", ".1", Rotate(Bone("head"), UP, math.radians(15))),
)


@pytest.mark.parametrize("score", [TWO_KEYS, PATH, SHAKE])
@pytest.mark.parametrize("fps", [30.0, 60.0])
def test_every_constraint_holds_in_every_frame_of_its_block(score: Score, fps: float) -> None:
    animation = played(score, fps=fps)
    assert [(c.path, c.reason) for c in animation.report.constraints if not c.met] == []
    assert animation.report.max_excess_rad == 0
    assert animation.report.met


def test_the_score_keeps_its_times() -> None:
    animation = played(TWO_KEYS)
    in_score = [round(t - animation.lead_s, 9) for t in animation.key_times]
    assert {0.0, 0.2, 0.6, 0.8} <= set(in_score)
    assert animation.lead_s * 30 == pytest.approx(round(animation.lead_s * 30))
    assert {(c.start_s, c.end_s) for c in animation.report.constraints} == {
        (0.0, 0.2),
        (0.6, 0.8),
        (0.0, 0.8),
    }
    assert [(label.text, round(label.start_s - animation.lead_s, 9), label.depth)
            for label in animation.clip.labels] == [
        ("START", 0.0, 0), ("PALM", 0.0, 0), ("END", 0.6, 0),
    ]  # fmt: skip


NEARLY_RAD = math.radians(1.0)
"""Hands beside the trunk are drawn from it by so much."""


@pytest.mark.parametrize("rest", RESTS)
def test_the_signer_stands_at_rest_before_and_after(rest: Rest) -> None:
    clip = animate(TWO_KEYS, rig(), life=False, rest=rest).clip
    standing = rest_posture(rig(), rest, Side.RIGHT)
    assert clip.coordinates[0] == pytest.approx(standing, abs=NEARLY_RAD)
    assert clip.coordinates[-1] == pytest.approx(standing, abs=NEARLY_RAD)
    with pytest.raises(ValueError, match=r"no rest 'asleep'; .* are: folded, hanging, ready"):
        animate(TWO_KEYS, rig(), rest="asleep")  # type: ignore[arg-type]


@pytest.mark.parametrize("rest", RESTS)
def test_ways_from_and_to_rest_are_calm(rest: Rest) -> None:
    high = sync(block("HIGH", "0", ".4", at(TIP, -0.2, 0.45, 0.1)))
    animation = animate(high, rig(), life=False, rest=rest, fps=120.0)
    frames = rig().chain.frames(animation.clip.coordinates)
    wrist = frames.positions[:, rig().bones["palm_R"].origin_node]
    assert np.linalg.norm(wrist[0] - wrist.mean(axis=0)) > 0.1
    speeds = np.linalg.norm(np.diff(wrist, axis=0), axis=1) * 120.0
    assert 0.8 < speeds.max() < 2.0


def test_an_idle_hand_stays_at_rest_while_the_other_signs() -> None:
    standing = rest_posture(rig(), DEFAULT, Side.RIGHT)
    weak = [i for i, n in enumerate(rig().coordinates.names) if "_L" in n and n[:3] != "eye"]
    clip = played(TWO_KEYS).clip
    assert clip.coordinates[:, weak] == pytest.approx(
        np.tile(standing[weak], (len(clip.times), 1)), abs=NEARLY_RAD
    )


def test_nothing_jumps() -> None:
    clip = played(PATH, fps=60.0).clip
    step = np.abs(np.diff(clip.coordinates, axis=0)) * 60.0
    assert 2.5 < step.max() < 6.5
    jump = np.abs(np.diff(clip.coordinates, n=2, axis=0)) * 60.0**2
    assert 15.0 < jump.max() < 40.0


def test_a_static_block_is_solved_once() -> None:
    animation = played(sync(block("ONLY", "0", "2", at(TIP, 0, 0, 0))))
    assert [p.reused for p in animation.report.postures] == [False, True]
    first, second = (p.coordinates for p in animation.report.postures)
    assert np.array_equal(first, second)


@pytest.mark.parametrize(
    "path", [Straight(), Arc(Vec(0.08, 0, 0)), Circle(Vec(0, 0, 1), 0.05, 1.0)]
)
def test_a_site_travels_on_its_path_within_2_mm(path: Path) -> None:
    score = sync(
        block("START", "0", ".2", at(TIP, 0, 0.1, 0)),
        block("MOVE", ".2", ".6", Transpath(TIP, path)),
        block("END", ".8", ".2", at(TIP, 0, 0.02, 0)),
    )
    animation = played(score)
    move = results(animation)["MOVE transpath"]
    assert move.met, move
    assert move.residual is not None
    assert move.residual < 2e-3


def test_a_straight_path_is_straight_and_has_the_profile_of_minimum_jerk() -> None:
    animation = played(PATH)
    tip = tip_track(animation)
    first, last = tip[frame_at(animation, 0.2)], tip[frame_at(animation, 0.8)]
    assert first - last == pytest.approx([0, 0.2 * _scale(), 0], abs=2e-3)
    for tau in (0.25, 0.5, 0.75):
        s = 10 * tau**3 - 15 * tau**4 + 6 * tau**5
        now = tip[frame_at(animation, 0.2 + 0.6 * tau)]
        exact = animation.clip.times[frame_at(animation, 0.2 + 0.6 * tau)] - animation.lead_s
        assert exact == pytest.approx(0.2 + 0.6 * tau, abs=0.017)
        tau = (exact - 0.2) / 0.6
        s = 10 * tau**3 - 15 * tau**4 + 6 * tau**5
        assert now == pytest.approx(first + s * (last - first), abs=2e-3)


def _scale() -> float:
    return rig().landmarks.arm_m / rig().landmarks.reference_arm_m


def test_other_constraints_hold_on_the_way() -> None:
    score = sync(
        *PATH.blocks,
        block(
            "PERM", "0", "1", Orient(BoneAxis.NRM, Bone("palm", S), Relation.ALONG, Vec(1, 0, 0))
        ),
    )
    perm = results(played(score))["PERM orient"]
    assert perm.met, perm


def test_both_hands_travel_at_once_and_a_key_falls_on_the_way() -> None:
    weak = Site("I_TIP", W)
    score = sync(
        block("START", "0", ".2", at(TIP, -0.05, 0.1, 0), at(weak, 0.05, 0.1, 0)),
        block("MOVE", ".2", ".6", Transpath(TIP, Straight()), Transpath(weak, Straight())),
        block("END", ".8", ".2", at(TIP, -0.2, 0.1, 0), at(weak, 0.2, 0.1, 0)),
        block("NOD", ".4", ".2", Rotate(Bone("head"), Vec(1, 0, 0), 0.2)),
    )
    animation = played(score)
    assert animation.report.met, [c for c in animation.report.constraints if not c.met]
    speed = np.linalg.norm(np.diff(tip_track(animation), axis=0), axis=1)
    assert speed[frame_at(animation, 0.4)] > 0.003
    assert speed[frame_at(animation, 0.6)] > 0.003


def test_a_place_follows_a_moving_point() -> None:
    moving = Moving(Arc(Vec(0, 0.05, 0)), MIDDLE, VTranslate(MIDDLE, Vec(-0.15, 0, 0)))
    score = sync(
        block("MVT", "0", ".8", Place(TIP, moving)),
        hold("HOLD", ".8", ".4", "MVT"),
    )
    found = results(played(score))
    assert found["MVT place"].met, found["MVT place"]
    assert found["HOLD place"].met, found["HOLD place"]
    tip = tip_track(played(score))
    first, last = frame_at(played(score), 0.8), frame_at(played(score), 1.2)
    assert np.ptp(tip[first : last + 1], axis=0).max() < 1e-3


def test_a_hold_keeps_the_hands_and_lets_the_head_go() -> None:
    sign = block("A", "0", ".5", at(TIP, 0, 0, 0), Rotate(Bone("head"), UP, 0.4))
    animation = played(sync(sign, hold("H", ".5", "1.5", "A")))
    found = results(animation)
    assert found["H place"].met
    assert "H rotate" not in found
    axial = rig().coordinates.index["head.axial"]
    end = frame_at(animation, 1.9)
    assert abs(animation.clip.coordinates[end, axial]) < 0.01
    assert tip_track(animation)[end] == pytest.approx(
        tip_track(animation)[frame_at(animation, 0.5)], abs=1e-3
    )


def test_a_free_hand_goes_down_while_the_other_signs_on() -> None:
    weak = Place(Site("I_TIP", W), VTranslate(MIDDLE, Vec(0.1, 0.3, 0)))
    animation = played(
        sync(
            block("BOTH", "0", ".5", at(TIP, -0.1, 0, 0), weak),
            block("ONE", ".8", "2", at(TIP, -0.1, 0.1, 0)),
        )
    )
    left = [i for i, n in enumerate(rig().coordinates.names) if n.startswith(("arm_L", "f_arm_L"))]
    late = animation.clip.coordinates[frame_at(animation, 2.0)]
    standing = rest_posture(rig(), DEFAULT, Side.RIGHT)
    assert late[left] == pytest.approx(standing[left], abs=NEARLY_RAD)
    both = animation.clip.coordinates[frame_at(animation, 0.5)]
    assert np.abs(both[left] - standing[left]).max() > 0.2


def test_a_key_of_the_head_does_not_stop_a_free_arm() -> None:
    sign = (
        block("A", "0", ".2", at(TIP, 0, 0.1, 0)),
        block("B", ".7", ".2", at(TIP, -0.15, -0.1, 0)),
    )
    nod = block("NOD", ".45", "0", Rotate(Bone("head"), Vec(1, 0, 0), 0.1))
    arm = [i for i, n in enumerate(rig().coordinates.names) if n.startswith(("arm_R", "f_arm_R"))]
    with_nod, without = played(sync(*sign, nod)), played(sync(*sign))
    assert with_nod.clip.coordinates[:, arm] == pytest.approx(without.clip.coordinates[:, arm])
    flexion = rig().coordinates.index["head.flexion"]
    assert np.ptp(with_nod.clip.coordinates[:, flexion]) > 0.05


def test_two_postures_that_share_an_instant_are_told_apart() -> None:
    score = sync(
        block("A", "0", ".6", at(TIP, 0, 0.1, 0)),
        block("B", ".6", ".6", at(TIP, -0.1, -0.05, 0)),
    )
    animation = played(score)
    found = results(animation)
    assert found["B place"].met
    assert not found["A place"].met
    assert str(found["A place"].reason).startswith("ends early, at 0.")
    assert ": B starts" in str(found["A place"].reason)
    step = np.abs(np.diff(animation.clip.coordinates, axis=0)).max() * 30
    assert step < math.radians(900)


def test_two_blocks_that_one_posture_serves_share_the_instant() -> None:
    palm = Orient(BoneAxis.NRM, Bone("palm", S), Relation.ALONG, Vec(0, -1, 0))
    animation = played(sync(block("A", "0", ".6", palm), block("B", ".6", ".6", at(TIP, 0, 0, 0))))
    assert animation.report.met, animation.report.constraints


def test_a_hand_that_rests_on_the_head_follows_it() -> None:
    forehead = Place(TIP, SitePoint(Site("FH")), contact=True)
    score = sync(
        block("TOUCH", "0", "1.2", forehead),
        block("TURN", ".4", ".3", Rotate(Bone("head"), UP, math.radians(20))),
    )
    touch = results(played(score))["TOUCH place"]
    assert touch.met, touch


def test_a_trill_swings_as_often_and_as_far_as_it_says_and_fades() -> None:
    trill = Trill(Bone("f_arm", S), Dir(Bone("f_arm", S)), 4.0, math.radians(8))
    score = sync(block("T", "0", "1", trill), block("P", "0", "1", at(TIP, 0, 0, 0)))
    animation = played(score, fps=120.0)
    plain = played(sync(block("P", "0", "1", at(TIP, 0, 0, 0))), fps=120.0)
    q, base = animation.clip.coordinates, plain.clip.coordinates
    swing = q - base
    column = rig().coordinates.index["f_arm_R.pronation"]
    assert results(animation)["T trill"].met
    assert results(animation)["P place"].met
    rows = slice(frame_at(animation, 0.15), frame_at(animation, 0.86))
    inside, times = swing[rows, column], animation.clip.times[rows]
    # Least squares: sine and cosine of 4 Hz explain all of it, with the whole amplitude.
    waves = np.stack([f(2 * math.pi * 4.0 * times) for f in (np.sin, np.cos)], axis=1)
    parts = np.linalg.lstsq(waves, inside, rcond=None)[0]
    assert np.linalg.norm(parts) == pytest.approx(math.radians(8), rel=0.02)
    assert np.abs(inside - waves @ parts).max() < 0.02 * math.radians(8)
    assert np.abs(inside).max() == pytest.approx(math.radians(8), rel=0.02)
    before = np.flatnonzero(np.diff(np.sign(inside)) != 0)
    share = inside[before] / (inside[before] - inside[before + 1])
    crossings = times[before] + share * (times[before + 1] - times[before])
    assert len(crossings) in (5, 6)
    assert np.diff(crossings) == pytest.approx(1 / (2 * 4.0), rel=0.02)
    assert np.abs(swing[frame_at(animation, 0.0)]).max() < 1e-9
    rising = swing[frame_at(animation, 0.0) : frame_at(animation, 0.06), column]
    assert np.abs(rising).max() < math.radians(5)
    assert np.abs(swing[frame_at(animation, 1.0)]).max() < 1e-9


@pytest.mark.parametrize("axis", [Vec(1, 0, 0), Vec(0, 2, 0), Dir(Bone("f_arm", S))], ids=str)
def test_a_trill_turns_about_a_fixed_axis_of_the_bone_before(axis: Vec | Dir) -> None:
    """An axis without bones in it is carried along; how long it is does not matter."""
    score = sync(
        block("T", "0", "1", Trill(Bone("palm", S), axis, 2.5, math.radians(6))),
        block("P", "0", "1", at(TIP, 0, 0, 0)),
    )
    animation, plain = played(score, fps=60.0), played(sync(score.blocks[1]), fps=60.0)
    row = frame_at(animation, 0.5)
    before, after = (
        rig().chain.frames(made.clip.coordinates[row : row + 1]).rotations[0]
        for made in (plain, animation)
    )
    bones = rig().bones
    palm, parent = bones["palm_R"].node, int(rig().chain.parents[bones["palm_R"].origin_node])
    turn = after[palm] @ before[palm].T
    if isinstance(axis, Vec):
        wanted = before[parent] @ np.sign([axis.x, axis.y, axis.z])
    else:
        wanted = before[bones["f_arm_R"].node][:, 1]
    skew = (turn - turn.T) / 2
    spin = np.array([skew[2, 1], skew[0, 2], skew[1, 0]])
    # Sine 2π 2.5 · 0.5 = 1: half-way the palm is turned by the whole amplitude.
    assert abs(spin @ wanted) == pytest.approx(math.sin(math.radians(6)), rel=0.03)
    assert np.linalg.norm(spin) == pytest.approx(abs(spin @ wanted), rel=0.02)


def test_a_look_turns_eyes_and_lids_and_leaves_the_arms_at_rest() -> None:
    score = sync(
        block("GAZE", "0", "1", LookAt(FreePoint(-0.3, 0.1, 1.0))),
        block("FACE", "0", "1", Morph("AU1", None, 0.7)),
    )
    animation = played(score)
    assert animation.report.met, animation.report.constraints
    arms = [i for i, n in enumerate(rig().coordinates.names) if n.startswith(("arm", "f_arm"))]
    idle = rest_posture(rig(), DEFAULT, Side.RIGHT)[arms]
    assert animation.clip.coordinates[:, arms] == pytest.approx(
        np.broadcast_to(idle, (len(animation.clip.times), len(arms))), abs=NEARLY_RAD
    )
    middle = frame_at(animation, 0.5)
    wanted = {unit: 0.7 * share for unit, share in rig().face_morphs["AU1"].items()}
    for unit, weight in rig().lid_weights(animation.clip.coordinates[middle]).items():
        wanted[unit] = wanted.get(unit, 0.0) + float(weight)
    weights = animation.clip.unit_weights[middle]
    for unit, weight in zip(animation.clip.units, weights, strict=True):
        assert weight == pytest.approx(wanted.pop(unit, 0.0))
    assert not any(wanted.values())
    assert any("eyeLook" in unit for unit in animation.clip.units)


def test_a_glance_is_over_though_the_chin_stays_up() -> None:
    chin = Rotate(Bone("head"), Vec(-1, 0, 0), math.radians(6))
    score = sync(
        block("GAZE", "0", ".2", LookAt(FreePoint(-0.5, 0.05, 0.5))),
        block("CHIN", ".1", "1.9", chin),
        block("LATER", "1", ".2", at(TIP, 0, 0, 0)),
    )
    animation = played(score)
    assert animation.report.met, animation.report.constraints
    index = rig().coordinates.index
    turned = animation.clip.coordinates[:, [index["neck.axial"], index["head.axial"]]].sum(axis=1)
    raised = animation.clip.coordinates[:, index["head.flexion"]]
    assert abs(turned[frame_at(animation, 0.2)]) > math.radians(10)
    assert abs(turned[frame_at(animation, 1.0)]) < math.radians(1)
    for time in (0.2, 1.0, 1.9):
        assert raised[frame_at(animation, time)] < -math.radians(3.5)


def test_a_levelled_head_goes_straight_to_where_something_turns_it() -> None:
    lean = Orient(BoneAxis.DIR, Bone("back_2"), Relation.ALONG, Vec(0, 1, 0.4))
    turn = Rotate(Bone("head"), UP, math.radians(15))
    score = sync(block("LEAN", "0", "2", lean), block("TURN", "1.2", ".4", turn))
    animation = played(score)
    assert animation.report.met, animation.report.constraints
    neck = animation.clip.coordinates[:, rig().coordinates.index["neck.flexion"]]
    assert neck[frame_at(animation, 0.0)] < -math.radians(8)
    assert neck[frame_at(animation, 0.4)] < 0.6 * neck[frame_at(animation, 0.0)]


def test_left_handers_sign_with_the_left() -> None:
    left = played(TWO_KEYS, dominant=Side.LEFT, precise=True)
    assert left.report.met
    assert np.ptp(tip_track(left, "I_TIP_L"), axis=0).max() > 0.1
    other = [i for i, n in enumerate(rig().coordinates.names) if n.startswith(("arm_R", "index_R"))]
    assert np.ptp(left.clip.coordinates[:, other], axis=0).max() < math.radians(5)


def test_the_same_score_gives_the_same_bytes() -> None:
    again = animate(PATH, rig(), life=False).clip
    assert again.coordinates.tobytes() == played(PATH).clip.coordinates.tobytes()


def test_life_is_seeded_never_still_and_keeps_what_the_score_asks() -> None:
    face = block("FACE", "0", "3", Morph("AU5", None, 0.7))
    score = sync(block("SIGN", "0", "3", at(TIP, 0, 0, 0)), face)
    lively = animate(score, rig(), seed=5)
    assert np.array_equal(lively.clip.coordinates, animate(score, rig(), seed=5).clip.coordinates)
    assert not np.array_equal(
        lively.clip.coordinates, animate(score, rig(), seed=6).clip.coordinates
    )
    assert lively.report.met
    still = played(score)
    apart = np.abs(lively.clip.coordinates - still.clip.coordinates)
    assert math.radians(0.5) < apart.max() < math.radians(8)
    moving = np.abs(np.diff(lively.clip.coordinates, axis=0)) * 30.0 > math.radians(0.2)
    names = rig().coordinates.names
    for limb in ("back", "head", "neck"):
        columns = [i for i, name in enumerate(names) if name.startswith(limb)]
        assert moving[:, columns].any(axis=1).all()
    inside = slice(frame_at(lively, 0.0), frame_at(lively, 3.0) + 1)
    shown = dict(zip(lively.clip.units, lively.clip.unit_weights[inside].T, strict=True))
    assert not any(np.any(shown.get(unit, 0.0)) for unit in rig().face_morphs["AU43"])
    stare = animate(sync(block("FACE", "0", "30", Morph("AU5", None, 0.7))), rig(), seed=5)
    during = stare.clip.unit_weights[frame_at(stare, 0.0) : frame_at(stare, 30.0) + 1]
    shown = dict(zip(stare.clip.units, during.T, strict=True))
    assert not any(np.any(shown.get(unit, 0.0)) for unit in rig().face_morphs["AU43"])
    quiet = animate(sync(block("PAUSE", "0", "20")), rig(), seed=5)
    assert quiet.clip.unit_weights.max() > 0.9


def test_the_report_is_plain_json_with_the_documented_fields() -> None:
    report = json.loads(json.dumps(played(PATH).report.as_json(), allow_nan=False))
    assert {
        "rig", "fps", "mode", "duration_s", "keyframes", "problems", "evaluations", "solve_s",
        "constraints", "limits", "penetration",
    } <= report.keys()  # fmt: skip
    for row in report["constraints"]:
        assert {
            "path", "rule", "kind", "target", "start_s", "end_s", "residual", "unit", "tolerance",
            "met", "reason",
        } <= row.keys()  # fmt: skip
        assert row["unit"] in ("m", "rad")
        assert row["met"] == (row["reason"] is None)
    assert report["limits"] == {"max_excess_rad": 0.0, "joint": None}


def test_what_overlaps_in_a_key_posture_is_told_with_its_time() -> None:
    report = played(PATH).report
    first, *others = report.postures
    overlaps = Overlap("hand_R", "trunk_3", 0.004), Overlap("index_R_1", "face", 0.002)
    inside = replace(first, report=replace(first.report, penetration=overlaps))
    rows = replace(report, postures=(inside, *others)).as_json()["penetration"]
    assert rows == [
        {"time_s": float(first.time), "pair": ["hand_R", "trunk_3"], "depth_m": 0.004,
         "intended": False},
        {"time_s": float(first.time), "pair": ["index_R_1", "face"], "depth_m": 0.002,
         "intended": False},
    ]  # fmt: skip


def test_what_cannot_be_reached_is_reported_and_not_an_exception() -> None:
    animation = played(sync(block("FAR", "0", ".5", at(TIP, 0, 0, 3))))
    (far,) = animation.report.constraints
    assert not far.met
    assert far.reason
    assert far.residual is not None
    assert far.residual > 1


def test_a_direction_that_is_none_is_reported_without_a_number() -> None:
    nowhere = Orient(BoneAxis.DIR, Bone("palm", S), Relation.ALONG, Scale(UP, 0.0))
    animation = played(sync(block("NONE", "0", ".5", nowhere)))
    (result,) = animation.report.constraints
    assert (result.met, result.residual) == (False, None)
    assert result.reason
    json.dumps(animation.report.as_json(), allow_nan=False)


def test_an_empty_score_is_a_signer_at_rest() -> None:
    animation = played(sync(block("NOTHING", "0", "1")))
    assert animation.report.constraints == ()
    assert animation.key_times == ()
    assert animation.clip.times[-1] >= 1


def test_a_mode_that_is_none_is_an_error() -> None:
    with pytest.raises(ValueError, match="no mode"):
        animate(TWO_KEYS, rig(), mode="wild")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="frames per second"):
        animate(TWO_KEYS, rig(), fps=0)


def test_flat_has_one_track_with_all_keys() -> None:
    animation = animate(TWO_KEYS, rig(), mode="flat")
    (track,) = animation.tracks
    assert track.path == ()
    assert track.coordinates == tuple(rig().coordinates.names)
    assert track.keys_s == tuple(sorted({float(p.time) for p in animation.report.postures}))
    assert (track.start_s, track.end_s) == (0.0, 0.8)


def test_tracks_give_each_block_what_it_needs() -> None:
    tracks = {"/".join(t.path): t for t in played(SHAKE).tracks}
    assert {c.partition(".")[0] for c in tracks["R"].coordinates} <= {"neck", "head"}
    assert tracks["R"].keys_s == pytest.approx((0.3, 0.4))
    assert tracks["SIGN"].keys_s == pytest.approx((0.0, 1.2))
    assert {"arm_R.flexion", "f_arm_R.flexion"} <= set(tracks["SIGN"].coordinates)
