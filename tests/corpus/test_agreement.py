"""Annotations of two files paired and measured: by hand, and against a search of all pairings."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Sequence
from itertools import combinations
from pathlib import Path

import jsonschema
import pympi
import pytest
from formats import schema
from hypothesis import given
from hypothesis import strategies as st

from azee.cli.main import run
from azee.corpus.agreement import Spread, TierAgreement, aligned, compared
from azee.corpus.annotations import Annotation, NotElanError, read_tiers

TIER = st.lists(
    st.tuples(st.sampled_from("ab"), st.integers(0, 40), st.integers(1, 9)), max_size=5
).map(
    lambda rows: sorted(
        (Annotation(text, start / 8, (start + length) / 8) for text, start, length in rows),
        key=lambda a: (a.start_s, a.end_s, a.text),
    )
)


def tier(first: Sequence[Annotation], second: Sequence[Annotation]) -> TierAgreement:
    (found,) = compared({"x": first}, {"x": second})
    return found


def test_pairs_are_measured() -> None:
    found = tier(
        [Annotation("tree", 0.0, 0.8), Annotation("wardrobe", 1.0, 3.0)],
        [
            Annotation("TREE", 0.2, 1.2),
            Annotation("no", 1.2, 1.3),
            Annotation("Wardrobe", 1.4, 2.4),
        ],
    )
    assert [p.start_s for p in found.pairs] == pytest.approx([0.2, 0.4])
    assert [p.end_s for p in found.pairs] == pytest.approx([0.4, -0.6])
    assert [p.longer for p in found.pairs] == pytest.approx([1 / 0.8, 0.5])
    assert [p.overlap for p in found.pairs] == pytest.approx([0.6 / 1.2, 1.0 / 2.0])
    assert [a.text for a in found.only_second] == ["no"]
    assert found.only_first == []
    assert found.start_s.mean == pytest.approx(0.3)
    assert found.start_s.deviation == pytest.approx(math.sqrt(0.02))
    assert found.end_s.mean == pytest.approx(-0.1)
    assert found.overlap.deviation == pytest.approx(0)


def test_what_is_apart_does_not_overlap_and_nothing_has_no_mean() -> None:
    found = tier([Annotation("a", 0, 1)], [Annotation("a", 2, 3)])
    assert found.overlap == Spread(0.0, 0.0)
    assert tier([], [Annotation("a", 2, 3)]).overlap == Spread(None, None)


def test_of_equal_texts_the_nearest_are_paired() -> None:
    found = tier([Annotation("a", 5.0, 6.0)], [Annotation("a", t, t + 1) for t in (0.0, 4.8, 9.0)])
    assert [(p.first.start_s, p.second.start_s) for p in found.pairs] == [(5.0, 4.8)]
    assert [a.start_s for a in found.only_second] == [0.0, 9.0]


def test_aligning_moves_the_second_by_the_mean_of_all_starts() -> None:
    first = {"x": [Annotation("a", 0, 1)], "y": [Annotation("b", 2, 3)]}
    second = {
        "x": [Annotation("a", 10, 11)],
        "y": [Annotation("b", 12.5, 13), Annotation("c", 20, 21)],
    }
    found, moved_s = aligned(compared(first, second))
    assert moved_s == pytest.approx(-10.25)
    assert [t.start_s.mean for t in found] == pytest.approx([-0.25, 0.25])
    assert found[1].only_second == [Annotation("c", 9.75, 10.75)]


def _best(first: Sequence[Annotation], second: Sequence[Annotation]) -> tuple[int, float]:
    """Most pairs, and the least distance of their starts, by looking at all ordered pairings."""
    for count in range(min(len(first), len(second)), 0, -1):
        costs = [
            sum(abs(a.start_s - b.start_s) for a, b in zip(some, others, strict=True))
            for some in combinations(first, count)
            for others in combinations(second, count)
            if all(a.text == b.text for a, b in zip(some, others, strict=True))
        ]
        if costs:
            return count, min(costs)
    return 0, 0.0


@given(TIER, TIER)
def test_no_pairing_has_more_pairs_or_nearer_ones(
    first: list[Annotation], second: list[Annotation]
) -> None:
    found = tier(first, second)
    cost = sum(abs(pair.start_s) for pair in found.pairs)
    assert (len(found.pairs), cost) == pytest.approx(_best(first, second))
    assert sorted([*(p.first for p in found.pairs), *found.only_first], key=repr) == sorted(
        first, key=repr
    )
    assert sorted([*(p.second for p in found.pairs), *found.only_second], key=repr) == sorted(
        second, key=repr
    )


@given(TIER, TIER)
def test_offsets_change_sign_with_the_files_and_overlap_stays(
    first: list[Annotation], second: list[Annotation]
) -> None:
    there, back = tier(first, second), tier(second, first)
    assert len(there.pairs) == len(back.pairs)
    assert all(0 <= pair.overlap <= 1 for pair in there.pairs)
    if there.pairs:
        assert sum(abs(p.start_s) for p in there.pairs) == pytest.approx(
            sum(abs(p.start_s) for p in back.pairs)
        )
    same = tier(first, first)
    assert all(p.start_s == p.end_s == 0 and p.overlap == 1 for p in same.pairs)
    assert len(same.pairs) == len(first)


# Files ------------------------------------------------------------------------------------------


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A score's file, and a recording's, made with pympi."""
    monkeypatch.chdir(tmp_path)
    assert run(["score", "-e", "info-about(:chat, :bien)", "-o", "score.eaf"]) == 0
    file = pympi.Elan.Eaf()
    file.remove_tier("default")
    file.add_tier("RH")
    file.add_linguistic_type("notes", "Symbolic_Association")
    for start, end, text in ((500, 1300, "CHAT"), (1700, 2700, "BIEN"), (3000, 3200, "BIEN")):
        file.add_annotation("RH", start, end, text)
    file.add_tier("comment", "notes", "RH")
    file.add_ref_annotation("comment", "RH", 600, "clear")
    file.to_file("recording.eaf")
    return tmp_path


def test_tiers_of_any_file_are_read(files: Path) -> None:
    found = read_tiers("recording.eaf")
    assert found["RH"][0] == Annotation("CHAT", 0.5, 1.3)
    assert found["comment"] == [Annotation("clear", 0.5, 1.3)]
    assert [a.text for a in read_tiers("score.eaf")["gloss"]] == ["chat", "bien"]


def test_the_command_compares_tiers_by_name(
    files: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["elan", "compare", "score.eaf", "recording.eaf", "--tier", "gloss=RH"]
    assert run([*arguments, "--format", "json"]) == 0
    found = json.loads(capsys.readouterr().out)
    jsonschema.validate(found, schema("elan-comparison"))
    (compared_tier,) = found["tiers"]
    assert [pair["text"] for pair in compared_tier["pairs"]] == ["chat", "bien"]
    assert [a["text"] for a in compared_tier["only_second"]] == ["BIEN"]
    assert compared_tier["pairs"][0]["second"]["start_s"] == 0.5
    assert run(arguments) == 0
    assert "gloss = RH      2       0       1  +0.5" in capsys.readouterr().out
    assert run(["elan", "compare", "score.eaf", "score.eaf"]) == 0
    shown = capsys.readouterr().out
    assert "\nblocks 1.1 " in shown
    assert "+0.00 ± 0.00  1.00 ± 0.00  1.00 ± 0.00" in shown


def test_tiers_that_are_missing_are_told_with_those_that_exist(
    files: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["elan", "compare", "score.eaf", "recording.eaf", "--tier", "gloss"]) == 2
    assert "`recording.eaf` has no tier `gloss`; it has `RH`, `comment`" in capsys.readouterr().err
    assert run(["elan", "compare", "score.eaf", "recording.eaf"]) == 2
    assert "no tier has the same name in both" in capsys.readouterr().err
    assert run(["elan", "compare", "score.eaf", "recording.eaf", "--tier", "face=RH"]) == 3


@pytest.mark.parametrize("content", ["", "<a/>", "<ANNOTATION_DOCUMENT VERSION='3.0'/>", "\0\1"])
def test_what_is_no_elan_file_is_told(
    content: str, files: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("bad.eaf").write_text(content, encoding="utf-8")
    with pytest.raises(NotElanError):
        read_tiers("bad.eaf")
    assert run(["elan", "compare", "bad.eaf", "recording.eaf"]) == 1
    expected = "error[cannot-read]: `bad.eaf` is no ELAN file, or a damaged one"
    assert expected in capsys.readouterr().err


def test_missing_files_and_a_missing_library_are_told(
    files: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert run(["elan", "compare", "none.eaf", "recording.eaf"]) == 1
    assert "error[cannot-read]: there is no file `none.eaf`" in capsys.readouterr().err
    assert run(["elan", "compare", ".", "recording.eaf"]) == 1
    assert "error[cannot-read]: cannot read `.`: is a directory" in capsys.readouterr().err
    monkeypatch.setitem(sys.modules, "pympi", None)
    assert run(["elan", "compare", "score.eaf", "recording.eaf"]) == 1
    assert "install it with: pip install 'azee[elan]'" in capsys.readouterr().err
