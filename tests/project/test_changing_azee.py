"""docs/changing-azee.md: its files and tests exist, its code runs, its list of matches is whole."""

from __future__ import annotations

import ast
import re
import textwrap
from pathlib import Path
from typing import Any

import numpy as np
from sources import ROOT, having, tree
from test_matches import named_members, unions

from azee.clip.clip import Clip
from azee.formats import WRITERS
from azee.lang.native import Native
from azee.lang.operators import geometry as operators
from azee.lang.registry import NATIVES
from azee_rig.rig import Rig
from azee_solver import geometry
from azee_solver.geometry import NamedPoint, SigningSpace, Vec, VTranslate

TEXT = (ROOT / "docs" / "changing-azee.md").read_text(encoding="utf-8")
NEW = {"azee/export/formats/clip_csv.py", "tests/export/test_clip_csv.py"}
"""Files of the examples, which do not exist."""


def _blocks(kind: str) -> list[str]:
    found = re.findall(rf"^ *```python {kind}\n(.*?)^ *```$", TEXT, re.M | re.S)
    return [textwrap.dedent(block) for block in found]


def test_every_file_of_the_page_exists_but_those_of_the_examples() -> None:
    files = {*re.findall(r"`((?:[\w.-]+/)+[\w-]+\.\w+)`", TEXT)}
    assert {name for name in files if not (ROOT / name).exists()} == NEW


def test_every_test_of_the_page_exists() -> None:
    tests = {*re.findall(r"`(test_\w+)`", TEXT)}
    texts = [path.read_text(encoding="utf-8") for path in (ROOT / "tests").glob("*/test_*.py")]
    assert tests
    assert [name for name in tests if not any(f"def {name}(" in text for text in texts)] == []


def test_the_page_names_every_file_that_matches_over_points() -> None:
    (listed,) = re.findall(r"<!-- matches over Point -->\n(.*?)<!-- end -->", TEXT, re.S)
    points = unions()["Point"]
    matching = {
        path.relative_to(ROOT).as_posix()
        for path in having("match ").values()
        if named_members(tree(path)) & points
    }
    assert {*re.findall(r"- `([\w./]+)`", listed)} == matching


def test_the_operator_of_the_page_makes_its_point() -> None:
    function, entry = _blocks("operator")
    names: dict[str, Any] = dict(vars(operators))
    exec(function, names)
    native: Native = eval(entry, names)
    assert native.name not in NATIVES
    assert native.function is not None
    start = NamedPoint(SigningSpace.MSSP)
    assert native.function(None, start, 0.1) == VTranslate(start, Vec(0.0, 0.1, 0.0))


def test_the_point_of_the_page_is_a_class_and_its_case_is_python() -> None:
    (declared,), (case,) = _blocks("point"), _blocks("case")
    names: dict[str, Any] = {**vars(geometry), "__name__": geometry.__name__}
    exec("from __future__ import annotations\n" + declared, names)
    assert names["Centroid"](()).points == ()
    assert "Centroid" not in vars(geometry)
    ast.parse("def f(self, expr, phase):\n match expr:\n" + textwrap.indent(case, "  "))


def test_the_format_of_the_page_is_written(signer: Rig, tmp_path: Path) -> None:
    (writer,), (loader,) = _blocks("writer"), _blocks("loader")
    assert ".csv" not in WRITERS
    ast.parse(loader)
    names: dict[str, Any] = {}
    exec(writer, names)
    q = np.array([signer.coordinates.idle, signer.coordinates.bind])
    clip = Clip(np.array([0.0, 0.1]), q, (), np.zeros((2, 0)), ())
    names["write_csv"](clip, signer, tmp_path / "a.csv")
    found = np.loadtxt(tmp_path / "a.csv", delimiter=",", skiprows=1)
    np.testing.assert_array_equal(found, np.column_stack([clip.times, q]))
