"""What a page may ask to be compiled, checked where it comes in."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Literal, cast, get_args

from azee.studio.folder import LARGEST_TEXT, RefusedError

Rest = Literal["folded", "hanging", "ready"]
Hand = Literal["right", "left"]
MOST_NUMBER = 2**53


@dataclass(frozen=True, slots=True)
class Job:
    """A text to be compiled.

    number: the page's own, given back with every answer. file: its name in the folder. expression:
    is compiled instead of the text's utterances. rig: the name of a body.

    Raises: ValueError: a value that no option has.
    """

    number: int
    file: str
    text: str
    expression: str | None = None
    rig: str = "signer"
    dominant: Hand = "right"
    rest: Rest = "hanging"
    tempo: float = 1.0
    fps: float = 30.0
    life: bool = True
    precise: bool = False

    def __post_init__(self) -> None:
        if self.dominant not in get_args(Hand) or self.rest not in get_args(Rest):
            raise ValueError("there is no such hand or rest")
        if not (0.1 <= self.tempo <= 10 and 5 <= self.fps <= 120):
            raise ValueError("tempo is from 0.1 to 10, frames per second from 5 to 120")
        if not 0 <= self.number <= MOST_NUMBER:
            raise ValueError("that is no number of a job")
        if len(self.text) > LARGEST_TEXT or len(self.expression or "") > LARGEST_TEXT:
            raise ValueError("the text is too large")

    def as_json(self) -> dict[str, Any]:
        """Return it as a message has it."""
        return asdict(self)


_TYPES: Mapping[str, type | tuple[type, ...]] = {
    "number": int,
    "file": str,
    "text": str,
    "expression": (str, type(None)),
    "rig": str,
    "dominant": str,
    "rest": str,
    "tempo": (int, float),
    "fps": (int, float),
    "life": bool,
    "precise": bool,
}


def read_job(message: Mapping[str, Any], known_rigs: tuple[str, ...]) -> Job:
    """Return the job of a message; fields that it does not know are left out.

    Raises: RefusedError: a field is missing, or has a wrong type or value.
    """
    given = {name: message[name] for name in _TYPES if name in message}
    for name, value in given.items():
        kinds = _TYPES[name]
        wrong = not isinstance(value, kinds) or (isinstance(value, bool) and kinds is not bool)
        if wrong or (isinstance(value, float) and not math.isfinite(value)):
            raise RefusedError(400, f"`{name}` has a wrong type")
    if missing := {"number", "file", "text"} - given.keys():
        raise RefusedError(400, f"`{min(missing)}` is missing")
    if given.get("rig", "signer") not in known_rigs:
        raise RefusedError(400, "there is no such body")
    try:
        return Job(**cast(Any, given))
    except ValueError as error:
        raise RefusedError(400, str(error)) from error
