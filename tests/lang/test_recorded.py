"""`recorded`: recorded signs as scores, stretched, mirrored and drawn; shortcuts to them."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from any_recordings import ATTACK_S, DECAY_S, LASTS_S, AnyRecordings, RaisedArm
from evaluations import content, group, program

from azee.export.formats.eaf_content import GLOSS, RECORDED, content_tiers
from azee.export.pictures.score_svg import write_svg
from azee.export.score_text import tree
from azee.lang.program import load
from azee.lang.shortcuts import Shortcuts
from azee.score.interval import Interval
from azee.score.score import Call, Recorded, Score, leaves
from azee.score.stretch import stretched
from azee_grammar.diagnostic import AZeeError
from azee_grammar.source import Source


def recording(name: str = "BONJOUR") -> Recorded:
    calls = (Call("recorded", recorded=name),)
    return Recorded(
        LASTS_S, calls=calls, motion=RaisedArm(name), attack_s=ATTACK_S, decay_s=DECAY_S
    )


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("recorded 'BONJOUR", recording()),
        ('recorded "BONJOUR"', recording()),
        ("recorded 'A 'language 'lsf 'variant \"2\"", recording("A (lsf, 2)")),
        (
            "recorded 'BONJOUR 'attack .5 'decay 0",
            replace(recording(), attack_s=Fraction(1, 2), decay_s=Fraction(0)),
        ),
        ("mirror (recorded 'BONJOUR)", replace(recording(), mirrored=True)),
        ("mirror (mirror (recorded 'BONJOUR))", recording()),
    ],
)
def test_it_is_a_score_of_the_recordings_length(expression: str, expected: Score) -> None:
    assert content(expression) == expected


@pytest.mark.parametrize(
    ("expression", "code"),
    [
        ("recorded 'NONE", "unknown-sign"),
        ("recorded 'BONJOUR 'attack 3", "bad-sign"),
        ("recorded 'BONJOUR 'attack -1", "negative-duration"),
        ("recorded 1", "wrong-type"),
    ],
)
def test_what_cannot_be_played_is_told(expression: str, code: str) -> None:
    with pytest.raises(AZeeError) as caught:
        content(expression)
    assert [d.code for d in caught.value.diagnostics] == [code]


def test_without_a_database_it_says_how_to_name_one() -> None:
    with pytest.raises(AZeeError) as caught:
        load(Source("<none>", "")).value("recorded 'BONJOUR")
    assert caught.value.diagnostics[0].code == "no-recordings"
    assert "--db" in (caught.value.diagnostics[0].help or "")


def test_a_stretch_warps_the_body_and_neither_attack_nor_decay() -> None:
    long = stretched(recording(), Fraction(5))
    assert isinstance(long, Recorded)
    assert long.body == Interval(Fraction(1), Fraction(9, 2))
    short = stretched(recording(), Fraction(3, 4))  # no room for the ways: they share it
    assert isinstance(short, Recorded)
    assert short.body == Interval(Fraction(1, 2), Fraction(1, 2))


SENTENCE = "sync 'A (recorded 'BONJOUR) 'B (key 1 (look ^fwd)) 'start/end 'A:start 'A:end"


def test_score_drawings_texts_and_elan_files_name_it(tmp_path: Path) -> None:
    score = group(SENTENCE)
    assert "recorded 'BONJOUR'" in tree(score)
    write_svg(score, tmp_path / "score.svg")
    drawn = (tmp_path / "score.svg").read_text("utf-8")
    assert "A · BONJOUR" in drawn
    assert "a recorded sign" in drawn
    tiers = {tier.name: [note.text for note in tier.notes] for tier in content_tiers(score)}
    assert tiers[RECORDED] == ["BONJOUR"]
    assert tiers[GLOSS] == ["BONJOUR"]


TEXT = """def greeting
    'x "any"
    seq (list ^x :bonjour)

:greeting :bien
"""


def shortened(lines: str, text: str, expression: str | None = None) -> tuple[Score, Shortcuts]:
    shortcuts = Shortcuts.read(Source("s.txt", lines))
    made = shortcuts.on(load(Source("t.azee", text), recordings=AnyRecordings()))
    return made.evaluate(expression).score if expression else made.score(), shortcuts


def played(score: Score) -> list[str]:
    return [x.score.motion.name for x in leaves(score) if isinstance(x.score, Recorded)]


def test_the_first_template_that_matches_from_the_top_is_taken() -> None:
    lines = "# signs\n:bien => 'GOOD\nseq(list(?a, :bien)) => 'PAIR\n"
    score, shortcuts = shortened(lines, "", "seq(list(:bien, seq(list(:bonjour, :bien))))")
    assert played(score) == ["GOOD", "PAIR"]
    assert [t.recording for t in shortcuts.taken] == ["recorded 'GOOD", "recorded 'PAIR"]
    assert [*shortcuts.taken[1].bindings] == ["a"]
    score, shortcuts = shortened(lines, "", "seq(list(:bien, :bien))")
    assert played(score) == ["PAIR"]  # nothing inside a match is searched
    assert shortcuts.taken[0].as_json()["bindings"] == {"a": ":bien"}


def test_the_rules_of_a_text_are_what_they_are() -> None:
    score, _ = shortened(":bien => 'GOOD\n:bonjour => 'HELLO\n", ":bien\n")
    assert played(score) == ["GOOD"]


@pytest.mark.parametrize("line", [":bien", "=> 'X", ":bien =>", ":bien => 1 2", ": => 'X"])
def test_a_bad_shortcut_is_told_with_its_line(line: str) -> None:
    with pytest.raises(AZeeError):
        shortened(f"\n{line}\n", ":bien\n")


def test_equal_sentences_have_equal_recordings() -> None:
    assert program(f"{SENTENCE}\n").score() == program(f"{SENTENCE}\n").score()
