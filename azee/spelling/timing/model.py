"""The timing of a signer's spelling, fitted to timed words; JSON keeps it, two of them ship."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any, Literal, TypeAlias

from azee.spelling.timing.holds import HoldModel, HoldName, NaiveBayes, Ridge
from azee.spelling.timing.published import Style
from azee.spelling.timing.timed_word import TimedWord, TimesError
from azee.spelling.timing.transitions import Transitions

TransitionName: TypeAlias = Literal["with-doubles", "regression"]

FORMAT, VERSION = "azee-spelling-timing", 1
DRAWN = "drawn from published statistics (Wheatland 2016), not recorded"
"""Where the numbers of the models that ship come from: said wherever they appear."""


@dataclass(frozen=True, eq=False)
class TimingModel:
    """Hold times and transitions, and the words that they were fitted to.

    origin: where these words come from, in words. practice: exponent by which later spellings of
    a word in one text are faster, n ** -practice.
    """

    origin: str
    words: tuple[TimedWord, ...]
    holds: Mapping[HoldName, HoldModel]
    transitions: Mapping[TransitionName, Transitions]
    practice: float

    def recorded(self, word: str, spelling: int = 1) -> TimedWord | None:
        """Return a word as it was recorded or drawn, if it was."""
        found = [timed for timed in self.words if timed.word == word]
        exact = [timed for timed in found if timed.spelling == spelling]
        return next(iter(exact or found), None)

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON values; times in milliseconds, transitions in seconds."""
        return {
            "format": FORMAT,
            "version": VERSION,
            "origin": self.origin,
            "words": [
                {
                    "word": timed.word,
                    "spelling": timed.spelling,
                    "holds_ms": [round(1000 * t, 3) for t in timed.holds_s],
                    "transitions_ms": [round(1000 * t, 3) for t in timed.transitions_s],
                }
                for timed in self.words
            ],
            "holds": {name: model.to_json() for name, model in self.holds.items()},
            "transitions": {name: t.to_json() for name, t in self.transitions.items()},
            "practice": round(self.practice, 6),
        }

    @classmethod
    def from_json(cls, data: Any) -> TimingModel:
        """Read what `to_json` wrote. Raises: TimesError: it is something else."""
        if not isinstance(data, dict) or data.get("format") != FORMAT:
            raise TimesError("it is no timing model of azee")
        if data.get("version") != VERSION:
            raise TimesError(f"it is of version {data.get('version')}; this azee reads {VERSION}")
        try:
            holds: dict[HoldName, HoldModel] = {
                "ridge": Ridge.from_json(data["holds"]["ridge"]),
                "naive-bayes": NaiveBayes.from_json(data["holds"]["naive-bayes"]),
                "naive-bayes-mean": NaiveBayes.from_json(data["holds"]["naive-bayes-mean"]),
            }
            transitions: dict[TransitionName, Transitions] = {
                "with-doubles": Transitions.from_json(data["transitions"]["with-doubles"]),
                "regression": Transitions.from_json(data["transitions"]["regression"]),
            }
            words = tuple(
                TimedWord(
                    item["word"],
                    tuple(t / 1000 for t in item["holds_ms"]),
                    tuple(t / 1000 for t in item["transitions_ms"]),
                    item["spelling"],
                )
                for item in data["words"]
            )
            return cls(str(data["origin"]), words, holds, transitions, float(data["practice"]))
        except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
            raise TimesError(f"it is damaged: {error}") from error


def read_model(path: str | Path) -> TimingModel:
    """Read a model from a file. Raises: TimesError: it is none. OSError: it cannot be read."""
    try:
        return TimingModel.from_json(json.loads(Path(path).read_text(encoding="utf-8")))
    except ValueError as error:  # JSON, UTF-8 and `TimesError`
        reason = str(error) if isinstance(error, TimesError) else "it is no JSON"
        raise TimesError(f"`{path}` cannot be used: {reason}") from error


@cache
def shipped_model(style: Style = "normal") -> TimingModel:
    """Return a model that ships, fitted to what was drawn (`DRAWN`)."""
    text = files("azee.spelling.timing").joinpath(f"data/{style}.json").read_text("utf-8")
    return TimingModel.from_json(json.loads(text))


def model_text(model: TimingModel) -> str:
    """Return a model as the text of its file: one word or table a line."""
    lines: Sequence[str] = [
        f"  {json.dumps(key)}: {_value(value)}" for key, value in model.to_json().items()
    ]
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _value(value: Any) -> str:
    if isinstance(value, list):
        return "[\n" + ",\n".join(f"    {json.dumps(item)}" for item in value) + "\n  ]"
    if isinstance(value, dict):
        rows = (f"    {json.dumps(k)}: {json.dumps(v)}" for k, v in value.items())
        return "{\n" + ",\n".join(rows) + "\n  }"
    return json.dumps(value)
