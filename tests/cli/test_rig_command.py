"""`azee rig` tells what a body has: as tables, JSON that keeps to its schema, and pictures."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from formats import schema
from PIL import Image

from azee.cli.main import run
from azee_grammar.vocabulary import BONES, MORPHS, SITES
from azee_rig.rig import Rig
from azee_rig.site_check import AtBind, OverRange

LISTS = ("sites", "bones", "limits", "coordinates", "morphs")


def listed(what: str, capsys: pytest.CaptureFixture[str]) -> list[dict[str, Any]]:
    assert run(["rig", what, "--format", "json"]) == 0
    document = json.loads(capsys.readouterr().out)
    jsonschema.validate(document, schema("rig"))
    assert document["rig"] == "signer"
    rows: list[dict[str, Any]] = document[what]
    return rows


def test_json_has_all_that_the_body_has(capsys: pytest.CaptureFixture[str], signer: Rig) -> None:
    found = {what: listed(what, capsys) for what in LISTS}
    assert {row["name"] for row in found["sites"]} == set(SITES)
    assert {row["name"]: row["parent"] for row in found["bones"]} == dict(BONES)
    assert {row["name"] for row in found["morphs"]} == set(MORPHS)
    names = list(signer.coordinates.names)
    assert [row["coordinate"] for row in found["limits"]] == names
    assert [row["name"] for row in found["coordinates"]] == names
    for row in found["morphs"]:
        shown = bool(row["coordinates_rad"] or row["units"])
        assert shown == (row["not_shown"] is None), row["name"]
    tip = next(row for row in found["sites"] if row["name"] == "I_TIP_R")
    skin = np.linalg.norm(signer.mesh.vertices - tip["position_m"], axis=1)
    assert skin.min() < 0.005


@pytest.mark.parametrize("what", LISTS)
def test_a_table_has_a_line_for_each(what: str, capsys: pytest.CaptureFixture[str]) -> None:
    rows = listed(what, capsys)
    assert run(["rig", what]) == 0
    lines = capsys.readouterr().out.splitlines()
    names = [row.get("name") or row["coordinate"] for row in rows]
    assert [line.split()[0] for line in lines[1:] if not line.startswith(" ")] == names


def test_tables_speak_in_degrees(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["rig", "limits"]) == 0
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert ["f_arm_R.flexion", "0.0", "145.0"] in lines


@pytest.mark.slow
@pytest.mark.parametrize("what", ["sites", "bones"])
def test_a_picture_is_written(what: str, tmp_path: Path) -> None:
    target = tmp_path / "out.png"
    assert run(["rig", what, "--picture", str(target)]) == 0
    with Image.open(target) as image:
        assert min(image.size) > 500
        assert len(set(image.convert("L").get_flattened_data())) > 100


@pytest.mark.slow
def test_the_check_finds_the_signer_s_sites_on_its_skin(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert run(["rig", "check", "--format", "json"]) == 0
    document = json.loads(capsys.readouterr().out)
    jsonschema.validate(document, schema("rig"))
    assert {row["site"] for row in document["at_bind"]} == set(SITES)
    assert {row["site"] for row in document["over_range"]} == set(SITES)


def test_the_check_lists_ten_and_tells_what_is_wrong(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    bad = AtBind("CH", 0.004, -0.2, 1.0, 1.0, 0.0)
    monkeypatch.setattr("azee_rig.site_check.at_bind", lambda rig: (bad,))
    ranged = tuple(OverRange(site, -0.0072, {"head.flexion": 0.5}) for site in list(SITES)[:12])
    monkeypatch.setattr("azee_rig.site_check.over_range", lambda rig: ranged)
    assert run(["rig", "check"]) == 3
    out = capsys.readouterr().out
    assert "CH: 4.0 mm off the skin" in out
    assert "CH: its normal does not look outward" in out
    assert out.count("head.flexion 28.6°") == 10
    assert f"too far off: {', '.join(list(SITES)[:12])}" in out


def test_what_cannot_be_drawn_or_written_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["rig", "coordinates", "--picture", str(tmp_path / "x.png")]) == 2
    assert "azee rig limits --picture" in capsys.readouterr().err
    assert run(["rig", "sites", "--picture", str(tmp_path / "x.gif")]) == 2
    assert run(["rig", "sites", "--picture", str(tmp_path / "no" / "x.png")]) == 1
    assert "there is no folder" in capsys.readouterr().err
    assert run(["rig", "sites", "--rig", "nobody"]) == 2
    assert list(tmp_path.iterdir()) == []
