"""The tester of tests: each kind of change changes, and a planted weak test is found."""

from __future__ import annotations

import ast
import subprocess
from collections.abc import Mapping
from pathlib import Path

import pytest
from mutation_test import Baseline, Workplace, main, sample
from related_tests import Tree, chosen_modules
from single_changes import changes, lines_of_statement

ROOT = Path(__file__).parents[2]

CASES = {
    "comparison": ("x = a < b", {"x = a <= b", "x = a > b"}),
    "comparison, two words": ("x = a not  in b", {"x = a in b"}),
    "arithmetic": ("x = a + b", {"x = a - b"}),
    "arithmetic on signs of two bytes": ("x = 'äé'[n] * b", {"x = 'äé'[n] / b"}),
    "arithmetic, at a comment": ("x = (a  # +\n + b)", {"x = (a  # +\n - b)"}),
    "arithmetic in place": ("x += b", {"x -= b"}),
    "and, or": ("x = a and b", {"x = a or b"}),
    "not dropped": ("x = not a", {"x = a"}),
    "minus dropped": ("x = -a", {"x = a"}),
    "constant": ("x = 2.0", {"x = 2.2"}),
    "constant, whole": ("x = 7", {"x = 8"}),
    "constant, truth": ("x = True", {"x = False"}),
    "break": ("while a:\n  break", {"while a:\n  continue", "while (not (a)):\n  break"}),
    "continue": ("for x in a:\n  continue", {"for x in a:\n  break"}),
    "condition": ("if a:\n  b", {"if (not (a)):\n  b"}),
    "condition of a list": ("x = [y for y in a if y]", {"x = [y for y in a if True]"}),
    "call dropped": ("a.append(b)", {"pass"}),
    "function": ("x = min(a, b)", {"x = max(a, b)"}),
    "call's result": ("x = sorted(a)", {"x = list(a)", "x = (a)"}),
    "returned": ("def f() -> list[int]:\n  return a", {"def f() -> list[int]:\n  return []"}),
    "returned or none": (
        "def f() -> A | None:\n  return a",
        {"def f() -> A | None:\n  return None"},
    ),
    "left out": ("assert a < 1\nx: int | None\nT = A | B\nzip(strict=True)", {"pass"}),
    "raised": ("raise E(1 + 2)", set()),
}


@pytest.mark.parametrize("case", CASES)
def test_every_kind_of_change_changes_the_tree_and_nothing_else(case: str) -> None:
    source, wanted = CASES[case]
    found = {change.applied(source) for change in changes(source)}
    if case == "left out":
        assert found == {source.replace("zip(strict=True)", "pass")}
        return
    assert found == wanted
    assert all(ast.dump(ast.parse(text)) != ast.dump(ast.parse(source)) for text in found)


def test_a_change_reads_as_a_diff_of_its_line() -> None:
    source = "one = 1\nx = a < b\nthree = c\n"
    change = next(c for c in changes(source) if c.kind == "comparison")
    assert change.line == 2
    assert "-x = a < b\n+x = a <= b\n" in change.diff(source, "m.py") + "\n"


def test_only_files_that_run_a_statement_or_start_processes_are_concerned() -> None:
    ran = {"a": frozenset({1, 2}), "b": frozenset({1, 7}), "c": None}
    baseline = Baseline(1.0, ran)
    assert baseline.concerned(["c", "b", "a"], range(2, 4)) == ["c", "a"]
    assert baseline.concerned(["c", "b", "a", "d"], range(1, 2)) == ["c", "b", "a", "d"]
    assert baseline.concerned(["c", "b", "a"], range(8, 9)) == ["c", "b", "a"]  # no file runs it


@pytest.mark.parametrize(
    ("source", "lines"),
    [
        ("x = (\n    1,\n    2,\n)", {range(1, 5)}),
        ("if a < b:\n    pass\n", {range(1, 2)}),
        ("def f(a):\n    if (a\n            < 1):\n        return a\n", {range(2, 4)}),
        ("try:\n    pass\nexcept E[1]:\n    pass\n", {range(1, 4)}),
    ],
)
def test_a_change_is_in_its_statement_without_the_body(source: str, lines: set[range]) -> None:
    assert {lines_of_statement(source, change) for change in changes(source)} == lines


@pytest.mark.long
def test_tests_belong_to_what_they_import_and_to_their_folder() -> None:
    tree = Tree(ROOT)
    related = [path.name for path in tree.related("azee.clip.blend")]
    assert related[0] == "test_blend.py"
    assert "test_clips.py" in related
    assert "test_parser.py" not in related
    by_path = chosen_modules(tree, ["azee/clip/blend.py"])
    assert by_path == chosen_modules(tree, ["azee.clip.blend"]) == ["azee.clip.blend"]
    assert len(chosen_modules(tree, ["solver/azee_solver/kernels"])) > 5
    with pytest.raises(ValueError, match=r"no module `azee\.nothing`"):
        chosen_modules(tree, ["azee.nothing"])


MODULE = """def grown(a: int) -> int:
    return a + 1


def shrunk(a: int) -> int:
    return a - 1
"""
TESTS = """from azee.lang.sizes import grown, shrunk


def test_grown() -> None:
    assert grown(3) == 4


def test_shrunk() -> None:
    assert shrunk(3) {relation}
"""


OTHERS = {
    "tests/lang/test_nothing.py": """from azee.lang import sizes


def test_nothing() -> None:
    assert sizes
""",
    "tests/lang/test_fixture.py": """import pytest
from azee.lang.sizes import grown


@pytest.fixture(scope="session")
def four() -> int:
    return grown(3)


def test_four(four: int) -> None:
    assert four == 4
""",
    "tests/lang/test_process.py": """import subprocess, sys
from azee.lang import sizes


def test_process() -> None:
    assert sizes
    subprocess.run([sys.executable, "-c", ""], check=True)
""",
}


@pytest.mark.slow
def test_it_is_noted_which_files_of_tests_run_which_lines(tmp_path: Path) -> None:
    root = planted(tmp_path / "origin", "== 2", OTHERS)
    tree = Tree(root)
    (mutant, *_) = sample(tree, ["azee.lang.sizes"], 1, 0)
    baseline = Workplace.prepared(root, tmp_path / "copy", "").baseline(mutant)
    assert baseline.lines == {
        "tests/lang/test_fixture.py": {1, 2, 5},
        "tests/lang/test_nothing.py": {1, 5},
        "tests/lang/test_process.py": None,
        "tests/lang/test_sizes.py": {1, 2, 5, 6},
    }


def planted(root: Path, relation: str, others: Mapping[str, str] | None = None) -> Path:
    """A tree with a module and its tests, which git knows."""
    for name, text in {
        "azee/__init__.py": "",
        "azee/lang/__init__.py": "",
        "azee/lang/sizes.py": MODULE,
        "tests/lang/test_sizes.py": TESTS.format(relation=relation),
        **(others or {}),
    }.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text, encoding="utf-8")
    subprocess.run(["git", "init", "-q"], cwd=root, check=True)
    return root


def tried(root: Path, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    results = root / "out" / "results.jsonl"
    options = ["--count", "99", "--seed", "0", "--marks", "", "--results", str(results)]
    code = main([*options, "azee.lang.sizes"], root)
    told = capsys.readouterr()
    return code, told.out + told.err


@pytest.mark.slow
def test_a_weak_test_is_found_and_what_is_known_is_not_tried_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    root = planted(tmp_path, "is not None")
    code, told = tried(root, capsys)
    assert code == 0
    assert "-    return a - 1\n+    return a + 1" in told
    assert "3 of 6 changes seen, 50%" in told
    assert (root / "azee/lang/sizes.py").read_text(encoding="utf-8") == MODULE
    monkeypatch.setattr("mutation_test.Workplace.tried", None)
    again = tried(root, capsys)[1]
    assert sorted(set(again.splitlines())) == sorted(set(told.splitlines()))


@pytest.mark.slow
def test_a_good_test_sees_its_changes_and_one_that_fails_anyhow_tells_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    root = planted(tmp_path, "== 2")
    assert "6 of 6 changes seen, 100%" in tried(root, capsys)[1]
    weak = root / "tests/lang/test_sizes.py"
    weak.write_text(TESTS.format(relation="== 9"), encoding="utf-8")
    assert tried(root, capsys) == (
        2,
        "error: tests fail without any change: tests/lang/test_sizes.py\n",
    )
