"""The report of a text has the figures of likeness, on the score's time line."""

from __future__ import annotations

import json

import numpy as np
import pytest

import azee
from azee.animation import animate
from azee.compilation import perform
from azee.lang.program import evaluate_expression
from azee.quality.kinematics import FPS, Kinematics
from azee_rig.rig import Rig

TEXT = """\
sync
    'FROM (key .3 (place @I_TIP(s) ^Rssp))
    'WAY (key .5 (transpath @I_TIP(s) straight))
    'start 'FROM:end
    'TO (key .3 (place @I_TIP(s) ^Mssp))
    'start 'WAY:end
    'SHAKE (key .5 (trill !palm(w) ^up))
    'start 'FROM:start
"""


def test_the_report_has_the_figures_on_the_score_s_time_line(signer: Rig) -> None:
    made = azee.compile(TEXT, life=False, fps=60.0)
    figures = made.report.likeness
    speed = figures.lexical_wrist_speed_m_s
    assert speed is not None
    assert speed.of == "palm_R"
    wrist = Kinematics.of(made.clip, signer).wrist("R")
    frame = round((speed.at_s + made.animation.lead_s) * FPS)
    there = FPS / 2.0 * np.linalg.norm(wrist[frame + 1] - wrist[frame - 1])
    assert speed.value == pytest.approx(there, rel=0.02)
    document = json.loads(json.dumps(made.report.as_json(), allow_nan=False))["likeness"]
    assert document["lexical_wrist_speed_m_s"]["value"] == speed.value
    assert document["signs"] == [{"rule": "", "start_s": 0.0, "end_s": pytest.approx(1.1)}]
    again = animate(made.score, signer, life=False, fps=60.0)
    assert again.report.likeness == figures


def test_the_example_of_three_signs_has_three(signer: Rig) -> None:
    text = ":info-about('topic = :personne, 'info = :info-about('topic = :âge, 'info = :nb-5))"
    made = perform(evaluate_expression(text).score, signer, life=False)
    found = made.report.likeness.signs
    assert [s.rule for s in found] == ["personne", "âge-once", "number-sign"]
    figures = made.report.likeness
    spreads = [t.onset_spread_ms for t in figures.transitions if t.onset_spread_ms is not None]
    assert len(spreads) >= 1
    assert figures.onset_spread_ms == sorted(spreads)[len(spreads) // 2]
