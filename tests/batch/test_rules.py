"""The rules of a library as texts: those that can be signed by themselves."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

import pytest
from batches import Serial, rows

from azee.batch.options import Options
from azee.batch.rules import rules_of
from azee.batch.run import run_batch
from azee.batch.task import body_of
from azee.cli.main import run
from azee_grammar.diagnostic import AZeeError

RULES = """def shown
    key .2 (place @I_TIP(s) point(.1, 0, .4))
def posture
    place @I_TIP(s) point(.1, .1, .4)
def needs
    azop
        'what
        'nodefault
        ^what
def told
    'example ":told('what = :shown)"
    azop
        'what
        'nodefault
        ^what
def somewhere
    point(0, 0, 0)
def too-short
    key -1 (place @I_TIP(s) point(.1, 0, .4))
"""


def library(folder: Path) -> Path:
    """A library of one file."""
    made = folder / "small"
    made.mkdir()
    (made / "rules.azee").write_text(RULES, encoding="utf-8")
    return made


def test_each_rule_that_gives_a_score_is_a_text(tmp_path: Path) -> None:
    texts, left_out = rules_of(str(library(tmp_path)))
    signed = {text.name: text.source.text.splitlines()[1] for text in texts}
    assert signed == {
        "posture": "key(1, :#posture)",
        "shown": ":shown",
        "told": ":told('what = :shown)",
        "too-short": ":too-short",
    }
    assert left_out == 2
    assert texts[0].source.text.startswith("use 'small\n")
    assert texts[1].given["rule"] == "shown"


@pytest.mark.slow
def test_rules_are_signed_and_one_that_fails_costs_itself(tmp_path: Path) -> None:
    texts, _ = rules_of(str(library(tmp_path)))
    out = tmp_path / "out"
    out.mkdir()
    workers = nullcontext(Serial(out))
    run_batch(texts, [body_of("signer")], Options((".bvh",)), out, lambda: workers)
    found = {row["name"]: row["error"] for row in rows(out)}
    assert [name for name, error in found.items() if error] == ["too-short"]
    assert (out / "posture" / "signer.bvh").is_file()


def test_libraries_that_ship_and_those_that_are_not_there() -> None:
    texts, left_out = rules_of("lsf")
    assert ":arbre" in {text.source.text.splitlines()[1] for text in texts}
    assert left_out == 0
    with pytest.raises(AZeeError, match="there is no library `'nowhere`"):
        rules_of("nowhere")


def test_a_library_with_mistakes_is_told_once(tmp_path: Path) -> None:
    made = library(tmp_path)
    (made / "more.azee").write_text("def faulty\n    :nobody\n", encoding="utf-8")
    with pytest.raises(AZeeError, match="there is no rule `:nobody`"):
        rules_of(str(made))


def test_a_batch_of_nothing_is_wrong_use(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["batch", "-o", str(tmp_path / "out")]) == 2
    assert "--rules LIBRARY" in " ".join(capsys.readouterr().err.split())
    assert run(["batch", "--rules", "nowhere", "-o", str(tmp_path / "out")]) == 1
    assert "there is no library `'nowhere`" in capsys.readouterr().err
