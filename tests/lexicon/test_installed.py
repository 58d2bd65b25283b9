"""A lexicon that another distribution installs: found by its name, written once."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest

from azee.cli.main import run
from azee.lexicon import installing
from azee_grammar import installed

SIGNS = Path(__file__).parent / "signs"
ROOT = Path(__file__).parents[2]


@pytest.fixture
def small(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A distribution with three signs, as if it were installed; yields the cache folder."""
    import zipfile

    (tmp_path / "small_lexicon.py").write_text(
        "from pathlib import Path\n"
        "from azee.lexicon.installing import rules_of\n"
        "def folder():\n"
        "    return rules_of(Path(__file__).parent / 'small.zip', 'small', 'a test')\n"
    )
    with zipfile.ZipFile(tmp_path / "small.zip", "w") as archive:
        for name in ("HUIS", "FIETS", "MOEDER"):
            archive.write(SIGNS / f"{name}.sigml", f"{name}.sigml")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setenv("AZEE_CACHE", str(tmp_path / "cache"))
    entry = EntryPoint("small", "small_lexicon:folder", installed.GROUP)
    monkeypatch.setattr(installed, "_entries", lambda: {"small": entry})
    for cached in (installed.installed_library, installing.rules_of):
        cached.cache_clear()
    yield tmp_path / "cache"
    sys.modules.pop("small_lexicon", None)
    for cached in (installed.installed_library, installing.rules_of):
        cached.cache_clear()


def _check(text: str, tmp_path: Path) -> int:
    path = tmp_path / "text.azee"
    path.write_text(text, encoding="utf-8")
    return run(["check", str(path)])


def test_its_rules_are_written_once_and_used_by_name(
    small: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _check("use 'small\n:small-huis\n:small-fiets\n", tmp_path) == 0
    assert "Writing the rules of the lexicon small, once" in capsys.readouterr().err
    (folder,) = (small / "lexicons").iterdir()
    assert len(list((folder / "small").glob("*.azee"))) == 3
    for cached in (installed.installed_library, installing.rules_of):
        cached.cache_clear()
    assert _check("use 'small\n:small-moeder\n", tmp_path) == 0
    assert "Writing" not in capsys.readouterr().err
    assert list((small / "lexicons").iterdir()) == [folder]
    assert run(["lexicon", "list", "small"]) == 0
    assert ":small-huis" in capsys.readouterr().out
    assert run(["gloss", "huis", "--language", "small"]) == 0


def test_it_works_without_a_cache(
    small: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("AZEE_CACHE", "off")
    assert _check("use 'small\n:small-huis\n", tmp_path) == 0
    assert not small.exists()


def test_a_misspelt_name_is_answered(
    small: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert small.name == "cache"
    assert _check("use 'smal\n:x\n", tmp_path) == 1
    assert "did you mean `'small`?" in capsys.readouterr().err


def test_the_lexicon_of_the_netherlands_is_small_and_has_its_notice() -> None:
    package = ROOT / "lexicons" / "ngt"
    assert sum(path.stat().st_size for path in package.rglob("*") if path.is_file()) < 5e6
    assert "Apache License" in (package / "NOTICE").read_text(encoding="utf-8")
