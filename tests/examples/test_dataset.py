"""The data set of examples/dataset: its texts are sound, and one command makes it with a card."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from dataset.card import data_card
from dataset.texts import COUNT, texts
from programs import Python

from azee.lang.program import load
from azee_grammar.source import Source

MAKE = Path(__file__).parents[2] / "examples" / "dataset" / "make.py"


@pytest.mark.slow
def test_all_texts_are_sound() -> None:
    found = texts()
    assert len(found) == len({text["text"] for text in found}) == COUNT
    assert [text["name"] for text in found] == [f"{n:03}" for n in range(1, COUNT + 1)]
    for text in found:
        load(Source(text["name"], text["text"])).score()


def test_a_card_counts_what_the_manifest_says(tmp_path: Path) -> None:
    (tmp_path / "a.bvh").write_bytes(b"x" * 2_000_000)
    row = {
        "name": "001", "body": "signer", "hand": "right", "camera": "front", "speed": 1.0,
        "fps": 30.0, "duration_s": 1800.0, "met": 3, "eased": 0, "missed": 1,
        "files": {"bvh": "a.bvh"}, "error": None,
    }  # fmt: skip
    slow = row | {"speed": 0.8}
    failed = {"name": "002", "body": "signer", "files": {}, "error": [{"code": "unknown-rule"}]}
    lines = [json.dumps(line) for line in (row, slow, failed)]
    (tmp_path / "manifest.jsonl").write_text("\n".join(lines), encoding="utf-8")
    card = data_card(tmp_path / "manifest.jsonl")
    assert "2 clips of 2 utterances: 2 × speed. 1.00 hours of movement, 1 files,\n2.0 MB." in card
    assert "4 constraints over all bodies: 3 met (75.0%)" in card
    assert "| tasks that failed | 1 |" in card
    assert "| signer | 3 | 0 | 1 |" in card
    assert "CC0 1.0" in card


@pytest.mark.slow
def test_one_command_makes_a_small_one_and_a_second_does_nothing(
    tmp_path: Path, python: Python
) -> None:
    small = ("--count", "2", "--bodies", "signer,game", "--formats", "bvh", "--", "--workers", "1")
    done = python(str(MAKE), "-o", str(tmp_path / "set"), *small, expect=0)
    assert "4 tasks, 4 of them now" in done.stderr
    card = (tmp_path / "set" / "README.md").read_text(encoding="utf-8")
    assert card.startswith("# A synthetic data set of signing\n\n8 clips of 2 utterances: 2 × body")
    again = python(str(MAKE), "-o", str(tmp_path / "set"), *small, expect=0)
    assert "4 tasks, 0 of them now" in again.stderr
    assert (tmp_path / "set" / "README.md").read_text(encoding="utf-8") == card
