"""`azee compile --profile`: the stages of a command, which together are the whole process."""

from __future__ import annotations

import json
import time

import jsonschema
import pytest
from formats import schema
from programs import Python

from azee.cli.main import run
from azee.cli.profile import Profile

TOUCH = "key .5 (place @I_TIP(s) @CH)"


@pytest.mark.slow
def test_the_stages_of_a_process_are_its_whole_time(python: Python) -> None:
    began = time.perf_counter()
    done = python(
        "-m", "azee", "compile", "-e", TOUCH, "--profile", "--format", "json", "-o", "a.bvh",
        expect=0,
    )  # fmt: skip
    elapsed = time.perf_counter() - began
    profile = json.loads(done.stdout)["profile"]
    jsonschema.validate(profile, schema("profile"))
    assert 0.5 * elapsed < profile["total_s"] < elapsed + 0.02
    top = {stage["name"]: stage["seconds"] for stage in profile["stages"] if not stage["within"]}
    assert sum(top.values()) == pytest.approx(profile["total_s"], rel=0.02)
    assert top["the rest"] < 0.1 * profile["total_s"]
    assert {"parsing", "evaluating", "loading the kernels", "solving", "writing a.bvh"} <= set(top)
    solved = [stage for stage in profile["stages"] if stage["within"] == "solving"]
    assert any("@I_TIP(s)" in stage["name"] for stage in solved)
    assert sum(stage["seconds"] for stage in solved) <= top["solving"]


def test_the_table_goes_to_standard_error(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["compile", "-e", TOUCH, "--quiet", "--profile"]) == 0
    captured = capsys.readouterr()
    assert captured.out == ""
    rows = captured.err.splitlines()
    assert rows[-1].split()[:2] == ["whole", "process"]
    assert all(row.rstrip().endswith(("ms", "%")) for row in rows)


def test_a_profile_costs_next_to_nothing() -> None:
    profile = Profile()
    began = time.perf_counter()
    for n in range(100):
        with profile.stage(str(n)):
            pass
    assert time.perf_counter() - began < 0.05
