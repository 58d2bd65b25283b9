"""`azee play` and `azee db record`: texts as sequences of signs, and texts as signs."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image
from sqlalchemy import update

from azee.cli.main import run
from azee.clip.archive import read_clip
from azee.clip.clip import Clip
from azee.clips import save_clip
from azee.formats import SUFFIXES
from azee.signs import recordings
from azee.signs.database import SignDatabase
from azee.signs.recordings import SignRecordings
from azee.signs.sign import Sign
from azee.signs.tables import MOTION
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver import kinematics


def lifted(signer: Rig, angle: float) -> Clip:
    """An arm that is lifted and lowered in two seconds."""
    t = np.arange(61) / 30
    q = np.tile(signer.coordinates.idle, (61, 1))
    q[:, signer.coordinates.index["f_arm_R.flexion"]] += angle * np.sin(np.pi * t / 2) ** 2
    q[:, signer.coordinates.index["head.axial"]] += 0.2
    return Clip(
        t, np.clip(q, signer.coordinates.lower, signer.coordinates.upper), (), np.zeros((61, 0))
    )


@pytest.fixture
def db(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, signer: Rig) -> str:
    """A database with the signs `a`, `b` and `space`."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("AZEE_DB", "signs.db")
    assert run(["db", "create", "--quiet"]) == 0
    for name, angle in (("a", 0.5), ("b", 0.8), ("space", 0.1)):
        save_clip(lifted(signer, angle), signer, f"{name}.npz")
    assert run(["db", "add", "a.npz", "b.npz", "space.npz", "--attack", ".6", "--quiet"]) == 0
    return "signs.db"


def test_repositioning_can_be_taken_back(db: str, signer: Rig) -> None:
    """G10: wherever the sign is read its head faces the viewer; what is stored stays."""
    head = signer.coordinates.index["head.axial"]
    idle = signer.coordinates.idle[head]
    turns = []
    for options in ([], ["--undo"]):
        assert run(["db", "reposition", "a", "--quiet", *options]) == 0
        assert run(["db", "export", "a", "-o", "a.npz", "--quiet"]) == 0
        turns.append(read_clip("a.npz", signer).coordinates[30, head] - idle)
    assert turns == pytest.approx([0.0, 0.2], abs=1e-9)
    assert run(["db", "reposition"]) == 2


def test_a_movement_is_read_once_and_when_it_is_played(
    db: str, signer: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    """G16: finding a sign reads no movement; playing it twice reads it once."""
    read: list[str] = []
    clip = SignDatabase.clip

    def counted(self: SignDatabase, sign: Sign, rig: Rig) -> Clip:
        read.append(sign.identity.name)
        return clip(self, sign, rig)

    monkeypatch.setattr(SignDatabase, "clip", counted)
    recordings._clip.cache_clear()
    found = SignRecordings(db).find("a", None, None)
    assert read == []
    assert found.motion.clip(signer) is found.motion.clip(signer)
    assert read == ["a"]
    child = load_rig("child")
    assert len(found.motion.clip(child).times) == 61  # carried over


@pytest.mark.slow
def test_every_format_is_written_and_names_the_sign(db: str, signer: Rig) -> None:
    """G13, G23: a sign a character, space too; the current one in labels, scores and ELAN."""
    outputs = [f"x{suffix}" for suffix in SUFFIXES]
    options = [option for name in outputs for option in ("-o", name)]
    text = ["a b", "--text-mode", "thesis", "--report", "r.json"]
    assert run(["play", *text, *options, "--quiet"]) == 0
    clip = read_clip("x.npz", signer)
    assert [label.text for label in clip.labels] == ["a", "space", "b"]
    # idle, `a` without .4 s of its decay, `space` without its attack too, `b` without its attack
    assert clip.duration_s == pytest.approx(0.5 + 1.6 + 1.0 + 1.4 + 0.5, abs=0.04)
    annotations = ElementTree.parse("x.eaf").iter("ANNOTATION_VALUE")
    assert {"a", "space", "b"} <= {a.text for a in annotations}
    assert "space" in Path("x.svg").read_text("utf-8")
    with Image.open("x.png") as picture:
        assert picture.width > 300
    report = json.loads(Path("r.json").read_text("utf-8"))
    assert [r["name"] for r in report["recordings"]] == ["a", "space", "b"]
    assert report["limits"]["max_excess_rad"] == 0.0


@pytest.mark.slow
def test_unknown_characters_are_left_out_and_told(
    db: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["play", "axb", "--text-mode", "turkish", "-o", "x.npz", "--strict"]) == 3
    told = capsys.readouterr().err
    assert "has no sign for `x`; it is left out" in told
    assert ": a b" in told
    assert run(["play", "xyz", "--text-mode", "turkish"]) == 1
    assert "there is no sign of the text to play" in capsys.readouterr().err


@pytest.mark.slow
def test_words_are_looked_for_in_the_database_then_rules_then_spelled(
    db: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["play", "A bien", "og", "--language", "", "-o", "x.npz"]) == 0
    told = capsys.readouterr().err
    assert "there is no sign for `og`: it is spelled" in told
    assert told.count("warning") == 1
    assert ": a bien og" in told


@pytest.mark.slow
@pytest.mark.parametrize("blend", ["direct", "smooth", "linear"])
def test_the_hand_stays_up_from_l_to_j(
    blend: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, signer: Rig
) -> None:
    """G17, figure 5.5: the letters L → J blend, and the hand that both use stays up."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("AZEE_DB", "letters.db")
    assert run(["db", "create", "--quiet"]) == 0
    for letter in "lj":
        text = f":fingerspelling('text = \"{letter}\", 'language = 'tid)"
        assert run(["db", "record", letter, "-e", text, "--quiet"]) == 0
    way = [] if blend == "direct" else ["--transition", ".4"]
    options = ["--text-mode", "turkish", "--blend", blend, *way]
    assert run(["play", "lj", *options, "-o", "lj.npz", "--report", "r.json"]) == 0
    clip = read_clip("lj.npz", signer)
    report = json.loads(Path("r.json").read_text("utf-8"))
    leaving, arriving = (recording["body_s"] for recording in report["recordings"])
    frames = kinematics.frames(signer.chain, clip.coordinates)
    height = frames.positions[:, signer.bones["palm_L"].node, 1]
    times = clip.times - report["lead_s"]
    between = height[(times >= leaving[1]) & (times <= arriving[0])]
    assert len(between) > 10
    assert between.min() > min(between[0], between[-1]) - 0.05
    assert between.min() > height[0] + 0.3  # where hands hang


@pytest.mark.slow
def test_a_text_becomes_a_sign_and_comes_back_as_a_recording(db: str, signer: Rig) -> None:
    """What azee compiles goes into the database, and a sentence plays it as it was."""
    assert run(["compile", "-e", ":bien", "-o", "bien.npz", "--quiet"]) == 0
    assert run(["db", "record", "BIEN", "-e", ":bien", "--quiet"]) == 0
    assert run(["compile", "-e", "recorded 'BIEN", "-o", "again.npz", "--report", "r.json"]) == 0
    played = json.loads(Path("r.json").read_text("utf-8"))
    (recording,) = played["recordings"]
    one, other = read_clip("bien.npz", signer), read_clip("again.npz", signer)
    with SignDatabase.open(db) as signs:
        sign = signs.one("BIEN")
        assert sign.facts.kind == "azee"
        assert sign.facts.provenance["expression"] == ":bien"
        assert signs.original(sign) == ("BIEN.azee", b":bien\n")
        stored = signs.clip(sign, signer).coordinates
    before = int(np.abs(one.coordinates - stored[0]).max(axis=1).argmin())
    np.testing.assert_array_equal(stored, one.coordinates[before : before + len(stored)])
    first = sign.facts.timing.attack_s + before / 30
    arm = [v for v, name in enumerate(signer.coordinates.names) if name.startswith("arm_R")]
    start = played["lead_s"] + recording["body_s"][0]
    for since in (0.0, 0.4, 0.8):
        there = one.coordinates[int(np.abs(one.times - first - since).argmin()), arm]
        back = other.coordinates[int(np.abs(other.times - start - since).argmin()), arm]
        assert np.degrees(np.abs(there - back)).max() < 2.5  # frames are up to half a step apart


@pytest.mark.parametrize(
    ("command", "said"),
    [
        (["check", "-e", "recorded 'a", "--db", "none.db"], "error[sign-database]: `none.db`"),
        (["check", "-e", "recorded 'x"], "error[unknown-sign]: `signs.db` has no sign `x`"),
        (["compile", "-e", "recorded 'b"], "error[damaged-sign]: the movement of `b` is damaged"),
        (["play", "b"], "error[damaged-sign]: the movement of `b` is damaged"),
        (["play", "a", "--db", "none.db"], "error[sign-database]: `none.db`"),
        (["db", "record", "a", "-e", ":bien :bien"], "error[expected-argument-name]"),
        (["rig", "calibration", "none.bvh"], "error[cannot-read]: there is no file `none.bvh`"),
        (["score", "-e", ":bien", "--shortcuts", "none.txt"], "error[cannot-read]"),
    ],
    ids=lambda x: x if isinstance(x, str) else " ".join(x[:2]),
)
def test_bad_input_gives_one_message(
    command: list[str], said: str, db: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with SignDatabase.open(db) as signs, signs.store.writing() as connection:
        number = signs.one("b").number
        connection.execute(update(MOTION).where(MOTION.c.sign == number).values(clip=b"?"))
    recordings._clip.cache_clear()  # by content: other tests have read the same movement whole
    assert run(command) == 1
    told = capsys.readouterr().err
    assert said in told
    assert told.count("error[") == 1
