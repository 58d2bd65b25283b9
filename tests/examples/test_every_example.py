"""Every example compiles to every format, keeps its promises, and is read back by others."""

from __future__ import annotations

import json
import re
import shlex
import shutil
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from formats import schema
from PIL import Image
from plain_bvh import PlainBvh
from programs import Node, Python

import azee
from azee.cli.main import run
from azee.formats import SUFFIXES
from azee.motion.tasks.key_selection import MODES
from azee_solver.penetration import mesh_penetration

EXAMPLES = Path(__file__).parents[2] / "examples"
SOURCES = sorted(EXAMPLES.glob("*/*.azee"))
MILLIMETRE = 1e-3
CENTIMETRE = 1e-2

each = pytest.mark.parametrize("source", SOURCES, ids=lambda source: source.stem)


@pytest.fixture(scope="session")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """All examples, built as `make examples` builds them."""
    out = tmp_path_factory.mktemp("examples")
    script = EXAMPLES / "build.py"
    done = subprocess.run(
        [sys.executable, script, "--out", out], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return out


def _output(built: Path, source: Path, suffix: str) -> Path:
    return built / source.parent.name / f"{source.stem}{suffix}"


def _document(path: Path) -> dict[str, Any]:
    document: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return document


@each
def test_the_text_has_no_faults(source: Path) -> None:
    assert run(["check", "--quiet", str(source)]) == 0


@each
def test_the_folder_tells_of_it(source: Path) -> None:
    readme = (source.parent / "README.md").read_text(encoding="utf-8")
    assert f"azee compile {source.name}" in readme or f"/{source.name}" in readme
    assert source.with_suffix(".png").name in readme
    with Image.open(source.with_suffix(".png")) as picture:
        assert picture.width > 300


@pytest.mark.slow
@each
def test_every_format_is_there(source: Path, built: Path) -> None:
    for suffix in (*SUFFIXES, ".report.json"):
        assert _output(built, source, suffix).stat().st_size > 1000
    jsonschema.validate(_document(_output(built, source, ".json")), schema("clip"))


@pytest.mark.slow
@each
def test_no_coordinate_leaves_its_limits_and_misses_are_told_of(source: Path, built: Path) -> None:
    report = _document(_output(built, source, ".report.json"))
    jsonschema.validate(report, schema("report"))
    assert report["limits"]["max_excess_rad"] == 0
    readme = (source.parent / "README.md").read_text(encoding="utf-8")
    missed = [c for c in report["constraints"] if not c["met"]]
    untold = [c for c in missed if c["subject"] not in readme]
    assert untold == []


@pytest.mark.slow
@each
def test_the_bvh_gives_our_joints(source: Path, built: Path) -> None:
    read = PlainBvh(_output(built, source, ".bvh").read_text(encoding="ascii"))
    clip = _document(_output(built, source, ".json"))
    plain = [name.replace(".", "_").replace("-", "_") for name in clip["skeleton"]["names"]]
    ours = np.array(clip["positions"])[:, [plain.index(name) for name in read.names]]
    assert np.abs(read.positions() * CENTIMETRE - ours).max() < MILLIMETRE / 10


@pytest.mark.slow
@each
def test_the_khronos_validator_has_nothing_to_say(source: Path, built: Path, node: Node) -> None:
    report = json.loads(node("validate.mjs", _output(built, source, ".glb")))
    assert report["issues"]["messages"] == []


PAGES = [
    EXAMPLES.parent / "README.md",
    EXAMPLES.parent / "docs" / "README.md",
    *sorted({s.parent / "README.md" for s in SOURCES}),
]


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.parent.name)
def test_the_commands_on_a_page_do_what_it_says(page: Path, python: Python, tmp_path: Path) -> None:
    """Every indented line that begins with `azee`, where the page's first text stands ready."""
    shutil.copytree(EXAMPLES, tmp_path / "examples")
    text = page.read_text(encoding="utf-8")
    if block := re.search(r"^```\n(.*?)^```$", text, re.M | re.S):
        (tmp_path / "aged-52.azee").write_text(block[1], encoding="utf-8")
    lines = re.findall(r"^    azee (?!COMMAND)(.*)$", text, re.M)
    assert lines
    for line in lines:
        arguments = shlex.split(line, comments=True)
        python("-m", "azee", *arguments, expect=0)
        for option, value in pairwise(arguments):
            if option in ("-o", "--report"):
                assert (tmp_path / value).stat().st_size > 1000


@pytest.mark.slow
def test_the_library_call_of_the_readme_works(python: Python, tmp_path: Path) -> None:
    shutil.copytree(EXAMPLES, tmp_path / "examples")
    page = (EXAMPLES.parent / "README.md").read_text(encoding="utf-8")
    (code,) = re.findall(r"^```python\n(.*?)^```$", page, re.M | re.S)
    python("-c", code, expect=0)
    assert (tmp_path / "tree.glb").stat().st_size > 1000


@pytest.mark.slow
@each
def test_no_arm_enters_trunk_or_head_at_a_key_posture(source: Path) -> None:
    made = azee.compile(source, life=False)
    keys = (p for p in made.report.postures if p.limbs & {"arm_L", "arm_R"})
    times = (float(p.time) + made.animation.lead_s for p in keys)
    frames = {int(np.abs(made.clip.times - time).argmin()) for time in times}
    found = [
        (round(float(made.clip.times[frame]), 2), p.limb, p.body, p.depth_m)
        for frame in sorted(frames)
        for p in mesh_penetration(made.rig, made.clip.coordinates[frame])
        if p.body in ("trunk", "head") and p.depth_m > 3 * MILLIMETRE
    ]
    assert found == []


@pytest.mark.slow
@each
def test_nothing_enters_the_body_in_any_frame_where_no_touch_is_meant(
    source: Path, built: Path
) -> None:
    report = _document(_output(built, source, ".report.json"))
    skin = (p for p in report["clip_penetration"] if not p["intended"])
    assert [p for p in skin if p["depth_m"] > 3 * MILLIMETRE] == []


@pytest.mark.slow
@each
def test_tracks_are_never_rougher_than_flat(source: Path) -> None:
    tracks, flat = (azee.compile(source, mode=mode, life=False).report for mode in MODES)
    for of in ("acceleration", "jerk"):
        rough = max(getattr(p, of) for p in flat.peaks)
        assert max(getattr(p, of) for p in tracks.peaks) <= 1.001 * rough


@pytest.mark.slow
def test_tree_makes_the_problems_of_the_paper_and_meets_them(built: Path) -> None:
    report = _document(built / "tree" / "tree.report.json")
    first = [p for p in report["problems"] if p["time_s"] == 0]
    names = [p["name"] for p in first]
    assert len(names) >= 11
    weak, strong, hand = (
        next(i for i, name in enumerate(names) if part in name)
        for part in ("@H_BACK(w)", "@EL(s)", "!thumb(s, 3)")
    )
    assert weak < strong < hand
    assert len(first[hand]["constraints"]) == 4
    assert {first[strong]["merged_into"], first[hand]["merged_into"]} == {names[weak]}
    residuals = {c["subject"]: c["residual"] for c in report["constraints"]}
    assert residuals["place @EL(s)"] < MILLIMETRE
    assert residuals["orient 'dir !f_arm(s)"] < np.radians(0.5)
    missed = {c["subject"] for c in report["constraints"] if not c["met"]}
    assert missed <= {"orient 'nrm !thumb(s, 2)"}
