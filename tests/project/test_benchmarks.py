"""The benchmarks run, at a tiny size, and what they measure is right."""

from __future__ import annotations

import itertools
import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from azee_rig.rig import Rig
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Side
from benchmarks import continuity, films, frames, solver_bench
from benchmarks.ik.armature import bare_armature, pinned
from benchmarks.ik.comparison import Miss, Row, behind_best, compared, of_solvable, row
from benchmarks.ik.elsewhere import Environment, NotThere, ordered_steps
from benchmarks.ik.goals import REACHABLE, Goal
from benchmarks.ik.levenberg import Flat
from benchmarks.ik.methods import METHODS
from benchmarks.ik.problems import TIGHT, Maker


@pytest.mark.slow
def test_all_methods_answer_all_classes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out.json"
    solver_bench.main(
        [
            "--count",
            "1",
            "--inside",
            "--only",
            "comparison",
            "--body",
            "armature",
            "--json",
            str(out),
        ]
    )
    document = json.loads(out.read_text(encoding="utf-8"))
    rows = {(r["body"], r["class"], r["method"]): r for r in document["comparison"]}
    assert len(rows) == 7 * len(METHODS)
    for (_, kind, method), found in rows.items():
        assert found["median_s"] > 0
        if kind in REACHABLE and method.startswith(("ours", "LM")):
            assert found["met_1mm_05deg"] == 1
        if method.startswith("ours"):
            assert found["limit_excess_deg"] == 0
    assert all(goal["kept"] in (True, False, None) for goal in document["goals"])
    table = capsys.readouterr().out
    assert "IK problems in" in table
    assert "LM kernel" in table


def test_problems_repeat_and_their_postures_solve_them(signer: Rig) -> None:
    for rig in (bare_armature(signer), pinned(signer)):
        maker, evaluator = Maker(rig), Evaluator(rig, Side.RIGHT)
        for kind in REACHABLE:
            (first,), (again, _) = maker.problems(kind, 1), maker.problems(kind, 2)
            assert first.tasks == again.tasks
            assert first.truth is not None
            assert np.all(rig.coordinates.lower <= first.truth)
            assert np.all(first.truth <= rig.coordinates.upper)
            frames = rig.chain.frames(first.truth)
            for constraint in first.constraints:
                residual, unit = evaluator.residual(constraint, frames, first.truth)
                assert residual < 0.02 * TIGHT[unit == "rad"]


@pytest.mark.slow
def test_the_yardstick_measures_what_the_rig_does(signer: Rig) -> None:
    for rig in (bare_armature(signer), pinned(signer)):
        (tree,) = Maker(rig).problems("tree", 1)
        answer = METHODS["LM kernel"](rig, tree)
        assert Flat(rig, tree.constraints, tree.free, TIGHT).worst(answer.q) <= 1
        assert row("", rig, "", [tree], [answer]).met(TIGHT) == 1


@pytest.mark.slow
def test_the_yardstick_s_jacobian_is_that_of_its_residuals(signer: Rig) -> None:
    rng = np.random.default_rng(1)
    for rig in (bare_armature(signer), pinned(signer)):
        (tree,) = Maker(rig).problems("tree", 1)
        flat = Flat(rig, tree.constraints, tree.free, TIGHT)
        q = rng.uniform(rig.coordinates.lower, rig.coordinates.upper)
        _, jacobian = flat.residuals(q)
        for column, v in enumerate(flat.free):
            up, down = q.copy(), q.copy()
            up[v] += 1e-6
            down[v] -= 1e-6
            slope = (flat.residuals(up)[0] - flat.residuals(down)[0]) / 2e-6
            np.testing.assert_allclose(jacobian[:, column], slope, atol=1e-4)


@pytest.mark.slow
def test_ours_is_as_near_to_what_is_out_of_reach_as_any_method(signer: Rig) -> None:
    names = ("ours, no collision", "LM kernel", "scipy trf")
    chosen = {name: METHODS[name] for name in names}
    rig = bare_armature(signer)
    (rows,) = compared("armature", rig, ["unreachable"], 3, chosen, {})
    assert behind_best(rows)["ours, no collision"] <= 0.5e-3
    assert all(met <= of for met, of in of_solvable(rows).values())


def test_a_trunk_that_an_arm_could_do_without_comes_back_over_many_steps(signer: Rig) -> None:
    found = [report for _, report in itertools.islice(continuity.swept(signer, "palm", 9), 25)]
    assert all(report.met for report in found)
    postures = np.degrees([report.coordinates for report in found])
    assert np.max(np.abs(np.diff(postures, axis=0))) <= 2.0
    trunk = [v for v, name in enumerate(signer.coordinates.names) if name.startswith("back")]
    away = np.linalg.norm((postures - np.degrees(signer.coordinates.idle))[:, trunk], axis=1)
    assert 0.0 < away[-1] < away[0]


@pytest.mark.slow
def test_where_the_arm_alone_would_leap_more_of_the_body_shares_the_way(signer: Rig) -> None:
    """Its wrist would turn by 16° within a millimetre, for the elbow is nearly straight there."""
    way = continuity.swept(signer, "palm, facing", 11)
    found = [report for _, report in itertools.islice(way, 225, 248)]
    assert all(report.met for report in found)
    postures = np.degrees([report.coordinates for report in found])
    assert np.max(np.abs(np.diff(postures, axis=0))) <= 4.0


def test_the_tree_is_eleven_ordered_problems_for_others(signer: Rig) -> None:
    rig = bare_armature(signer)
    (tree,) = Maker(rig).problems("tree", 1)
    steps = ordered_steps(rig, tree)
    assert [len(indices) for _, indices in steps] == [3, 1, 4, *[1] * 8]
    names = rig.coordinates.names
    assert not any(names[v].startswith("arm_R") for v in steps[2][0])


def test_an_environment_that_cannot_be_made_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    failed = subprocess.CompletedProcess([], 1, "", "much\nERROR: no matching distribution\n")
    monkeypatch.setattr("venv.create", lambda *_, **__: None)
    monkeypatch.setattr("subprocess.run", lambda *_, **__: failed)
    nowhere = Environment("nothing", "azee-nothing==0", "none.py", ordered=True)
    assert not nowhere.is_ready
    with pytest.raises(NotThere, match="azee-nothing==0 cannot be installed: ERROR: no matching"):
        nowhere.prepare()


def made(method: str, *answers: tuple[float, float]) -> Row:
    """A row of answers by what they miss and how deep they overlap, millimetres."""
    misses = tuple(Miss(n, 1e-3 * miss, 0.0) for n, (miss, _) in enumerate(answers))
    nothing = (0,) * len(answers)
    depths = tuple(1e-3 * depth for _, depth in answers)
    return Row("signer", "unreachable", method, nothing, nothing, misses, depths, 0.0, ())


def test_only_answers_outside_the_body_are_compared_with_one_that_stays_there() -> None:
    rows = [
        made("through", (90.0, 40.0), (0.2, 40.0), (0.2, 0.0)),
        made("around", (95.0, 1.0), (8.0, 0.0), (0.4, 0.0)),
        made("beside", (94.7, 2.0), (8.0, 9.0), (5.0, 0.0)),
    ]
    assert behind_best(rows)["around"] == pytest.approx(7.8e-3)
    assert behind_best(rows, 3e-3)["around"] == pytest.approx(0.3e-3)
    # Of the second problem no answer that counts meets anything.
    assert of_solvable(rows)["around"] == (1, 2)
    assert of_solvable(rows, 3e-3)["around"] == (1, 1)


def test_a_goal_knows_whether_it_is_kept() -> None:
    assert Goal("a", 2.0, at_most=1.0).kept is False
    assert Goal("a", 2.0, at_least=2.0).kept is True
    assert Goal("a", 2.0).kept is None


@pytest.mark.slow
def test_frames_are_judged_from_the_report(capsys: pytest.CaptureFixture[str]) -> None:
    frames.main(["bonjour"])
    told = capsys.readouterr().out
    assert "2 clips, " in told
    assert "0 missed, 0 of them without a reason; 0 clips beyond limits; 0 with skin" in told


def test_pictures_are_compared_pixel_by_pixel() -> None:
    black = np.zeros((2, 2, 3), dtype=np.uint8)
    other = black.copy()
    other[0, 0] = 0, 17, 0
    other[1, 1] = 16, 0, 1
    assert films.apart([black], [other]) == films.Apart(34 / 12, 0.25)
    assert films.apart([other, black], [black, black]) == films.Apart(34 / 24, 0.125)


@pytest.mark.slow
def test_a_film_is_drawn_by_both_renderers(capsys: pytest.CaptureFixture[str], opengl: str) -> None:
    films.main(["--frames", "8", "--size", "64x48", "--rounds", "1"])
    told = capsys.readouterr().out
    assert opengl in told
    rows = [line.split()[:2] for line in told.splitlines()[3:]]
    assert rows[:3] == [["front", "software"], ["front", "opengl"], ["front", "apart"]]
    assert len(rows) == 9


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "number"),
    [("place, 2 at stops", 41), ("place, 2 at stops", 64), ("two-handed contact", 58)],
)
def test_what_searches_that_ended_too_soon_have_missed(signer: Rig, kind: str, number: int) -> None:
    """Near misses are searched further, unequal ends prove nothing, hands come out of the body."""
    rig = pinned(signer)
    asked = next(itertools.islice(Maker(rig).problems(kind, number + 1), number, None))
    answer = METHODS["ours, everything on"](rig, asked)
    assert row("", rig, "", [asked], [answer]).met(TIGHT) == 1
