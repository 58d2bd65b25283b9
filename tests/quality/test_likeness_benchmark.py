"""The tables of likeness: what they mark, count and write, and that the benchmark runs."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

import azee
from azee.motion.tasks.signs import Sign
from azee.quality.head_and_gaze import HeadUnderGaze
from azee.quality.kinematics import Extreme
from azee.quality.likeness import Likeness
from azee.quality.repetitions import Repetition
from azee.quality.transitions import Transition
from benchmarks import likeness
from benchmarks.likeness_figures import FIGURES, Figure


@cache
def measured() -> Likeness:
    return azee.compile("key(.5, place(@I_TIP(s), ^Mssp))", life=False).report.likeness


def figure(title: str) -> Figure:
    return next(f for f in FIGURES if f.title == title)


def fast(value: float) -> Likeness:
    return replace(measured(), transitional_wrist_speed_m_s=Extreme(value, "palm_R", 0.5))


def ways(*percents: float) -> Likeness:
    found = tuple(Repetition("R", 0.0, 1.0, p) for p in percents)
    return replace(measured(), repetitions=found)


def test_a_figure_beyond_its_target_is_marked() -> None:
    speed = figure("wrist between signs")
    assert speed.target == "≤ 2.5"
    assert likeness.cell(speed, fast(2.5), "{}*") == "2.50"
    assert likeness.cell(speed, fast(2.51), "{}*") == "2.51*"
    none = replace(measured(), transitional_wrist_speed_m_s=None)
    assert likeness.cell(speed, none, "{}*") == "–"
    assert speed.judged(none) is None
    assert figure("signs").judged(measured()) is None


def test_all_repetitions_must_keep_both_bounds() -> None:
    again = figure("repetition")
    assert again.target == "2–8"
    assert again.judged(ways(2.0, 8.0)) is True
    assert again.judged(ways(1.9, 5.0)) is False
    assert again.judged(ways(5.0, 8.1)) is False
    assert again.text((3.0, 5.04, 4.0)) == "3.0–5.0"
    assert again.beyond((0.5, 9.0)) == pytest.approx(1.5)
    assert again.beyond((3.0, 9.0)) == pytest.approx(1.0)


def test_stopped_hands_are_judged_from_two_signs_on() -> None:
    stopped = figure("hands stopped")
    one = replace(measured(), signs=(Sign("a", 0, 1),))
    two = replace(measured(), signs=(Sign("a", 0, 1), Sign("b", 1, 2)))
    assert stopped.judged(one) is None
    assert stopped.judged(two) is not None


def test_verdicts_count_and_name_the_worst() -> None:
    found = [likeness.Case((name,), fast(v)) for name, v in (("a", 2.0), ("b", 9.0), ("c", 4.0))]
    verdict = next(v for v in likeness.verdicts(found) if v.figure.title == "wrist between signs")
    assert (verdict.judged, verdict.kept) == (3, 1)
    assert verdict.line == "wrist between signs ≤ 2.5 m/s: 1 of 3; worst 9.00 in b"
    lines = [*likeness.summary(found)]
    assert "MISSED wrist between signs ≤ 2.5 m/s: 1 of 3; worst 9.00 in b" in lines
    assert "holds  wrist between signs ≤ 2.5 m/s: 1 of 1" in [*likeness.summary(found[:1])]
    assert any(line.startswith("none   head back") for line in lines)


def test_transitions_of_all_clips_are_correlated_together() -> None:
    pairs = [
        tuple(Transition("R", 0.0, 0.1 * n, 0.05 * n, None) for n in (1, 2)),
        tuple(Transition("L", 0.0, 0.1 * n, 0.05 * n, None) for n in (3, 4)),
    ]
    found = [likeness.Case(("a",), replace(measured(), transitions=p)) for p in pairs]
    r, count = likeness.pooled(found)
    assert r == pytest.approx(1.0)
    assert count == 4
    last = [*likeness.summary(found)][-1]
    assert last == "holds  time with distance over all 4 transitions ≥ 0.5: 1.00"


def test_cases_with_the_same_figures_are_one() -> None:
    a, b = likeness.Case(("a",), fast(1.0)), likeness.Case(("b",), fast(1.0))
    found = likeness.merged([a, likeness.Case(("c",), fast(2.0)), b])
    assert [case.names for case in found] == [("a", "b"), ("c",)]
    assert found[0].name == "a and 1 more"


def test_the_table_and_the_page_have_a_row_a_case(tmp_path: Path) -> None:
    case = likeness.Case((":a", "b"), fast(9.0))
    roll = HeadUnderGaze(Extreme(1.0, "head", 0.0), 0.2)
    other = likeness.Case(("c",), replace(measured(), head_under_gaze=roll))
    lines = [*likeness.printed([case, other])]
    assert lines[-2].startswith(":a and 1 more")
    assert "9.00*" in lines[-2]
    assert len({len(line.rstrip()) for line in lines if line}) > 1
    page = tmp_path / "page.md"
    page.write_text("before\n<!-- a -->\nold\n<!-- b -->\nafter\n", encoding="utf-8")
    likeness.rewrite(page, "<!-- a -->", "<!-- b -->", likeness.page([case, other]))
    text = page.read_text(encoding="utf-8")
    assert text.startswith("before\n<!-- a -->\n\n| target |")
    assert text.endswith("\n\n<!-- b -->\nafter\n")
    assert "| `:a`, `b` | **9.00** |" in text
    assert "old" not in text


def test_the_page_has_the_markers() -> None:
    text = likeness.PAGE.read_text(encoding="utf-8")
    assert text.index(likeness.BEGIN) < text.index(likeness.END)
    targets = [f.title for f in FIGURES if f.target]
    for title in targets:
        assert title.split(",")[0] in text or title in ("head still", "trunk still")


def test_an_unknown_case_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        likeness.main(["--case", "nobody"])
    assert "no example, rule or text called nobody" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        likeness.main(["--case", ":bien", "--page"])


@pytest.mark.slow
def test_the_benchmark_measures_a_text_an_example_and_a_rule(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "likeness.json"
    names = ("to-and-fro", "cinema-good", ":bien")
    likeness.main([*(a for name in names for a in ("--case", name)), "-o", str(out)])
    table = capsys.readouterr().out
    document = json.loads(out.read_text(encoding="utf-8"))
    assert {n for case in document["cases"] for n in case["names"]} == set(names)
    for case in document["cases"]:
        assert [f["figure"] for f in case["figures"]] == [f.title for f in FIGURES]
        assert case["likeness"]["signs"]
    for name in names:
        assert f"\n{name} " in table
    assert document["summary"] == [line for line in table.splitlines() if ": " in line]
