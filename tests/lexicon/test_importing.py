"""Imports: repeatable, careful with what was edited, and told in full."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path

import jsonschema
import pytest
from formats import schema
from pairs import PAIRS, symbols

from azee.cli.main import run
from azee.lang.program import load
from azee.lexicon.importing import import_signs, plain_name
from azee.lexicon.record import Record
from azee.lexicon.sample import sample_of
from azee_grammar.diagnostic import AZeeError
from azee_grammar.format import format_file
from azee_grammar.source import Source

SIGNS = Path(__file__).parent / "signs"


def _import(folder: Path, *paths: Path, force: bool = False) -> tuple[list[str], list[str]]:
    summary = import_signs(paths or [SIGNS], folder, "ngt", "a test", force=force)
    assert summary.failed == []
    return summary.written, summary.kept


def _state(folder: Path) -> dict[str, tuple[bytes, int]]:
    return {p.name: (p.read_bytes(), p.stat().st_mtime_ns) for p in sorted(folder.iterdir())}


def test_importing_again_changes_nothing(tmp_path: Path) -> None:
    written, _ = _import(tmp_path / "ngt")
    assert len(written) == 21
    before = _state(tmp_path / "ngt")
    assert len(before) == 22
    assert _import(tmp_path / "ngt") == ([], [])
    assert _state(tmp_path / "ngt") == before


def test_a_rule_edited_by_hand_stays_unless_it_is_forced(tmp_path: Path) -> None:
    folder = tmp_path / "ngt"
    _import(folder)
    path = folder / "ngt-huis.azee"
    text = path.read_text(encoding="utf-8")
    path.write_text(text + "# mine\n", encoding="utf-8")
    for _ in range(2):
        assert _import(folder) == ([], ["ngt-huis"])
        assert path.read_text(encoding="utf-8").endswith("# mine\n")
    assert _import(folder, force=True) == (["ngt-huis"], [])
    assert path.read_text(encoding="utf-8") == text


def test_a_rule_whose_notation_changes_is_written_again(tmp_path: Path) -> None:
    folder, source = tmp_path / "ngt", tmp_path / "HUIS.sigml"
    source.write_bytes((SIGNS / "HUIS.sigml").read_bytes())
    _import(folder, source)
    source.write_bytes(source.read_bytes().replace(b'handshape="flat"', b'handshape="fist"'))
    assert _import(folder, source) == (["ngt-huis"], [])
    assert ":#hamfist" in (folder / "ngt-huis.azee").read_text(encoding="utf-8")


def test_a_rule_that_somebody_wrote_before_stays(tmp_path: Path) -> None:
    (tmp_path / "ngt-huis.azee").write_text("def ngt-huis\n    blank 1\n", encoding="utf-8")
    assert "ngt-huis" in _import(tmp_path)[1]


@pytest.mark.long
def test_rules_are_sound_canonical_and_say_where_they_are_from(tmp_path: Path) -> None:
    folder = tmp_path / "ngt"
    written, _ = _import(folder)
    text = "use 'ngt\n" + "".join(f":{name}\n" for name in written)
    program = load(Source("all", text), [tmp_path])
    assert program.check() == ()
    assert len(program.utterances) == len(written)
    for name in written:
        rule = (folder / f"{name}.azee").read_text(encoding="utf-8")
        assert format_file(Source(name, rule)) == rule
        assert '\'status "inferred"' in rule
        assert "a test; read from " in rule


def test_archives_folders_and_tables_are_read(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "some.zip", "w") as archive:
        archive.write(SIGNS / "HUIS.sigml", "deep/inside/HUIS.sigml")
        archive.writestr("notes.txt", "nothing")
    names = [symbols(names) for names, _ in PAIRS.values()]
    table = "gloss\tnotation\n" + "".join(f"Sign {i}\t{s}\n" for i, s in enumerate(names))
    (tmp_path / "table.tsv").write_text(table, encoding="utf-8")
    written, _ = _import(tmp_path / "out", tmp_path / "some.zip", tmp_path / "table.tsv")
    assert written[:3] == ["ngt-huis", "ngt-sign-0", "ngt-sign-1"]
    assert len(written) == 1 + len(PAIRS)


def test_names_of_rules_are_glosses_that_a_name_can_be() -> None:
    assert plain_name("DAG_GROET") == "dag-groet"
    assert plain_name("OP-AM{ÉÉN'S}") == "op-am-één-s"
    assert plain_name("!!!") == "sign"


def test_two_signs_of_one_name_get_two_rules(tmp_path: Path) -> None:
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "HUIS.sigml").write_bytes((SIGNS / "HUIS.sigml").read_bytes())
    written, _ = _import(tmp_path / "out", tmp_path / "a", tmp_path / "b")
    assert written == ["ngt-huis", "ngt-huis-2"]


def test_a_damaged_record_is_told(tmp_path: Path) -> None:
    for text in ("", "[]", '{"rules": 3}', '{"rules": {"a": {}}, "language": "", "source": ""}'):
        (tmp_path / "lexicon.json").write_text(text, encoding="utf-8")
        with pytest.raises(AZeeError) as caught:
            Record.read(tmp_path)
        assert caught.value.diagnostics[0].code == "bad-record"


# The command ------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def ngt(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A folder with the imported signs."""
    folder = tmp_path_factory.mktemp("lexicons") / "ngt"
    assert run(["lexicon", "import", str(SIGNS), "-o", str(folder), "--quiet"]) == 0
    return str(folder)


def _output(capsys: pytest.CaptureFixture[str], *arguments: str, code: int = 0) -> str:
    assert run([*arguments]) == code
    return capsys.readouterr().out


def test_the_summary_names_every_loss(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "bad.sigml").write_text("<sigml>", encoding="utf-8")
    paths = (str(SIGNS), str(tmp_path / "bad.sigml"), "-o", str(tmp_path / "ngt"))
    text = _output(capsys, "lexicon", "import", *paths, "--format", "json", code=1)
    document = json.loads(text)
    jsonschema.validate(document, schema("lexicon-import"))
    assert len(document["written"]) == 21
    assert document["failed"] == ["bad.sigml"]
    assert [d["code"] for d in document["diagnostics"]] == ["bad-sigml"]
    kinds = {row["kind"]: row for row in document["approximations"]}
    for row in kinds.values():
        for name in row["rules"]:
            rule = (tmp_path / "ngt" / f"{name}.azee").read_text(encoding="utf-8")
            assert "# Approximated: " in rule
    shown = _output(capsys, "lexicon", "import", *paths, code=1)
    assert shown.startswith("22 signs: 21 unchanged, 1 not read\n")


def test_signs_are_found_by_what_they_are_made_of(
    ngt: str, capsys: pytest.CaptureFixture[str]
) -> None:
    listed = _output(capsys, "lexicon", "list", ngt)
    assert len(listed.splitlines()) == 21
    assert ":ngt-huis " in listed
    found = _output(capsys, "lexicon", "search", ngt, "--hands", "alternating")
    assert [line.split()[1] for line in found.splitlines()] == ["FIETS"]
    found = _output(capsys, "lexicon", "search", ngt, "moed", "--place", "chin")
    assert found.split() == [":ngt-moeder", "MOEDER"]
    assert _output(capsys, "lexicon", "search", ngt, "zzz", code=3) == ""
    assert run(["lexicon", "search", ngt, "--hands", "three"]) == 2
    stats = json.loads(_output(capsys, "lexicon", "stats", ngt, "--format", "json"))
    assert stats["signs"] == 21
    assert stats["handshape"]["flat"] >= 5


def test_a_sign_is_shown_by_name_or_gloss(ngt: str, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("ngt-huis", ":ngt-huis", "HUIS", "huis"):
        assert _output(capsys, "lexicon", "show", ngt, name).startswith("def ngt-huis\n")
    assert run(["lexicon", "show", ngt, "huiz"]) == 1
    assert "did you mean" in capsys.readouterr().err
    assert run(["lexicon", "list", "nothing-like-it"]) == 1


def test_glosses_become_a_text(
    ngt: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["gloss", "huis zoiets FIETS", "--language", ngt]) == 0
    shown = capsys.readouterr()
    assert shown.out == (
        "use 'ngt\n\nseq\n    list\n        :ngt-huis\n"
        "        # zoiets: not in the lexicon, to be spelled\n        :ngt-fiets\n    'gap .2\n"
    )
    assert "unknown-gloss" in shown.err
    (tmp_path / "text.azee").write_text(shown.out, encoding="utf-8")
    assert run(["check", str(tmp_path / "text.azee"), "--library", str(Path(ngt).parent)]) == 0
    assert run(["gloss", "zoiets", "--language", ngt]) == 3


@pytest.mark.slow
def test_signs_are_drawn(ngt: str, tmp_path: Path) -> None:
    one, many = tmp_path / "one.png", tmp_path / "many.png"
    assert run(["lexicon", "show", ngt, "FIETS", "-o", str(one)]) == 0
    assert run(["lexicon", "sheet", ngt, "FIETS", "15", "-o", str(many)]) == 0
    assert one.read_bytes()[:4] == many.read_bytes()[:4] == b"\x89PNG"


def test_samples_are_the_same_everywhere() -> None:
    names = [f"sign-{i}" for i in range(200)]
    assert (
        sample_of(names, 3) == sample_of(reversed(names), 3) == ["sign-122", "sign-169", "sign-51"]
    )
