"""What users have becomes timed words: ELAN files written by pympi, landmarks, tables."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pympi import Eaf

from azee.spelling.timing.landmarks import JOINTS, joint_angles
from azee.spelling.timing.letter_poses import LetterPoses, asl_poses
from azee.spelling.timing.recordings import read_recording
from azee.spelling.timing.timed_word import TimedWord, TimesError, read_times, write_times

CAB = TimedWord("CAB", (0.1, 0.12, 0.3), (0.2, 0.25))


def _eaf(path: Path, letters: str = "CAB", word: str = "cab") -> Path:
    file = Eaf()
    file.add_tier("Words")
    file.add_tier("letters")
    for number, begin in enumerate((1000, 4000)):
        file.add_annotation("Words", begin - 50, begin + 1500, word)
        for letter, (start, end) in zip(letters, CAB.hold_spans_s, strict=True):
            offset = begin + 10 * number
            span = (offset + round(1000 * start), offset + round(1000 * end))
            file.add_annotation("letters", *span, letter)
    file.to_file(str(path))
    return path


def test_an_elan_file(tmp_path: Path) -> None:
    first, second = read_recording(_eaf(tmp_path / "a.eaf"), asl_poses())
    assert (first.word.word, first.word.spelling, second.word.spelling) == ("CAB", 1, 2)
    assert (first.start_s, second.start_s) == (1.0, 4.01)
    assert first.word.holds_s == pytest.approx(CAB.holds_s)
    assert first.word.transitions_s == pytest.approx(CAB.transitions_s)


def test_what_is_wrong_with_an_elan_file_is_told_with_its_place(tmp_path: Path) -> None:
    path = _eaf(tmp_path / "a.eaf", letters="CAP")
    with pytest.raises(TimesError, match=r"0\.95 s: the letters `CAP` stand under the word `CAB`"):
        read_recording(path, asl_poses())
    with pytest.raises(TimesError, match=r"has no tier `holds`; its tiers: .*`letters`"):
        read_recording(path, asl_poses(), ("words", "holds"))
    (tmp_path / "b.eaf").write_text("<ANNOTATION")
    with pytest.raises(TimesError, match="no ELAN file"):
        read_recording(tmp_path / "b.eaf", asl_poses())


_WORDS = st.lists(
    st.text("ABCÇ", min_size=1, max_size=5).flatmap(
        lambda word: st.builds(
            TimedWord,
            st.just(word),
            st.tuples(*[st.integers(1, 9999).map(lambda n: n / 1000)] * len(word)),
            st.tuples(*[st.integers(1, 9999).map(lambda n: n / 1000)] * (len(word) - 1)),
            st.integers(1, 5),
        )
    ),
    min_size=1,
    max_size=5,
)


@given(_WORDS)
def test_a_table_gives_back_its_words(words: list[TimedWord]) -> None:
    path = Path("times.csv")
    write_times(words, path)
    assert read_times(path) == words


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path_factory.mktemp("times"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("word,letter\nA,A\n", "no column `spelling`"),
        ("word,spelling,letter,hold_ms,transition_ms\n", "holds no words"),
        ("word,spelling,letter,hold_ms,transition_ms\nAB,1,A,90,\n", "line 2: the letters `A`"),
        ("word,spelling,letter,hold_ms,transition_ms\nAB,1,A,90,80\nAB,1,B,x,\n", "line 2: could"),
        ("word,spelling,letter,hold_ms,transition_ms\nA,1,A,-90,\n", "not above 0"),
        ("word,spelling,letter,hold_ms,transition_ms\nA,0,A,90,\n", "counted from 1"),
    ],
)
def test_a_table_that_cannot_be_used(text: str, message: str) -> None:
    path = Path("times.csv")
    path.write_text(text, encoding="utf-8")
    with pytest.raises(TimesError, match=message):
        read_times(path)


def _hand(bend: float, *, turned: float = 0.0) -> np.ndarray:
    """Landmarks of a hand in a plane that bends every finger joint by an angle."""
    points = np.zeros((21, 3))
    for finger, base in enumerate((1, 5, 9, 13, 17)):
        side = 0.25 * (finger - 2)
        at, angle = np.array([side, -1.0, 0.0]), 0.0
        points[base] = at
        for link in range(1, 4):
            angle += bend
            at = at + 0.4 * np.array([0.0, -np.cos(angle), -np.sin(angle)])
            points[base + link] = at
    c, s = np.cos(turned), np.sin(turned)
    turn: np.ndarray = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    return np.asarray(points @ turn)


def test_angles_of_a_hand_that_bends() -> None:
    straight, bent = joint_angles(_hand(0.0)), joint_angles(_hand(0.5))
    named = dict(zip(JOINTS, bent, strict=True))
    assert np.abs(straight[JOINTS.index("middle_pip")]) < 1e-12
    for joint in ("index_pip", "index_dip", "little_pip", "ring_dip", "thumb_ip"):
        assert named[joint] == pytest.approx(0.5)
    assert named["middle_mcp"] == pytest.approx(0.5)
    tilted = dict(zip(JOINTS, joint_angles(_hand(0.5, turned=0.3)), strict=True))
    assert tilted["palm_tilt"] == pytest.approx(named["palm_tilt"] + 0.3)
    assert tilted["index_pip"] == pytest.approx(0.5)


def test_landmarks_with_their_text(tmp_path: Path) -> None:
    """Two letters are two bends; a word of them is found in the landmarks of a moving hand."""
    bends = {"A": 0.1, "B": 1.2, "C": 0.6}
    poses = LetterPoses(
        tuple(bends), JOINTS, np.array([joint_angles(_hand(b)) for b in bends.values()])
    )
    rate, frames = 120.0, []
    word = TimedWord("ABAC", (0.1, 0.12, 0.1, 0.2), (0.25, 0.2, 0.3))
    spans = word.hold_spans_s
    for time in np.arange(0, word.duration_s, 1 / rate):
        index = max(i for i, (start, _) in enumerate(spans) if start <= time)
        share = 0.0
        if time > spans[index][1]:
            s = (time - spans[index][1]) / word.transitions_s[index]
            share = s**3 * (10 - 15 * s + 6 * s**2)
        here = bends[word.word[index]]
        there = bends[word.word[min(index + 1, 3)]]
        frames.append(_hand(here + share * (there - here)))
    path = tmp_path / "abac.npz"
    np.savez(path, landmarks=np.array(frames), rate_hz=rate, text="abac")
    (found,) = read_recording(path, poses)
    assert found.word.word == "ABAC"
    np.testing.assert_allclose(found.word.holds_s, word.holds_s, atol=0.02)
    np.testing.assert_allclose(found.word.transitions_s, word.transitions_s, atol=0.02)


def test_landmarks_that_cannot_be_used(tmp_path: Path) -> None:
    path = tmp_path / "x.npz"
    np.savez(path, landmarks=np.zeros((5, 20, 3)), rate_hz=30, text="A")
    with pytest.raises(TimesError, match=r"\(frames, 21, 3\), not \(5, 20, 3\)"):
        read_recording(path, asl_poses())
    np.savez(path, landmarks=np.zeros((5, 21, 3)), text="A")
    with pytest.raises(TimesError, match="no array `rate_hz`"):
        read_recording(path, asl_poses())
    path.write_bytes(b"PK")
    with pytest.raises(TimesError, match="no NumPy archive"):
        read_recording(path, asl_poses())
