"""The arguments of `azee.compile`: what works, and the messages for wrong values and types."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import azee
from azee.compilation import perform
from azee_rig.load import RigError
from azee_rig.rig import Rig

TEXT = "key .2 (look ^fwd)\n"
LONG = "x" * 300


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        *(
            ({"solver": wrong}, r"no solver .*; the solvers are: grouped, two-level")
            for wrong in ("ik", "", None, 3, ["grouped"], np.zeros(2))
        ),
        *(
            ({"dominant": wrong}, r"no dominant hand .*; the hands are: right, left")
            for wrong in ("both", "Right", None, 1, ["right"])
        ),
        *(
            ({"mode": wrong}, r"no mode .*; the modes are: tracks, flat")
            for wrong in ("tree", None, 3, ["flat"])
        ),
        *(
            ({"fps": wrong}, r"frames per second make no clip; fps is a number from 1 on")
            for wrong in (0, -1, 0.3, "30", None, True, [30], 1e-300, float("nan"), float("inf"))
        ),
        ({"fps": 10**400}, "frames per second make no clip"),
        *(
            ({"seed": wrong}, r"the seed is a whole number from 0 on, not ")
            for wrong in (-1, 1.5, "x", True)
        ),
        *(
            ({"life": wrong}, r"life is True or False, not ")
            for wrong in ("no", "", None, 0, np.zeros(2))
        ),
        *(
            ({"rest": wrong}, r"no rest .*; the rests are: folded, hanging, ready")
            for wrong in ("asleep", "", None, 3, ["folded"])
        ),
        *(
            ({"utterance": wrong}, r"utterance is a whole number from 1 on, or None for all, not ")
            for wrong in ("1", 1.0, True, [1])
        ),
        ({"utterance": 1, "expression": ":bien"}, "does not go with expression"),
        *(({"expression": wrong}, "an expression is a str such as") for wrong in (3, b":bien")),
        ({"libraries": "rules"}, r"a list of folders, as in libraries=\['rules'\]"),
        ({"libraries": Path("rules")}, r"a list of folders, as in libraries=\['rules'\]"),
        *(
            ({"libraries": wrong}, "libraries are a list of folders, not ")
            for wrong in (None, 3, {"rules"}, {"rules": 1}, b"rules")
        ),
        ({"libraries": [3]}, "a folder of libraries is a str or a Path, not 3"),
        ({"libraries": ["nowhere"]}, "no folder `nowhere` to look for libraries in"),
        ({"libraries": [LONG]}, "no folder `xxx"),
        ({"libraries": [__file__]}, r"test_arguments.py` is a file"),
        *(
            ({"rig": wrong}, r"the name of one that ships \(.*signer.*\) or a folder")
            for wrong in (None, 3, ["signer"], b"signer")
        ),
        *(
            ({"rig": wrong}, r"no rig `.*`: neither one that ships \(.*signer.*\) nor a folder")
            for wrong in ("sginer", "", "a\0b", LONG, Path("nowhere"), __file__)
        ),
        *(
            ({"text_or_path": wrong}, "a text is a str, and a path a str or a Path, not ")
            for wrong in (3, b"key 1", [TEXT])
        ),
        ({"text_or_path": None}, r"nothing to compile: .* azee.compile\(expression=':arbre'\)"),
    ],
    ids=str,
)
def test_a_wrong_argument_is_answered_with_what_is_allowed(
    arguments: dict[str, Any], told: str
) -> None:
    with pytest.raises(ValueError, match=told) as caught:
        azee.compile(**{"text_or_path": TEXT} | arguments)
    assert len(str(caught.value)) < 500


@pytest.mark.parametrize("number", [0, -1, 5])
def test_an_utterance_that_is_not_there_is_an_error_of_the_text(number: int) -> None:
    with pytest.raises(azee.AZeeError, match=f"no-utterance: .* has no utterance {number}"):
        azee.compile(TEXT, utterance=number)


def test_arguments_are_checked_before_the_text() -> None:
    with pytest.raises(ValueError, match="no solver"):
        azee.compile("key 1 (look ^nowhere)\n", solver="ik")  # type: ignore[arg-type]
    with pytest.raises(RigError, match="no rig"):
        azee.compile("key 1 (look ^nowhere)\n", "sginer")


def test_perform_checks_its_options_too(signer: Rig) -> None:
    score = azee.compile(TEXT).score
    with pytest.raises(ValueError, match="the solvers are: grouped, two-level"):
        perform(score, signer, solver="ik")  # type: ignore[arg-type]


def test_an_expression_needs_no_text() -> None:
    alone = azee.compile(expression=":bien", life=False)
    assert alone.score == azee.compile(":bien", life=False).score
    with pytest.raises(azee.AZeeError, match="unknown-rule"):
        azee.compile(expression=":nobody")


def test_an_expression_sees_the_text_and_does_not_hide_what_is_wrong_with_it() -> None:
    text = "def nod\n    key .4 (rotate !head ^left 20)\n"
    assert azee.compile(text, expression=":nod", life=False).score.duration == Fraction(2, 5)
    for wrong in ("def nod\n    key 1 (look ^nowhere)\n", "key 1 (look ^nowhere)\n"):
        with pytest.raises(azee.AZeeError, match="unknown-name"):
            azee.compile(wrong, expression="key .2 (look ^fwd)")


def test_numbers_of_numpy_and_exact_rates_are_numbers() -> None:
    plain = azee.compile(TEXT, fps=30).clip.times
    for fps in (np.float32(30), np.float64(30), np.int64(30), Fraction(30)):
        np.testing.assert_array_equal(azee.compile(TEXT, fps=fps).clip.times, plain)  # type: ignore[arg-type]
    one = azee.compile(TEXT, seed=7).clip.coordinates
    np.testing.assert_array_equal(azee.compile(TEXT, seed=np.int64(7)).clip.coordinates, one)  # type: ignore[arg-type]


def test_a_body_that_was_loaded_is_a_body(signer: Rig) -> None:
    named = replace(signer, name="the same under another name")
    assert azee.compile(TEXT, named).report.rig == named.name


def test_libraries_are_folders(tmp_path: Path) -> None:
    (tmp_path / "mine.azee").write_text(
        "library 'mine\n\ndef nod\n    key .4 (look ^fwd)\n", "utf-8"
    )
    text = "use 'mine\n\n:nod\n"
    for libraries in ([str(tmp_path)], (tmp_path,)):
        assert azee.compile(text, libraries=libraries, life=False).score.duration == Fraction(2, 5)
