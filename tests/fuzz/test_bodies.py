"""Files of bodies that mean trouble, and a few that are damaged at random, always the same."""

from __future__ import annotations

import random
import sys
from pathlib import Path

import pytest
from any_body import damaged, examine, joined, split

sys.path[:0] = [str(Path(__file__).parents[1] / "rig")]

from body_families import make_body  # noqa: E402
from joint_names import FAMILIES  # noqa: E402

REGRESSIONS = sorted((Path(__file__).parent / "regressions" / "bodies").iterdir())
SMALL_BYTES = 8192


@pytest.mark.parametrize("path", REGRESSIONS, ids=lambda path: path.name)
def test_a_file_that_means_trouble(path: Path) -> None:
    assert path.stat().st_size <= SMALL_BYTES, "shorten it: whoever reads it wants to see why"
    assert examine(path.read_bytes())


@pytest.fixture(scope="module")
def seed() -> bytes:
    return make_body(FAMILIES["motive"], fingers=False).file().data()


def test_damage_is_repeatable_and_damages(seed: bytes) -> None:
    first = [damaged(seed, random.Random(n)) for n in range(40)]
    assert first == [damaged(seed, random.Random(n)) for n in range(40)]
    assert sum(data != seed for data in first) > 30
    document, rest = split(seed)
    assert split(joined(document, rest)) == (document, rest)


@pytest.mark.slow
@pytest.mark.parametrize("number", range(25))
def test_a_damaged_body_is_taken_in_or_refused(seed: bytes, number: int) -> None:
    examine(damaged(seed, random.Random(number)))


def test_what_breaks_is_noticed(seed: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(path: Path, name: str) -> object:
        raise IndexError(path, name)

    monkeypatch.setattr("azee_rig.importing.importer.import_body", broken)
    with pytest.raises(IndexError):
        examine(seed)
