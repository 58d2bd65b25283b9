"""An expression that shows a rule."""

from __future__ import annotations

from pathlib import Path

import pytest
from evaluations import program

from azee.lang.rule_example import example_of

RULES = """def shown
    'example ":shown 1"
    key 1 (look ^fwd)

def score
    key 1 (look ^fwd)

def posture
    look ^fwd

def called
    azop
        'by 'nodefault
        'for 1
        key ^for (look ^by)
"""


@pytest.mark.parametrize(
    ("name", "example"),
    [
        ("shown", ":shown 1"),
        ("score", ":score"),
        ("posture", "key(1, :#posture)"),
        ("called", ":called('by = …)"),
    ],
)
def test_a_rule_is_shown_by_an_expression(name: str, example: str, tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "rules.azee").write_text(RULES, encoding="utf-8")
    found = program("use 'mine\n", tmp_path)
    (library,) = [x for x in found.librarian.libraries if x.namespace.name == "mine"]
    assert example_of(library.namespace.rules[name], [tmp_path]) == example
