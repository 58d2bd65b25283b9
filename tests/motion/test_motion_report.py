"""What the report of a movement says: its fields, what was missed, what overlaps."""

from __future__ import annotations

import json
from dataclasses import replace

from played_scores import PATH, TIP, UP, S, at, block, played, sync

from azee_solver.collisions import Overlap
from azee_solver.constraint import (
    BoneAxis,
    Orient,
    Relation,
)
from azee_solver.geometry import (
    Bone,
    Scale,
)


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
