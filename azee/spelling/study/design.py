"""What a study compares, and the pages of each participant that follow from it."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from itertools import combinations
from random import Random


class DesignError(ValueError):
    """Types or words make no study; the message says why."""


@dataclass(frozen=True, slots=True)
class Design:
    """What is compared.

    types: such as timings. words: an even number, so that each pair of types is shown in both
    orders equally often. seed: of the order of pages. no_difference: whether a third answer is
    offered, as a participant of the thesis asked for (section 5.5).

    Raises: DesignError: see the message.
    """

    types: tuple[str, ...]
    words: tuple[str, ...]
    seed: int = 1
    no_difference: bool = False

    def __post_init__(self) -> None:
        if len(set(self.types)) < 2 or len(set(self.types)) < len(self.types):
            raise DesignError("a study compares two types or more, each named once")
        if not self.words or len(self.words) % 2 or len(set(self.words)) < len(self.words):
            raise DesignError(
                f"a study needs an even number of words, each once; it has {len(self.words)}"
            )

    @property
    def page_count(self) -> int:
        """Number of pages of each participant."""
        return len(self.words) * len(self.types) * (len(self.types) - 1) // 2

    def to_text(self) -> str:
        """Return it as a line of JSON, the same for equal designs."""
        return json.dumps(asdict(self), sort_keys=True)

    @classmethod
    def from_text(cls, text: str) -> Design:
        """Read what `to_text` wrote. Raises: ValueError, KeyError, TypeError."""
        data = json.loads(text)
        return cls(tuple(data["types"]), tuple(data["words"]), data["seed"], data["no_difference"])


@dataclass(frozen=True, slots=True)
class Comparison:
    """A page: two clips of one word, of two types, in the order in which they are shown."""

    word: str
    first: str
    second: str


def comparisons(design: Design, participant: int) -> tuple[Comparison, ...]:
    """Return the pages of a participant, who is counted from 1; always the same ones.

    With four types and eight words these are the 48 pages of Wheatland (2016, table 5.1): each of
    the 12 ordered pairs on 4 pages. Each pair of types is shown once with each word; half of the
    words, drawn anew for each participant and pair, have it in one order, half in the other.
    """
    random = Random(f"{design.seed}/{participant}")
    pages = []
    for a, b in combinations(design.types, 2):
        words = random.sample(design.words, len(design.words))
        half = len(words) // 2
        pages += [Comparison(word, a, b) for word in words[:half]]
        pages += [Comparison(word, b, a) for word in words[half:]]
    random.shuffle(pages)
    return tuple(pages)
