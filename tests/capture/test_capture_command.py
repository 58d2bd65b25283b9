"""`azee capture`: the whole way, and what it says of bad input."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from formats import schema
from jsonschema import validate
from recorded_hand import CHOSEN, FILE

from azee.cli.main import run
from azee.clips import open_clip

BAD = {
    "no markers": (["choose", "text.trc"], "it is no TRC"),
    "no file": (["choose", "none.c3d"], "there is no file"),
    "too many": (["choose", str(FILE), "--count", "11"], "11 of 10 markers cannot be chosen"),
    "unit": (["choose", str(FILE), "--unit", "m"], "more than 1000 m away|the hand is .* m wide"),
    "label": (["choose", str(FILE), "--label", "a=b"], "there is no marker `b`"),
    "root": (["choose", str(FILE), "--root", "index_tip"], "the root needs 3 markers, not 1"),
    "model": (["reconstruct", str(FILE), "--model", str(FILE), "-o", "x.npz"], "is no model"),
    "chosen": (["train", str(FILE), "--markers", "toe", "-o", "m.npz"], "there is no marker `toe`"),
}


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("text.trc").write_text("hello")


@pytest.mark.parametrize("name", BAD)
def test_bad_input_gets_one_message(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    arguments, message = BAD[name]
    assert run(["capture", *arguments]) == 1
    told = capsys.readouterr().err
    assert told.count("error[") == 1
    assert re.search(message, told)


@pytest.mark.slow
def test_a_hand_is_trained_reconstructed_and_played(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["capture", "choose", str(FILE), "--count", "3", "--format", "json"]) == 0
    chosen = json.loads(capsys.readouterr().out)
    assert len(chosen["markers"]) == 3
    names = ",".join(CHOSEN)
    assert run(["capture", "train", str(FILE), "--markers", names, "-o", "m.npz"]) == 0
    first = Path("m.npz").read_bytes()
    assert run(["capture", "train", str(FILE), "--markers", names, "-o", "m.npz"]) == 0
    assert Path("m.npz").read_bytes() == first
    made = ["reconstruct", str(FILE), "--model", "m.npz", "--report", "r.json"]
    assert run(["capture", *made, "-o", "hand.npz", "-o", "hand.bvh", "-o", "hand.glb"]) == 0
    validate(json.loads(Path("r.json").read_text()), schema("capture"))
    clip = open_clip("hand.npz").clip
    assert len(clip.times) == 1200
    again = open_clip("hand.bvh").clip
    np.testing.assert_allclose(again.coordinates, clip.coordinates, atol=1e-3)
    assert run(["capture", *made[:4], "--over", "hand.npz", "--start", "3", "-o", "b.npz"]) == 0
    assert run(["capture", *made[:4], "--rig", "child", "-o", "c.npz"]) == 0
    assert open_clip("c.npz").rig.name == "child"


@pytest.mark.slow
def test_an_evaluation_has_tables_and_figures() -> None:
    assert run(["capture", "evaluate", str(FILE), "-o", "found", "--quick", "--quiet"]) == 0
    found = json.loads(Path("found/evaluation.json").read_text())
    best = {
        (row["choice"], row["count"]): np.mean(row["unseen_mm"])
        for row in found["rows"]
        if row["method"] == "regression"
    }
    assert best["ours", 6] < best["finger tips", 5] * 1.2 < best["ours", 3] * 1.2
    assert len(list(Path("found").glob("figure-*.png"))) == 5
