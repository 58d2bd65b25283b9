"""Files that mean trouble, those that the fuzzer found among them, and all that it starts from."""

from __future__ import annotations

from pathlib import Path

import any_bvh
import any_bytes
import pytest
from any_bytes import examine
from search import BVH, TEXTS

from azee_grammar.source import Source

REGRESSIONS = sorted((Path(__file__).parent / "regressions").glob("*.azee"))
RECORDINGS = sorted((Path(__file__).parent / "bvh").iterdir())


@pytest.mark.parametrize("path", REGRESSIONS, ids=lambda path: path.name)
def test_a_text_that_means_trouble(path: Path) -> None:
    assert path.stat().st_size <= TEXTS.longest_bytes, (
        "shorten it: whoever reads it wants to see why"
    )
    examine(path.read_bytes())


@pytest.mark.parametrize(
    "data", [b"", b":a\xff(", b"\xff\xfe:\x00a\x00", b"\xef\xbb\xbf", b"\x80" * 99]
)
def test_bytes_that_are_no_text(data: bytes) -> None:
    examine(data)


@pytest.mark.long
def test_what_the_search_starts_from() -> None:
    found = list(TEXTS.seeds())
    assert len(found) > len(REGRESSIONS) > 0
    for seed in found:
        examine(seed)
    assert len(list(BVH.seeds())) == len(RECORDINGS) > 0


@pytest.mark.parametrize("path", RECORDINGS, ids=lambda path: path.name)
def test_a_recording_that_means_trouble(path: Path) -> None:
    assert path.stat().st_size <= BVH.longest_bytes, "shorten it: whoever reads it wants to see why"
    any_bvh.examine(path.read_bytes())


@pytest.mark.parametrize("data", [b"", b"MOTION", b"\xff\xfeM\x00", b"\x00" * 99, b"{}" * 50])
def test_bytes_that_are_no_recording(data: bytes) -> None:
    any_bvh.examine(data)


@pytest.mark.parametrize(
    ("layout", "complaint"),
    [(":a (", "no longer AZee"), (":b\n", "says something else"), (":a  ", "goes on moving")],
)
def test_a_layout_that_changes_a_text_is_noticed(
    layout: str, complaint: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def format_file(source: Source, *, published: bool) -> str:
        return layout if source.text == ":a" else ":a"

    monkeypatch.setattr(any_bytes, "format_file", format_file)
    with pytest.raises(AssertionError, match=complaint):
        examine(b":a")
