"""The numbered steps of docs/motion.md are those of the code, in the same order."""

from __future__ import annotations

import ast
import inspect
import re
from pathlib import Path
from types import ModuleType

from azee import animation
from azee.motion.keys import plan

ROOT = Path(__file__).parents[2]
STEP = re.compile(r"^(\d+)\. .*\((`\w+`(?:, `\w+`)*)\)$", re.MULTILINE)
NUMBER = re.compile(r"^    # (\d+)(?: to (\d+))?\. ", re.MULTILINE)


def steps() -> dict[int, list[str]]:
    """The functions that the page names behind each step."""
    page = (ROOT / "docs" / "motion.md").read_text(encoding="utf-8")
    return {int(number): re.findall(r"\w+", names) for number, names in STEP.findall(page)}


def body_of(name: str, module: ModuleType) -> tuple[str, list[str]]:
    """Source of a function, and what it calls, in the order of the text."""
    source = inspect.getsource(module)
    (function,) = (
        node
        for node in ast.parse(source).body
        if isinstance(node, ast.FunctionDef) and node.name == name
    )
    calls = sorted(
        (node.func.end_lineno or 0, node.func.end_col_offset or 0, called)
        for node in ast.walk(function)
        if isinstance(node, ast.Call)
        for called in (ast.unparse(node.func).rpartition(".")[2],)
    )
    text = ast.get_source_segment(source, function)
    assert text is not None
    return text, [called for _, _, called in calls]


def test_the_code_takes_the_steps_of_the_page_in_its_order() -> None:
    of_animate, calls_of_animate = body_of("animate", animation)
    of_plan, calls_of_plan = body_of("plan", plan)
    documented = steps()
    assert [*documented] == [*range(1, 15)]
    later = [(str(n), "") for n in range(11, 15)]
    assert NUMBER.findall(of_animate) == [("1", ""), ("2", ""), ("3", ""), ("4", "10"), *later]
    assert NUMBER.findall(of_plan) == [(str(n), "") for n in range(4, 11)]
    for numbers, calls in (
        ((1, 2, 3, 11, 12, 13, 14), calls_of_animate),
        (range(4, 11), calls_of_plan),
    ):
        named = [name for n in numbers for name in documented[n]]
        assert [call for call in calls if call in named] == named
