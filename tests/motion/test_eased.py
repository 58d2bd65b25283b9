"""The three outcomes of a constraint, from the solver to the report and to what people read."""

from __future__ import annotations

import re

import numpy as np
import pytest

import azee
from azee.compilation import Compilation
from azee.quality.head_and_gaze import trunk_displacement
from azee.quality.kinematics import Kinematics
from azee.quality.outcome import eases, misses, outcome, shortfall, strains
from azee_solver.outcome import Outcome

ON_THE_CHEST = """
key .5
    cstr
        place @M_PAD(s) @ST 'dist .02
        orient 'nrm !palm(s) 'along ^back
        :#hamceeall
"""
SHAKEN = """
sync
    'TREE
    key .8
        cstr
            place(@H_BACK(w), vtranslate(^Mssp, vsum(scale(out(s), .18), vec(0, -.02, -.08))))
            orient 'nrm !palm(w) 'along ^up
            orient 'dir !palm(w) 'along dir(!f_arm(w))
            place(@EL(s), @PA(w), 'contact)
            orient 'dir !f_arm(s) 'along ^up
            orient 'dir !palm(s) 'along dir(!f_arm(s))
    'GAZE (key .4 (lookat ^addressee))
    'start 'TREE:end:-.1
    'SHAKE :headshake
    'start 'TREE:end:-.1
"""
HELD_S = 0.8
FAR = "key .5 (place @I_TIP(s) point(-.15, -.1, .74))"


def made(text: str, *, precise: bool = False, fps: float = 30.0) -> Compilation:
    return azee.compile(text, fps=fps, life=False, precise=precise)


def lean_deg(of: Compilation) -> float:
    return trunk_displacement(Kinematics.of(of.clip, of.rig, 0.0)).value


@pytest.fixture(scope="module")
def chest() -> Compilation:
    return made(ON_THE_CHEST)


def test_an_eased_constraint_is_neither_met_nor_missed(chest: Compilation) -> None:
    report = chest.report
    assert not report.met
    assert not report.missed
    assert misses(report) == []
    (place,) = eases(report)
    assert place.outcome is Outcome.EASED
    assert place.residual is not None
    assert 0.001 < place.residual <= 0.01
    assert place.reason is None
    assert lean_deg(chest) < 5


def test_precise_meets_it_and_leans(chest: Compilation) -> None:
    exact = made(ON_THE_CHEST, precise=True)
    assert exact.report.met
    assert exact.report.strains == ()
    assert lean_deg(exact) > 20


def test_people_read_what_was_eased_and_at_which_price(chest: Compilation) -> None:
    (place,) = eases(chest.report)
    everything = len(chest.report.constraints)
    assert outcome(chest.report) == f"1 of {everything} constraints is eased for comfort"
    assert place.residual is not None
    assert place.price is not None
    trunk = np.degrees(place.price.trunk_rad)
    assert 20 < trunk < 35
    said = (
        f"off by {1000 * place.residual:.1f} mm for comfort: "
        f"meeting it would take {trunk:.0f}° of trunk"
    )
    assert shortfall(place).startswith(said)


def test_the_report_has_outcome_price_and_strains(chest: Compilation) -> None:
    rows = chest.report.as_json()["constraints"]
    assert isinstance(rows, list)
    (row,) = [r for r in rows if r["outcome"] == "eased"]
    assert row["met"] is False
    assert row["reason"] is None
    assert row["price"]["trunk_rad"] == pytest.approx(np.radians(28), abs=np.radians(4))
    assert all(r["price"] is None for r in rows if r["outcome"] == "met")


def test_people_read_what_the_trunk_leans_for() -> None:
    far = made(FAR)
    (line,) = strains(far.report)
    found = re.fullmatch(
        r"0\.00 s: the trunk leans (\d+)° for place @I_TIP\(s\) point\(-0\.15, -0\.1, 0\.74\)", line
    )
    assert found
    assert int(found[1]) == pytest.approx(lean_deg(far), abs=1.5)
    rows = far.report.as_json()["strains"]
    assert isinstance(rows, list)
    (strain,) = rows
    assert strain["for"] == ["place @I_TIP(s) point(-0.15, -0.1, 0.74)"]


@pytest.mark.slow
def test_what_a_hold_eases_stays_as_it_is_while_the_head_shakes() -> None:
    shaken = made(SHAKEN, fps=60.0)
    assert misses(shaken.report) == []
    assert eases(shaken.report)
    arms = [v for v, n in enumerate(shaken.rig.coordinates.names) if n.startswith(("arm", "clav"))]
    held = [p.coordinates[arms] for p in shaken.report.postures if p.time <= HELD_S]
    assert len(held) >= 2
    assert np.ptp(np.degrees(held), axis=0).max() < 0.01
