"""What results look like: diagrams of scores, other values by their kind, commands."""

from __future__ import annotations

from pathlib import Path

import pytest
from PIL import Image

from azee.lang.program import evaluate_expression
from azee.repl.commands import COMMANDS, answer
from azee.repl.diagram import MOST_ROWS, diagram
from azee.repl.ink import Ink, width, written
from azee.repl.performer import Performer
from azee.repl.repl import Repl
from azee.repl.screen import Screen
from azee.repl.session import Evaluated, Session
from azee.repl.value_text import value_lines


class Sheet:
    """A screen whose text can be read."""

    def __init__(self) -> None:
        self.text = ""
        self.screen = Screen(self.put, self.put, colour=False, fixed_columns=80)

    def put(self, text: str) -> None:
        self.text += text

    def taken(self) -> str:
        text, self.text = self.text, ""
        return text


@pytest.fixture
def sheet() -> Sheet:
    return Sheet()


@pytest.fixture
def repl(sheet: Sheet) -> Repl:
    return Repl(
        Session(), Performer("signer", "right"), sheet.screen, interactive=False, solving=False
    )


def shown(text: str) -> str:
    (outcome,) = Session().enter(text)
    assert isinstance(outcome, Evaluated), outcome
    return written(value_lines(outcome.value, 60, colour=False), colour=False)


SYNC = """sync
    'SIG key(1, look(^fwd))
    'FACE key(1, morph('AU12, .6))
    'start/end 'SIG:start:.25 'SIG:start:.75
    'BLINK key(0, morph('AU43, 1))
    'start 'SIG:end
"""


def test_a_score_is_a_diagram_over_a_time_axis() -> None:
    assert shown(SYNC) == (
        "0           0.2         0.4         0.6         0.8      1 s\n"
        "├───────────┴───────────┴───────────┴───────────┴──────────┤\n"
        "├group─────────────────────────────────────────────────────┤\n"
        "├SIG───────────────────────────────────────────────────────┤\n"
        "               ├FACE────────────────────────┤        BLINK │\n"
        "a score of 1 s, 3 blocks\n"
    )


@pytest.mark.parametrize("columns", [24, 60, 131])
@pytest.mark.parametrize(
    "text", [SYNC, ":info-about(:cinéma, :bien)", "blank 0", "not-but(tree(), wardrobe())"]
)
def test_a_diagram_keeps_to_its_columns_and_its_bars_to_their_times(
    text: str, columns: int
) -> None:
    score = evaluate_expression(text).score
    lines = diagram(score, columns, colour=True)
    assert all(sum(width(part) for _, part in line) <= columns for line in lines[:-1])
    assert len(lines) <= MOST_ROWS + 4
    whole = [part for ink, part in lines[2] if ink is Ink.GROUP]
    assert not whole or width(whole[0]) == columns


def test_a_long_score_leaves_out_what_is_deep() -> None:
    score = evaluate_expression(
        "seq (map (azop 'n 'nodefault :info-about(:cinéma, :bien)) (range 1 30))"
    ).score
    lines = diagram(score, 80, colour=False)
    assert len(lines) <= MOST_ROWS + 4
    assert "/score" in lines[-1][0][1]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("div 1 4", "0.25  a number\n"),
        ("eq 1 1", "yes  a boolean\n"),
        ("opposite s", "w  a side\n"),
        ("^up", "^up  a vector\ndepends on nothing: the same in every posture\n"),
        (
            "oppvect (nrm !palm(L))",
            "oppvect(nrm(!palm(L)))  a vector\ndepends on !palm(L): known once the body stands\n",
        ),
        (
            "vtranslate @I_TIP(s) ^up",
            """vtranslate(@I_TIP(s), ^up)  a point
depends on @I_TIP(s): known once the body stands
depends on which hand is the strong one
""",
        ),
        (
            ".about-ref(blank(1))",
            ".about-ref  an operator\n  'sig  1 s\n  'pt  open\n",
        ),
        ("list 1 'a", "a list of 2 values\n  1  1  a number\n  2  'a  a symbol\n"),
        ("look ^fwd", "look ^fwd\n1 constraint\n"),
    ],
)
def test_a_value_is_shown_by_its_kind(text: str, expected: str) -> None:
    assert shown(text) == expected


def test_the_page_tells_of_every_command() -> None:
    page = (Path(__file__).parents[2] / "docs" / "repl.md").read_text(encoding="utf-8")
    told = page.replace("\\|", "|")
    assert [c.pattern for c in COMMANDS.values() if f"`{c.pattern}" not in told] == []


def test_a_body_that_is_not_there_is_refused(repl: Repl, sheet: Sheet) -> None:
    assert not answer(repl, "/rig nobody")
    assert "nobody" in sheet.taken()
    assert answer(repl, "/rig")
    assert "signer: 44 bones" in sheet.taken()


def test_a_fault_of_ours_does_not_end_the_session(
    repl: Repl, sheet: Sheet, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr(repl.session, "enter", broken)
    with pytest.raises(ZeroDivisionError):
        answer(repl, "1")
    repl.interactive = True
    assert not answer(repl, "1")
    assert "the session goes on" in sheet.taken()


def test_rules_are_listed_searched_and_described(repl: Repl, sheet: Sheet) -> None:
    assert answer(repl, 'def kitten\n    \'meaning "a small chat"\n    :chat')
    sheet.taken()
    assert answer(repl, "/rules CHAT")
    here, found = sheet.taken().splitlines()[:2]
    assert (here, found.split()) == ("here", [":kitten", "a", "small", "chat"])
    assert answer(repl, "/doc :info-about")
    assert ":info-about 'topic 'info  rule" in sheet.taken()
    assert not answer(repl, "/doc nothing-like-it")
    assert "nothing is called" in sheet.taken()


def test_residuals_by_constraint(repl: Repl, sheet: Sheet) -> None:
    assert not answer(repl, "/solve")
    assert "there is no result yet" in sheet.taken()
    answer(repl, "key .2 (cstr (place @I_TIP(s) @CH) (place @I_TIP(w) (point 0 9 0)))")
    sheet.taken()
    assert answer(repl, "/solve")
    table = sheet.taken().splitlines()
    assert table[0].split() == ["seconds", "block", "constraint", "off", "by", "of"]
    assert [line[-1] for line in table if line.startswith("0.00")] == ["✓", "✗"]
    summary, miss, strain = table[-3:]
    assert "1 of 2 constraints is out of tolerance" in summary
    assert "place @I_TIP(w) point(0, 9, 0)" in miss
    assert "the trunk leans" in strain


def test_what_was_typed_is_saved_as_a_file_that_gives_the_same(
    repl: Repl, sheet: Sheet, tmp_path: Path
) -> None:
    answer(repl, 'def half\n    \'meaning "a half"\n    .5')
    answer(repl, "key half() (look ^fwd)")
    assert answer(repl, f"/save {tmp_path / 'mine.azee'}")
    assert (tmp_path / "mine.azee").read_text(encoding="utf-8") == (
        'def half\n    \'meaning "a half"\n    .5\n\nkey half() (look ^fwd)\n'
    )
    answer(repl, "^_")
    assert not answer(repl, f"/save {tmp_path / 'other.azee'}")
    assert not answer(repl, f"/save {tmp_path / 'mine.doc'}")
    answer(repl, "key .5 (look ^fwd)")
    assert not answer(repl, f"/save {tmp_path / 'nowhere' / 'mine.azee'}")
    assert "cannot-write" in sheet.taken()


@pytest.mark.long
def test_pictures_of_the_score_and_of_a_posture(repl: Repl, sheet: Sheet, tmp_path: Path) -> None:
    answer(repl, SYNC)
    for name in ("score.png", "score.svg"):
        assert answer(repl, f"/score {tmp_path / name}")
    assert answer(repl, f"/render {tmp_path / 'posture.png'} .5 face")
    with Image.open(tmp_path / "score.png") as score:
        assert score.width > score.height
        assert len(score.getcolors(100_000) or ()) > 20
    with Image.open(tmp_path / "posture.png") as posture:
        assert posture.size == (720, 900)
    assert not answer(repl, f"/render {tmp_path / 'posture.png'} .5 above")
    assert "there is no view `above`" in sheet.taken()
