"""What a batch makes of texts, options and variations, in one process."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from batches import FAULTY, OPTIONS, clips, listed, ran, rows, states

import azee
from azee.batch.options import Options
from azee.batch.task import body_of, tasks_of
from azee.batch.text import texts_of
from azee.batch.variation import Variation, varied
from azee.cli.main import run
from azee.compilation import Compilation
from azee_rig.mirror import mirrored

TEXT = "key .2 (place @I_TIP(s) point(.1, .1, .4))\n"


@pytest.fixture(scope="module")
def made() -> Compilation:
    """A compilation."""
    return azee.compile(TEXT)


def test_sources_are_utterances_lists_and_folders(tmp_path: Path) -> None:
    (tmp_path / "two.azee").write_text(":bien\n:arbre\n", encoding="utf-8")
    (tmp_path / "one.azee").write_text(":bien\n", encoding="utf-8")
    inside = tmp_path / "inside"
    inside.mkdir()
    lines = ['{"text": ":bien", "gloss": "GOOD"}', "", "{", '{"text": ":bien", "name": "a/ ONE"}']
    (inside / "list.jsonl").write_text("\n".join(lines), encoding="utf-8")
    (inside / "one.azee").write_bytes(b"\xff")
    texts = texts_of([tmp_path])
    names = ["list-1", "list-3", "a_ONE", "one", "one.2", "two-1", "two-2"]
    assert [text.name for text in texts] == names
    assert [text.utterance for text in texts] == [None] * 5 + [1, 2]
    faults = [text.fault and text.fault.code for text in texts]
    assert faults == [None, "cannot-read", None, "not-utf8", None, None, None]
    assert texts[0].given == {"gloss": "GOOD"}
    assert texts[0].source.name.endswith("list.jsonl:1")


@pytest.mark.long
def test_a_mistake_in_one_utterance_costs_that_one(tmp_path: Path) -> None:
    source = tmp_path / "some.azee"
    source.write_text(f"{TEXT}:nobody\n{TEXT}", encoding="utf-8")
    summary, done = ran(source, tmp_path / "out", Options((".bvh",)))
    assert done == [f"some-{n} on signer" for n in (1, 2, 3)]
    found = rows(tmp_path / "out")
    assert [row["error"] and row["error"][0]["code"] for row in found] == [
        None, "unknown-rule", None,
    ]  # fmt: skip
    assert found[1]["error"][0]["line"] == 2
    assert (summary.tasks, summary.done, summary.faulty) == (3, 3, 1)
    assert summary.errors == [
        f"some-2 on signer: unknown-rule: there is no rule `:nobody` ({source}:2)"
    ]
    same = [(tmp_path / "out" / row["files"]["bvh"]).read_bytes() for row in found if row["files"]]
    assert same == [same[0]] * 2


@pytest.mark.long
def test_one_bad_text_in_five_costs_itself_and_a_second_run_does_nothing(tmp_path: Path) -> None:
    source, out = listed(tmp_path, 5), tmp_path / "out"
    summary, _ = ran(source, out)
    found = rows(out)
    assert [row["name"] for row in found if row["error"]] == [f"t{FAULTY}"]
    assert len(found) == 4 * 4 + 1
    assert (summary.clips, summary.files, summary.faulty) == (16, 32, 1)
    first = found[0]
    assert first["given"] == {"gloss": "G0"}
    assert first["met"] == 1
    assert (first["missed"], first["eased"]) == (0, 0)
    assert (first["hand"], first["speed"], first["camera"]) == ("right", 1.0, None)
    assert first["labels"][0]["path"] == ["sign"]
    assert first["labels"][0]["end_s"] > first["labels"][0]["start_s"]
    assert first["seconds"]["task"] > first["seconds"]["solve"] > 0
    before, bytes_before = states(out), clips(out)
    assert ran(source, out)[1] == []
    assert states(out) == before
    assert clips(out) == bytes_before


@pytest.mark.long
def test_what_changes_or_is_lost_is_done_again_and_nothing_else(tmp_path: Path) -> None:
    source, out = listed(tmp_path, 3), tmp_path / "out"
    few = Options((".bvh", ".json"))
    ran(source, out, few)
    (out / "t1" / "signer.bvh").unlink()
    assert ran(source, out, few)[1] == ["t1 on signer"]
    text = source.read_text(encoding="utf-8")
    source.write_text(text.replace("0.04", "0.05"), encoding="utf-8")
    assert ran(source, out, few)[1] == ["t2 on signer"]
    assert len(ran(source, out, replace(few, formats=(".bvh",)))[1]) == 3
    assert sorted(path.name for path in out.glob("t0/*")) == ["signer.bvh", "signer.task.json"]


def test_a_key_depends_on_the_libraries_that_are_used(tmp_path: Path) -> None:
    (tmp_path / "mine.azee").write_text("use 'deeper\ndef a\n  :b\n", encoding="utf-8")
    (tmp_path / "deeper.azee").write_text("def b\n  :bien\n", encoding="utf-8")
    (tmp_path / "other.azee").write_text("def c\n  :bien\n", encoding="utf-8")
    source = tmp_path / "text.azee"
    source.write_text("use 'mine\n:a\n", encoding="utf-8")

    def key() -> str:
        (task,) = tasks_of(texts_of([source]), [body_of("signer")], OPTIONS, [])
        return task.key

    before = key()
    (tmp_path / "other.azee").write_text("def c\n  :arbre\n", encoding="utf-8")
    assert key() == before
    (tmp_path / "deeper.azee").write_text("def b\n  :arbre\n", encoding="utf-8")
    assert key() != before


@pytest.mark.long
def test_the_same_as_compile_writes(tmp_path: Path) -> None:
    source = tmp_path / "text.azee"
    source.write_text(TEXT, encoding="utf-8")
    ran(source, tmp_path / "out", Options((".glb",)))
    azee.compile(source).save(tmp_path / "text.glb")
    written = (tmp_path / "out" / "text" / "signer.glb").read_bytes()
    assert written == (tmp_path / "text.glb").read_bytes()


def test_speeds_and_hands_change_the_clip_and_all_times_with_it(made: Compilation) -> None:
    half = varied(made, Variation("left", None, 0.5))
    assert half.clip.duration_s == pytest.approx(2 * made.clip.duration_s, abs=1 / 30)
    assert np.diff(half.clip.times) == pytest.approx(1 / 30)
    mirror = mirrored(made.rig.coordinates, made.clip.coordinates)
    bounds = made.rig.coordinates.lower, made.rig.coordinates.upper
    np.testing.assert_allclose(half.clip.coordinates[::2], np.clip(mirror, *bounds), atol=1e-9)
    assert half.score.duration == 2 * made.score.duration
    for name in ("key_times", "lead_s"):
        twice = 2 * np.array(getattr(made.animation, name))
        np.testing.assert_allclose(getattr(half.animation, name), twice)
    assert half.animation.tracks[0].end_s == 2 * made.animation.tracks[0].end_s
    assert varied(made, Variation("right", None, 1.0)).clip is made.clip


def test_seeds_move_life_and_leave_the_postures(tmp_path: Path) -> None:
    source = tmp_path / "text.azee"
    source.write_text(TEXT, encoding="utf-8")
    out = tmp_path / "out"
    ran(source, out, Options((".json",), seeds=(None, 1, 2)))
    found = rows(out)
    assert [row["seed"] for row in found][1:] == [1, 2]
    assert len({(out / row["files"]["json"]).read_bytes() for row in found}) == 3
    azee.compile(source, seed=2).save(tmp_path / "two.json")
    same = (out / "text" / "signer-seed2.json").read_bytes()
    assert json.loads(same) == json.loads((tmp_path / "two.json").read_bytes())


@pytest.mark.long
@pytest.mark.parametrize("renderer", ["software", "opengl"])
def test_films_are_drawn_by_the_renderer_that_is_asked_for(
    renderer: str, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    if renderer == "opengl":
        request.getfixturevalue("opengl")
    source = tmp_path / "text.azee"
    source.write_text(TEXT, encoding="utf-8")
    out = tmp_path / "out"
    ran(source, out, Options((".mp4",), cameras=("face",), renderer=renderer, fps=4))
    (row,) = rows(out)
    assert row["renderer"] == renderer
    assert (out / row["files"]["mp4"]).stat().st_size > 1000


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--formats", "glb,fbx"], "there is no format `fbx`; there are: glb"),
        (["--formats", "glb,glb"], "`.glb` is there twice"),
        (["--bodies", "signer,nobody"], "there is no rig `nobody`"),
        (["--hands", "both"], "there is no hand `both`"),
        (["--seeds", "-1"], "`-1` is no seed"),
        (["--speeds", "1,fast"], "`fast` is no speed from 0.1 to 10"),
        (["--cameras", "front"], "--cameras need a format that is seen from one: mp4"),
        (["--formats", "mp4", "--cameras", "above"], "there is no camera `above`"),
        (["--renderer", "auto"], "--renderer needs a film: mp4, webm"),
        (["--workers", "0"], "0 is not in the range"),
        (["--workers", "2", "--scheduler", "tcp://127.0.0.1:1"], "do not go with --scheduler"),
    ],
)
def test_bad_options_get_one_message(
    arguments: list[str],
    words: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    source = listed(tmp_path, 1)
    assert run(["batch", str(source), "-o", str(tmp_path / "out"), *arguments]) == 2
    told = capsys.readouterr().err
    assert words in " ".join(told.split())
    assert told.count("Error") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("sources", "out", "words"),
    [
        (["missing.azee"], "out", "there is no file `missing.azee`"),
        (["empty"], "out", "the folder `empty` has no text"),
        (["texts.jsonl"], "texts.jsonl/out", "`texts.jsonl"),
    ],
)
def test_places_that_do_not_exist_get_one_message(
    sources: list[str],
    out: str,
    words: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    listed(tmp_path, 1)
    (tmp_path / "empty").mkdir()
    assert run(["batch", *sources, "-o", out]) == 1
    told = capsys.readouterr().err
    assert words in told
    assert told.count("error[") == 1


def test_two_batches_do_not_write_to_one_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from azee.batch.folder import opened

    source = listed(tmp_path, 1)
    with opened(tmp_path / "out"):
        assert run(["batch", str(source), "-o", str(tmp_path / "out")]) == 1
    assert "another `azee batch` is writing to" in capsys.readouterr().err
