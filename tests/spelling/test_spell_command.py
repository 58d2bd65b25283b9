"""`azee spell timing | fit | evaluate | warp`, as a user types them."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from programs import Python
from pympi import Eaf

from azee.cli.main import run
from azee.clip.archive import read_clip, write_clip
from azee.clip.clip import Clip, Label
from azee.spelling.timing.drawn import drawn_words
from azee.spelling.timing.schedule import duration_s, schedule
from azee.spelling.timing.timed_word import read_times, write_times
from azee_rig.rig import Rig

PAGE = Path(__file__).parents[2] / "docs" / "spelling-timing.md"


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_times_are_printed_with_where_they_come_from(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["spell", "timing", "cab", "--timing", "constant"]) == 0
    assert capsys.readouterr().out == (
        "letter  hold ms  transition ms\n"
        "C           243            250\n"
        "A           243            250\n"
        "B           800\n"
        "1786 ms; times drawn from published statistics (Wheatland 2016), not recorded\n"
    )


def test_json_says_the_same(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["spell", "timing", "elephant", "--speed", "2", "--format", "json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert "not recorded" in told["origin"]
    assert told["duration_ms"] == pytest.approx(500 * duration_s(schedule("elephant")), abs=0.01)
    assert "".join(row["letter"] for row in told["letters"]) == "ELEPHANT"


@pytest.mark.parametrize(
    ("arguments", "message", "code"),
    [
        (["timing", "quokka", "--timing", "motion"], "`QUOKKA` is not among the words", 1),
        (["timing", "a b"], "no word of letters", 2),
        (["timing", "abc", "--model", "none.json"], "there is no file `none.json`", 1),
        (["timing", "abc", "--model", "wrong.json"], "it is no timing model of azee", 1),
        (["fit", "-o", "m.json"], "give FILEs, or --drawn SEED", 2),
        (["fit", "t.txt", "-o", "m.json"], "`t.txt` is none of .eaf .npz .csv", 1),
        (["fit", "few.csv", "-o", "m.json"], "3 letters are too few", 1),
    ],
)
def test_wrong_use_is_told_in_a_sentence(
    arguments: list[str], message: str, code: int, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("wrong.json").write_text("{}")
    Path("few.csv").write_text(
        "word,spelling,letter,hold_ms,transition_ms\nCAB,1,C,90,90\nCAB,1,A,90,90\nCAB,1,B,90,\n"
    )
    assert run(["spell", *arguments]) == code
    assert message in capsys.readouterr().err


def test_a_model_of_ones_own_words(capsys: pytest.CaptureFixture[str]) -> None:
    """A signer of half the speed gets a model of half the speed, and its words as `motion`."""
    slow = [
        type(w)(w.word, tuple(2 * t for t in w.holds_s), tuple(2 * t for t in w.transitions_s))
        for w in drawn_words()
    ]
    write_times(slow, "slow.csv")
    assert run(["spell", "fit", "slow.csv", "-o", "slow.json", "--times", "again.csv"]) == 0
    assert "61 words, 304 letters" in capsys.readouterr().err
    assert Path("again.csv").read_bytes() == Path("slow.csv").read_bytes()
    assert run(["spell", "timing", "quokka", "--model", "slow.json", "--format", "json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["origin"] == "fitted to 61 recorded words"
    assert told["duration_ms"] == pytest.approx(2000 * duration_s(schedule("quokka")), rel=0.05)


def test_drawn_words_give_the_model_that_ships() -> None:
    import azee.spelling.timing

    folder = Path(azee.spelling.timing.__path__[0]) / "data"
    assert run(["spell", "fit", "--drawn", "1", "-o", "normal.json", "--quiet"]) == 0
    ours, shipped = (
        json.loads(p.read_text()) for p in (Path("normal.json"), folder / "normal.json")
    )
    assert ours["words"] == shipped["words"]


@pytest.mark.slow
def test_an_evaluation_with_tables_and_figures(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["spell", "evaluate", "-o", "out"]) == 0
    told = json.loads(Path("out/evaluation.json").read_text())
    held_out = told["holds"]["ridge"]["words held out"]["error_ms"]
    assert 5 * held_out < told["holds"]["constant, last letter like others"]["error_ms"]
    assert {fact["verdict"] for fact in told["facts"]} == {
        "drawn from it",
        "reproduced",
        "corrected",
    }
    assert all(fact["reason"] for fact in told["facts"] if fact["verdict"] == "corrected")
    figures = sorted(Path("out").glob("*.png"))
    assert [path.stem for path in figures] == [f"figure-4-{n}" for n in range(3, 9)]
    for path in figures:
        with Image.open(path) as picture:
            assert np.asarray(picture.convert("L")).std() > 10
    page = Path("out/evaluation.md").read_text()
    assert _rows(page) == _rows(PAGE.read_text(encoding="utf-8").partition("<!-- figures")[2])
    assert "| table 4.2" in page
    assert "| table 4.3" in page
    assert "not recorded" in page


@pytest.mark.slow
def test_a_small_model_is_measured_as_far_as_it_goes(capsys: pytest.CaptureFixture[str]) -> None:
    words = drawn_words()
    write_times(words[:8], "few.csv")
    write_times(words[40:44], "fewer.csv")
    for name in ("few", "fewer"):
        assert run(["spell", "fit", f"{name}.csv", "-o", f"{name}.json", "--quiet"]) == 0
    assert run(["spell", "evaluate", "--model", "few.json", "-o", "few", "--quiet"]) == 0
    told = json.loads(Path("few/evaluation.json").read_text())
    assert {fact["verdict"] for fact in told["facts"]} == {"reproduced", "differs"}
    assert not any(fact["reason"] for fact in told["facts"])  # these are of what was drawn
    assert run(["spell", "evaluate", "--model", "fewer.json", "-o", "fewer"]) == 1
    assert "5 different words are needed" in capsys.readouterr().err


def test_elan_files_make_a_model(capsys: pytest.CaptureFixture[str]) -> None:
    words = drawn_words()[20:32]
    for word in words:
        file = Eaf()
        file.add_tier("words")
        file.add_tier("letters")
        file.add_annotation("words", 950, 1050 + round(1000 * word.duration_s), word.word.lower())
        for letter, (start, end) in zip(word.word, word.hold_spans_s, strict=True):
            span = (1000 + round(1000 * start), 1000 + round(1000 * end))
            file.add_annotation("letters", *span, letter)
        file.to_file(f"{word.word}.eaf")
    files = [f"{word.word}.eaf" for word in words]
    assert run(["spell", "fit", *files, "-o", "m.json", "--times", "t.csv", "--quiet"]) == 0
    for found, word in zip(read_times("t.csv"), words, strict=True):
        assert found.word == word.word
        assert found.holds_s == pytest.approx(word.holds_s, abs=0.0015)
        assert found.transitions_s == pytest.approx(word.transitions_s, abs=0.0015)


def _rows(page: str) -> list[tuple[str, list[float]]]:
    """Rows of tables: their words, and their numbers to two digits."""
    rows = [line for line in page.splitlines() if line.startswith("|")]
    number = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")
    return [
        (number.sub("#", row), [float(f"{float(n):.2g}") for n in number.findall(row)])
        for row in rows[
            : next((i for i, row in enumerate(rows) if row == "| file | content |"), None)
        ]
    ]


def test_the_page_shows_what_the_command_prints(capsys: pytest.CaptureFixture[str]) -> None:
    _, shown = PAGE.read_text(encoding="utf-8").split("```console\n$ azee ", 1)
    command, _, printed = shown.partition("\n")
    assert run(command.split()) == 0
    assert capsys.readouterr().out == printed.partition("```")[0]


def test_a_clip_is_warped(signer: Rig) -> None:
    word = next(w for w in drawn_words() if w.word == "GUITAR")
    write_times([word], "guitar.csv")
    times = np.arange(round(60 * (word.duration_s + 1)) + 1) / 60
    moving = np.tile(signer.coordinates.idle, (len(times), 1))
    elbow = signer.coordinates.index["f_arm_R.flexion"]
    moving[:, elbow] += 0.2 * np.sin(3 * times)
    labels = tuple(
        Label((c,), 0.5 + a, 0.5 + b)
        for c, (a, b) in zip(word.word, word.hold_spans_s, strict=True)
    )
    clip = Clip(times, moving, (), np.zeros((len(times), 0)), labels)
    with Path("guitar.npz").open("wb") as file:
        write_clip(clip, signer, file)
    command = ["spell", "warp", "guitar.npz", "--word", "guitar", "--times", "guitar.csv"]
    assert (
        run([*command, "--start", ".5", "--timing", "constant", "-o", "made.npz", "--quiet"]) == 0
    )
    made = read_clip(Path("made.npz"), signer)
    constant = schedule("GUITAR", "constant")
    assert made.duration_s == pytest.approx(1 + duration_s(constant), abs=2 / 60)
    assert [x.end_s - x.start_s for x in made.labels] == pytest.approx(
        [t.hold_s for t in constant], abs=1e-4
    )
    assert run([*command, "--start", "1.4", "-o", "late.npz"]) == 1


@pytest.mark.long
def test_without_the_extra_a_message_says_what_to_install(python: Python) -> None:
    script = (
        "import sys; sys.modules['sklearn'] = None\n"
        "from azee.cli.main import run; sys.exit(run(sys.argv[1:]))"
    )
    done = python("-c", script, "spell", "fit", "--drawn", "1", "-o", "m.json", expect=1)
    assert "pip install 'azee[spelling]'" in done.stderr
    python("-c", script, "spell", "timing", "word", expect=0)
