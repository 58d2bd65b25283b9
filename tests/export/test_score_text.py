"""A score as text: every constraint is there, and a hand shape does not fill the screen."""

from __future__ import annotations

from azee.export.score_text import FOLDED, tree
from azee.lang.program import evaluate_expression


def test_the_morphs_of_a_hand_shape_share_lines() -> None:
    names = [
        f"{finger}_{way}" for finger in ("index", "middle", "ring") for way in ("bend", "hook")
    ]
    morphs = " ".join(f"(morph '{name} s .5)" for name in names)
    text = tree(evaluate_expression(f"key 1 (cstr (list {morphs} (look ^fwd)))").score)
    lines = [line.strip() for line in text.splitlines()]
    assert len(lines) < 1 + len(names)
    assert lines[-1] == "look ^fwd"
    assert " ".join(lines[1:-1]) == "morph " + ", ".join(f"'{name} s 0.5" for name in names)
    assert all(len(line) <= 80 for line in lines)


def test_a_few_morphs_keep_a_line_each() -> None:
    morphs = " ".join(f"(morph 'AU{n} .5)" for n in (1, 2, 4)[: FOLDED - 1])
    text = tree(evaluate_expression(f"key 1 (cstr (list {morphs}))").score)
    assert [line.split()[0] for line in text.splitlines()[1:]] == ["morph"] * 3
