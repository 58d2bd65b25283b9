"""From what is typed on the page to a movement: AZee, spelled letters, or signs of a database."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from azee.clip.clip import Clip
from azee.compilation import Compilation, perform, score_of
from azee.lang.program import load
from azee.player.naming import sign_labels
from azee.score.score import Score
from azee.spelling.text import LANGUAGES, Language, SpelledText, spelled
from azee.spelling.timing.schedule import schedule
from azee_grammar.diagnostic import AZeeError, Diagnostic, Severity
from azee_grammar.source import Source as Text
from azee_rig.rig import Rig

LONGEST_TEXT = 20_000
"""Characters that may be typed."""
LONGEST_S = 600.0
"""Seconds of a score that the page plays."""

Kind = Literal["azee", "letters", "words"]
Play = Callable[[str, Rig], "Performance"]

TITLES: Mapping[Language, str] = {
    "asl": "ASL, letters",
    "lsf": "LSF, letters",
    "tid": "TİD, letters",
}
LOCALES: Mapping[Language, str] = {"asl": "en", "lsf": "fr", "tid": "tr"}
"""Whose capitals the letters have: those of i are I, I and İ."""


@dataclass(frozen=True, eq=False)
class Performance:
    """A movement, and what is to be told of it."""

    clip: Clip
    told: Sequence[Diagnostic] = ()


@dataclass(frozen=True, eq=False)
class Source:
    """Something that turns text into movement.

    id: its name for programs. title: for people. play: raises AZeeError where the text is at fault.
    """

    id: str
    kind: Kind
    title: str
    play: Play


def sources(libraries: Sequence[Path] = ()) -> tuple[Source, ...]:
    """Return AZee and the alphabets. Args: libraries: folders in which `use` looks."""
    letters = [
        Source(language, "letters", TITLES[language], _speller(language)) for language in LANGUAGES
    ]
    return (*letters, Source("azee", "azee", "AZee", lambda text, rig: _azee(text, rig, libraries)))


def spelling(text: str, language: Language) -> tuple[str, SpelledText]:
    """Return the AZee expression that spells a text at the pace of the model that ships.

    Raises: AZeeError: unknown-character: the alphabet has nothing of the text.
    """
    read = spelled(text, language)
    if not read.words:
        message = f"the manual alphabet of {language.upper()} has nothing of this text"
        raise AZeeError(Diagnostic("unknown-character", message, None))
    times = [
        [(letter.hold_s, letter.transition_s) for letter in schedule("".join(word.letters))]
        for word in read.words
    ]
    return read.expression(times), read


def _speller(language: Language) -> Play:
    def play(text: str, rig: Rig) -> Performance:
        expression, read = spelling(text, language)
        told = [
            _warning(f"the manual alphabet of {language.upper()} has no `{c}`; it is left out")
            for c in read.unknown
        ]
        program = load(Text("<spelled>", ""))
        return _played(program.evaluate(expression).score, rig, told)

    return play


def _azee(text: str, rig: Rig, libraries: Sequence[Path]) -> Performance:
    program = load(Text("<typed>", text), libraries)
    warnings = [d for d in program.check() if d.severity is not Severity.ERROR]
    return _played(score_of(program, None, None), rig, warnings)


def _played(score: Score, rig: Rig, told: Sequence[Diagnostic]) -> Performance:
    if float(score.duration) > LONGEST_S:
        message = f"this would take {float(score.duration):g} s; the page plays {LONGEST_S:g} s"
        raise AZeeError(Diagnostic("clip-times", message, None))
    made: Compilation = perform(score, rig)
    labels = sign_labels(made.score, made.report.lead_s)
    return Performance(replace(made.clip, labels=labels), [*told, *made.left_out, *made.unshown])


def _warning(message: str) -> Diagnostic:
    return Diagnostic("unknown-character", message, None, severity=Severity.WARNING)
