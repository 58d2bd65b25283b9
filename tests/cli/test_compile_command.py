"""`azee compile` on texts that are right: formats, options, exit codes, the library call."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import jsonschema
import numpy as np
import pytest
from formats import schema
from programs import Python

import azee
from azee.cli.main import run
from azee.formats import SUFFIXES

TOUCH = """\
key .5
    cstr
        place @I_TIP(s) @CH
        orient 'nrm !palm(s) 'along in(s)
"""
TWO = "key .5 (look ^fwd)\nkey .5 (rotate !head ^up 20)\n"
OUT_OF_REACH = "key .2 (place @PA(s) point(0, 0, 3))\n"


@pytest.fixture(autouse=True)
def _in_a_folder_with_texts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name, text in {"touch": TOUCH, "two": TWO, "far": OUT_OF_REACH}.items():
        Path(f"{name}.azee").write_text(text, encoding="utf-8")


def _clip(path: str) -> dict[str, Any]:
    document: dict[str, Any] = json.loads(Path(path).read_text(encoding="utf-8"))
    return document


@pytest.mark.slow
def test_every_format_from_one_solution(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import azee.animation as motion

    calls = []
    original = motion.animate

    def counted(*arguments: Any, **options: Any) -> Any:
        calls.append(arguments)
        return original(*arguments, **options)

    monkeypatch.setattr(motion, "animate", counted)
    outputs = [f"touch{suffix}" for suffix in SUFFIXES]
    arguments = [word for output in outputs for word in ("-o", output)]
    assert (
        run(["compile", "touch.azee", "--precise", *arguments, "--report", "touch.report.json"])
        == 0
    )
    assert len(calls) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    for output in [*outputs, "touch.report.json"]:
        assert Path(output).stat().st_size > 500
        assert f"wrote {output} (" in captured.err
    assert "all 2 constraints are met" in captured.err
    jsonschema.validate(_clip("touch.json"), schema("clip"))
    jsonschema.validate(_clip("touch.report.json"), schema("report"))


def test_the_body_does_what_the_text_says() -> None:
    assert run(["compile", "touch.azee", "--precise", "-o", "touch.json", "--quiet"]) == 0
    made = azee.compile(Path("touch.azee"), precise=True)
    assert made.report.met
    rig, clip = made.rig, made.clip
    middle = np.abs(clip.times - (made.report.lead_s + 0.25)).argmin()
    frames = rig.chain.frames(clip.coordinates[middle])

    def world(site: str) -> Any:
        return rig.sites[site].point(frames)

    assert np.linalg.norm(world("I_TIP_R") - world("CH")) < 1e-3
    np.testing.assert_allclose(_clip("touch.json")["times"], clip.times, atol=1e-6)


def test_the_other_hand_signs_for_a_left_handed_signer() -> None:
    right = azee.compile(TOUCH, life=False)
    left = azee.compile(TOUCH, dominant="left", life=False)
    names = right.rig.coordinates.index
    for made, moved, still in ((right, "R", "L"), (left, "L", "R")):
        ranges = np.ptp(made.clip.coordinates, axis=0)
        assert ranges[names[f"f_arm_{moved}.flexion"]] > 0.2
        assert ranges[names[f"f_arm_{still}.flexion"]] < 1e-6


@pytest.mark.slow
def test_the_published_method_counts_its_iterations(capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["-o", "touch.json", "--report", "r.json", "--solver", "two-level"]
    assert run(["compile", "touch.azee", *arguments]) == 0
    report = _clip("r.json")
    jsonschema.validate(report, schema("report"))
    counts = [problem["iterations"] for problem in report["problems"]]
    assert f"1 IK problem in {sum(counts)} iterations" in capsys.readouterr().err
    made = azee.compile(Path("touch.azee"), solver="two-level")
    assert made.report.as_json()["problems"] == report["problems"]


def test_frames_come_as_often_as_asked() -> None:
    for fps in (12, 60):
        assert run(["compile", "two.azee", "-o", "a.json", "--fps", str(fps), "--quiet"]) == 0
        np.testing.assert_allclose(np.diff(_clip("a.json")["times"]), 1 / fps, atol=2e-6)


def test_utterances_play_one_after_the_other_or_alone() -> None:
    both, first = azee.compile(TWO), azee.compile(TWO, utterance=1)
    assert both.score.duration == 2
    assert first.score.duration == 0.5
    expression = azee.compile(TWO, expression="key 3 (look ^up)")
    assert expression.score.duration == 3


@pytest.mark.long
def test_standard_input_and_expressions(python: Python, capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--no-life", "--fps", "10"]
    python("-m", "azee", "compile", "-", "-o", "a.json", *options, stdin=TOUCH, expect=0)
    assert run(["compile", "touch.azee", "-o", "b.json", *options]) == 0
    assert Path("a.json").read_bytes() == Path("b.json").read_bytes()
    capsys.readouterr()
    assert run(["compile", "-e", "key .5 (look ^fwd)"]) == 0
    said = capsys.readouterr()
    assert "nothing written" in said.err
    assert said.out == ""


@pytest.mark.long
def test_the_same_text_gives_the_same_bytes() -> None:
    for name in ("a.glb", "b.glb"):
        assert run(["compile", "touch.azee", "-o", name, "--quiet"]) == 0
    assert Path("a.glb").read_bytes() == Path("b.glb").read_bytes()


@pytest.mark.long
def test_json_for_scripts(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["compile", "touch.azee", "-o", "touch.bvh", "--format", "json"]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    document = json.loads(captured.out)
    assert document["outputs"] == ["touch.bvh"]
    jsonschema.validate(document, schema("diagnostics"))
    jsonschema.validate(document["report"], schema("report"))


def test_json_for_scripts_that_are_wrong(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["compile", "-e", ":wardrob", "-o", "x.bvh", "--format", "json"]) == 1
    captured = capsys.readouterr()
    assert captured.err == ""
    document = json.loads(captured.out)
    jsonschema.validate(document, schema("diagnostics"))
    assert [d["code"] for d in document["diagnostics"]] == ["unknown-rule"]
    assert document["outputs"] == []
    assert not Path("x.bvh").exists()


def test_an_expression_does_not_hide_what_is_wrong_with_its_file(
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path("broken.azee").write_text("def a\n    key 1 (look ^nowhere)\n", encoding="utf-8")
    assert run(["compile", "broken.azee", "-e", "key 1 (look ^fwd)", "-o", "x.bvh"]) == 1
    assert "error[unknown-name]" in capsys.readouterr().err


def test_a_miss_is_named_and_strict_makes_it_count(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["compile", "far.azee", "-o", "far.bvh", "--quiet"]) == 0
    assert capsys.readouterr().err == ""
    assert run(["compile", "far.azee", "-o", "far.bvh", "--strict"]) == 3
    told = capsys.readouterr().err
    assert "1 constraint is out of tolerance:" in told
    assert "place @PA(s)" in told
    assert "mm" in told
    assert Path("far.bvh").exists()
    assert run(["compile", "touch.azee", "--strict", "--quiet"]) == 0


def test_what_is_too_fast_for_the_frames_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    circling = "key 1 (place @I_TIP(s) (moving (circle ^fwd .02 6) ^Mssp ^Mssp))"
    assert run(["compile", "-e", circling, "--fps", "10"]) == 0
    told = capsys.readouterr().err
    assert "warning[beyond-frames]: no 10 frames a second can show 6 turns a second\n" in told
    trilling = "key 1 (trill !palm(s) ^up 'freq 6)"
    assert run(["compile", "-e", trilling, "--fps", "10", "--strict"]) == 3
    told = capsys.readouterr().err
    assert "no 10 frames a second can show 6 oscillations" in told
    assert run(["compile", "-e", trilling, "--fps", "12", "--strict"]) == 0


def test_a_fault_while_writing_leaves_no_file(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("azee.export.files.os.fsync", full)
    before = sorted(Path().iterdir())
    assert run(["compile", "two.azee", "-o", "two.bvh"]) == 1
    assert "error[cannot-write]: cannot write `two.bvh`: no space left" in capsys.readouterr().err
    assert sorted(Path().iterdir()) == before


def test_the_library_takes_paths_and_texts(tmp_path: Path) -> None:
    scores = [azee.compile(given).score for given in ("two.azee", Path("two.azee"), TWO)]
    assert scores[0] == scores[1] == scores[2]
    with pytest.raises(azee.AZeeError, match="cannot-read"):
        azee.compile("missing.azee")
    with pytest.raises(ValueError, match="suffix"):
        azee.compile(TWO).save(tmp_path / "x.docx")
    with pytest.raises(azee.AZeeError, match="cannot-write"):
        azee.compile(TWO).save(tmp_path / "missing" / "x.bvh")


@pytest.mark.long
def test_a_rig_that_lacks_a_name_signs_the_rest_or_is_refused() -> None:
    from dataclasses import replace

    from azee.compilation import perform
    from azee_rig.load import load_rig

    rig = load_rig()
    sites = {name: site for name, site in rig.sites.items() if name != "CH"}
    score = azee.compile(TOUCH).score
    with pytest.raises(azee.AZeeError, match="rig-lacks-site") as caught:
        perform(score, replace(rig, sites=sites), strict_body=True)
    (diagnostic,) = caught.value.diagnostics
    assert "`@CH`" in diagnostic.message
    made = perform(score, replace(rig, sites=sites))
    (warning,) = made.left_out
    assert (warning.code, warning.severity.value) == ("rig-lacks-site", "warning")
    assert "left out" in warning.message
    assert made.report_json()["left_out"] == [{"code": warning.code, "message": warning.message}]
    assert not [c for c in made.report.constraints if "@CH" in c.target]


HURRIED = """\
sync
    'A (key .4 (place @PA(s) point(.1, -.1, .28)))
    'B (key .4 (place @PA(s) point(-.4, -.1, .28)))
    'start 'A:end:.2
"""
"""Half a metre in .2 s."""


@pytest.mark.long
def test_what_takes_longer_is_told_unless_the_times_are_to_be_exact(
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path("hurried.azee").write_text(HURRIED, encoding="utf-8")
    assert run(["compile", "hurried.azee", "--fps", "10", "--report", "r.json"]) == 0
    (stretch,) = json.loads(Path("r.json").read_text(encoding="utf-8"))["stretched"]
    assert (stretch["from"], stretch["to"], stretch["hand"]) == (["A"], ["B"], "right")
    extra_s = stretch["performed_s"] - stretch["score_s"]
    said = f"1 transition is longer than the score says, by {extra_s:.2f} s; --timing exact keeps"
    assert said in capsys.readouterr().err
    assert run(["compile", "hurried.azee", "--fps", "10", "--timing", "exact"]) == 0
    assert "longer than" not in capsys.readouterr().err


def test_a_drawn_score_has_the_times_of_the_text_with_tracks_too() -> None:
    Path("hurried.azee").write_text(HURRIED, encoding="utf-8")
    assert run(["score", "hurried.azee", "--tracks", "-o", "s.eaf"]) == 0
    slots = ElementTree.parse("s.eaf").iter("TIME_SLOT")
    assert max(int(slot.attrib["TIME_VALUE"]) for slot in slots) == 1000


def test_tempo_is_an_option_of_the_command_and_the_library(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert run(["compile", "two.azee", "--tempo", "2", "--report", "r.json", "--fps", "10"]) == 0
    report = json.loads(Path("r.json").read_text(encoding="utf-8"))
    plain = azee.compile(TWO, fps=10)
    assert (report["tempo"], report["score_s"]) == (2.0, plain.report.score_s / 2)
    assert azee.compile(TWO, fps=10, tempo=2).score.duration == plain.score.duration / 2
    assert run(["compile", "two.azee", "--tempo", "0"]) == 2
    assert "--tempo" in capsys.readouterr().err
    with pytest.raises(ValueError, match=r"nobody signs 0 times as fast; tempo is a number from"):
        azee.compile(TWO, tempo=0)
    with pytest.raises(ValueError, match="there is no timing 'loose'; the timings are: performed"):
        azee.compile(TWO, timing="loose")  # type: ignore[arg-type]
