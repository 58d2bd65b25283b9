"""Reports, GLB and ELAN files say how far the rules of their text are known."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import jsonschema
import pympi
import pytest
from formats import schema

import azee
from azee.cli.main import run

SAYS = "info-about(:chat, seq(list(:arbre, key(.2, morph('AU43, 1)))))\n"


@pytest.fixture(scope="module")
def made() -> azee.Compilation:
    return azee.compile(SAYS, life=False)


def _asset(path: Path) -> dict[str, Any]:
    data = path.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    asset: dict[str, Any] = json.loads(data[20 : 20 + length])["asset"]
    return asset


@pytest.mark.long
def test_the_report_counts_the_rules_of_the_text(made: azee.Compilation) -> None:
    found = made.report_json()["provenance"]
    assert isinstance(found, dict)
    assert found["applications"] == 3
    assert found["statuses"] == {"published": 1, "read-off": 1, "inferred": 1}
    jsonschema.validate(found, schema("report")["properties"]["provenance"])
    assert [library["name"] for library in found["libraries"]] == ["core", "lsf"]
    assert all(library["version"] and library["changed"] == [] for library in found["libraries"])


@pytest.mark.long
def test_a_glb_has_the_counts_of_the_report(made: azee.Compilation, tmp_path: Path) -> None:
    made.save(tmp_path / "a.glb")
    assert _asset(tmp_path / "a.glb")["extras"] == {"provenance": made.report_json()["provenance"]}


def test_an_elan_file_has_them_as_properties(made: azee.Compilation, tmp_path: Path) -> None:
    made.save(tmp_path / "a.eaf")
    (tmp_path / "a.azee").write_text(SAYS, encoding="utf-8")
    assert run(["score", str(tmp_path / "a.azee"), "-o", str(tmp_path / "b.eaf")]) == 0
    assert made.provenance is not None
    for name in ("a.eaf", "b.eaf"):
        properties = dict(pympi.Elan.Eaf(str(tmp_path / name)).properties)
        assert properties["azee:provenance"] == made.provenance.text
        for library in made.provenance.libraries:
            assert properties[f"azee:library:{library.name}"] == library.text


def test_the_command_tells_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["compile", "-e", ":bien", "--no-life", "-o", str(tmp_path / "a.json")]) == 0
    assert "\n1 application: 1 inferred\n" in capsys.readouterr().err


@pytest.mark.long
def test_a_score_without_a_text_has_none(made: azee.Compilation, tmp_path: Path) -> None:
    from azee.compilation import perform

    bare = perform(made.score, made.rig, life=False)
    assert bare.provenance is None
    assert bare.report_json()["provenance"] is None
    bare.save(tmp_path / "a.glb")
    assert "extras" not in _asset(tmp_path / "a.glb")
