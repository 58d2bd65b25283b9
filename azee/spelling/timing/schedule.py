"""When the letters of a word are held and passed: word to (letter, hold, transition).

The four timings are those that Wheatland (2016, section 4.3) compares.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, NamedTuple, TypeAlias, get_args

from azee.spelling.timing.holds import HoldName
from azee.spelling.timing.letter_poses import LetterPoses, asl_poses
from azee.spelling.timing.model import TimingModel, TransitionName, shipped_model
from azee.spelling.timing.published import (
    CONSTANT_HOLD_S,
    CONSTANT_LAST_S,
    CONSTANT_TRANSITION_S,
)
from azee.spelling.timing.syllables import starts
from azee.spelling.timing.timed_word import TimedWord

Timing: TypeAlias = Literal["variable", "motion", "normalised", "constant"]
TIMINGS: tuple[Timing, ...] = get_args(Timing)


class LetterTime(NamedTuple):
    """A letter, how long it is held, and how long the way to the next takes (0 after the last)."""

    letter: str
    hold_s: float
    transition_s: float


class NotRecordedError(ValueError):
    """The timing of a recording is asked for, and the word was not recorded."""


@dataclass(frozen=True, slots=True)
class Pace:
    """What a user may change of a timing.

    speed: 2 is twice as fast. transition_factor: 1.3 makes transitions 1.3 times as long; people
    prefer slower ones (Al-Khazraji 2021). syllable_factor: 1.3 makes those between syllables so
    much longer than others while the word keeps its length (asked for in Wheatland 2016, section
    5.5; 1 is off). spelling: 2 for a word that is spelled for the second time in its text.

    Raises: ValueError: a factor is not above 0, or the spelling is below 1.
    """

    speed: float = 1.0
    transition_factor: float = 1.0
    syllable_factor: float = 1.0
    spelling: int = 1

    def __post_init__(self) -> None:
        for name in ("speed", "transition_factor", "syllable_factor"):
            if not 0 < getattr(self, name) < float("inf"):
                raise ValueError(f"{name} is above 0, not {getattr(self, name)}")
        if self.spelling < 1:
            raise ValueError(f"spellings are counted from 1, not {self.spelling}")


def schedule(
    word: str,
    timing: Timing = "variable",
    pace: Pace | None = None,
    *,
    model: TimingModel | None = None,
    holds: HoldName = "ridge",
    transitions: TransitionName = "with-doubles",
    poses: LetterPoses | None = None,
) -> tuple[LetterTime, ...]:
    """Return when the letters of a word are held and passed.

    Args: word: letters, in any case; those that no model knows get times of the others.
        model: by default the one that ships, fitted to drawn data. holds, transitions: which of
        its parts; `naive-bayes` and `regression` are as published. poses: of the alphabet's
        letters, by default those of ASL.
    Raises: NotRecordedError: `motion` of a word that the model has no times of.
    """
    letters = word.upper()
    if not letters:
        return ()
    chosen, pace = model or shipped_model(), pace or Pace()
    hold_model, ways = chosen.holds[holds], chosen.transitions[transitions]
    known = poses or asl_poses()

    def variable() -> tuple[Sequence[float], Sequence[float]]:
        faster = pace.spelling**-chosen.practice
        held = [faster * hold_model.hold_s(letters, i) for i in range(len(letters))]
        return held, [faster * ways.way_s(a, b, known) for a, b in pairwise(letters)]

    def constant() -> tuple[Sequence[float], Sequence[float]]:
        held = [CONSTANT_HOLD_S] * (len(letters) - 1) + [CONSTANT_LAST_S]
        return held, [CONSTANT_TRANSITION_S] * (len(letters) - 1)

    match timing:
        case "variable":
            held, passed = variable()
        case "motion":
            recorded = _recorded(letters, chosen, pace.spelling)
            held, passed = recorded.holds_s, recorded.transitions_s
        case "constant":
            held, passed = constant()
        case "normalised":
            wanted = sum(map(sum, variable()))
            held, passed = constant()
            factor = wanted / (sum(held) + sum(passed))
            held, passed = [factor * t for t in held], [factor * t for t in passed]
    passed = _by_syllables(letters, passed, pace.syllable_factor)
    return tuple(
        LetterTime(letter, hold / pace.speed, pace.transition_factor * way / pace.speed)
        for letter, hold, way in zip(letters, held, [*passed, 0.0], strict=True)
    )


def duration_s(times: Sequence[LetterTime]) -> float:
    """Return the length of a word, from the start of its first hold to the end of its last."""
    return sum(t.hold_s + t.transition_s for t in times)


def _recorded(word: str, model: TimingModel, spelling: int) -> TimedWord:
    found = model.recorded(word, spelling)
    if found is None:
        raise NotRecordedError(f"`{word}` is not among the words of the timing model")
    return found


def _by_syllables(word: str, ways_s: Sequence[float], factor: float) -> Sequence[float]:
    """Make the ways between syllables longer and all others shorter; their sum stays."""
    bounds = {index - 1 for index in starts(word)}
    if factor == 1.0 or not bounds:
        return ways_s
    changed = [way * (factor if i in bounds else 1.0) for i, way in enumerate(ways_s)]
    return [way * sum(ways_s) / sum(changed) for way in changed]
