"""Five postures in which a signer touches himself (G18)."""

from __future__ import annotations

import json

import numpy as np
import pytest

from azee.calibration import POSTURES, WITHIN_M, apart, of_body, of_capture
from azee.cli.main import run
from azee.clip.clip import Clip
from azee_rig.rig import Rig
from azee_solver.evaluate import evaluator
from azee_solver.geometry import Side


@pytest.mark.long
def test_distances_are_those_of_the_farthest_touch(signer: Rig) -> None:
    body = evaluator(signer, Side.RIGHT)
    idle = signer.coordinates.idle[None]
    both = POSTURES[4].distances(body, idle)[0]
    assert both == pytest.approx(0.61, abs=0.25)
    still = Clip(np.array([0.0]), idle, (), np.zeros((1, 0)))
    found = of_capture(still, signer)
    assert [m.posture.number for m in found] == [1, 2, 3, 4, 5]
    assert apart(found, WITHIN_M) == found


@pytest.mark.slow
@pytest.mark.parametrize("body", ["signer", "child"])
def test_bodies_that_ship_touch_themselves(body: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["rig", "calibration", "--rig", body, "--format", "json"]) == 0
    rows = json.loads(capsys.readouterr().out)["postures"]
    assert all(row["distance_m"] < 0.01 for row in rows)


@pytest.mark.slow
def test_a_drifted_capture_is_told(signer: Rig) -> None:
    """The weakness that the thesis names: an arm that is off by a few degrees misses its touch."""
    assert apart(of_body(signer), 0.01) == ()
    from fractions import Fraction

    from azee_solver.constraint import Place
    from azee_solver.geometry import SitePoint
    from azee_solver.solve import solve
    from azee_solver.task import Task

    a, b = POSTURES[1].touches[0]
    task = Task(Place(a, SitePoint(b), contact=True), ("x",), Fraction(0), 0, 0.0)
    idle = signer.coordinates.idle
    met = solve(signer, [task], dominant=Side.RIGHT, start=idle, reference=idle).coordinates
    drifted = np.array(met)
    drifted[signer.coordinates.index["arm_R.abduction"]] += np.radians(8.0)
    rows = np.stack([met, drifted])
    clip = Clip(np.array([0.0, 0.1]), rows, (), np.zeros((2, 0)))
    assert of_capture(clip, signer)[1].distance_m < 0.005
    only = Clip(np.array([0.0]), rows[1:], (), np.zeros((1, 0)))
    assert of_capture(only, signer)[1].distance_m > WITHIN_M
