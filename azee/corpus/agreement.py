"""How the times of a score agree with those of an annotated recording.

Annotations of two tiers are paired in order, equal texts with equal texts: as many as can be, and
of all ways the one whose starts are nearest (Needleman & Wunsch 1970). Pairs have offsets, second
minus first, and an overlap: their common time by the time of both together (Jaccard 1912).
"""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from azee.corpus.annotations import Annotation


@dataclass(frozen=True, slots=True)
class Pair:
    """Two annotations of one text, in two files."""

    first: Annotation
    second: Annotation

    @property
    def start_s(self) -> float:
        """How much later the second starts."""
        return self.second.start_s - self.first.start_s

    @property
    def end_s(self) -> float:
        """How much later the second ends."""
        return self.second.end_s - self.first.end_s

    @property
    def longer(self) -> float:
        """How many times as long the second is."""
        return (self.second.end_s - self.second.start_s) / (self.first.end_s - self.first.start_s)

    @property
    def overlap(self) -> float:
        """Their common time by the time of both together, 0 to 1."""
        common = min(self.first.end_s, self.second.end_s) - max(
            self.first.start_s, self.second.start_s
        )
        both = max(self.first.end_s, self.second.end_s) - min(
            self.first.start_s, self.second.start_s
        )
        return max(0.0, common) / both


@dataclass(frozen=True, slots=True)
class Spread:
    """Mean and standard deviation (of the sample; 0 for one value); none without values."""

    mean: float | None
    deviation: float | None

    @classmethod
    def of(cls, values: Sequence[float]) -> Spread:
        """Take both of some values."""
        if not values:
            return cls(None, None)
        mean = math.fsum(values) / len(values)
        square = math.fsum((value - mean) ** 2 for value in values)
        return cls(mean, math.sqrt(square / max(1, len(values) - 1)))


@dataclass(frozen=True)
class TierAgreement:
    """Two tiers compared: pairs in order, and what only one of them has."""

    first_tier: str
    second_tier: str
    pairs: Sequence[Pair]
    only_first: Sequence[Annotation]
    only_second: Sequence[Annotation]

    @cached_property
    def start_s(self) -> Spread:
        """How much later annotations start in the second file."""
        return Spread.of([pair.start_s for pair in self.pairs])

    @cached_property
    def end_s(self) -> Spread:
        """How much later annotations end in the second file."""
        return Spread.of([pair.end_s for pair in self.pairs])

    @cached_property
    def longer(self) -> Spread:
        """How many times as long annotations are in the second file."""
        return Spread.of([pair.longer for pair in self.pairs])

    @cached_property
    def overlap(self) -> Spread:
        """How much of the time of both is common."""
        return Spread.of([pair.overlap for pair in self.pairs])


def compared(
    first: Mapping[str, Sequence[Annotation]],
    second: Mapping[str, Sequence[Annotation]],
    tiers: Mapping[str, str] | None = None,
) -> list[TierAgreement]:
    """Compare tiers of two files.

    Args: tiers: names in the first file, each with that in the second; by default those that both
        files have.
    Raises: KeyError: a file has no such tier.
    """
    chosen = tiers or {name: name for name in first if name in second}
    return [TierAgreement(a, b, *_paired(first[a], second[b])) for a, b in chosen.items()]


def aligned(found: Sequence[TierAgreement]) -> tuple[list[TierAgreement], float]:
    """Move the second file so that starts agree on average, as a recording begins at any time.

    Returns: the comparison, and by how many seconds the second file was moved.
    """
    offset = Spread.of([pair.start_s for tier in found for pair in tier.pairs]).mean or 0.0
    return [_moved(tier, -offset) for tier in found], -offset


def _moved(tier: TierAgreement, by_s: float) -> TierAgreement:
    def later(a: Annotation) -> Annotation:
        return replace(a, start_s=a.start_s + by_s, end_s=a.end_s + by_s)

    return TierAgreement(
        tier.first_tier,
        tier.second_tier,
        [Pair(pair.first, later(pair.second)) for pair in tier.pairs],
        tier.only_first,
        [later(a) for a in tier.only_second],
    )


def _paired(
    first: Sequence[Annotation], second: Sequence[Annotation]
) -> tuple[list[Pair], list[Annotation], list[Annotation]]:
    """Return the pairs, and what is left in each."""
    worth = _worths(first, second)
    pairs: list[Pair] = []
    only: tuple[list[Annotation], list[Annotation]] = ([], [])
    i = j = 0
    while i < len(first) and j < len(second):
        a, b = first[i], second[j]
        if _plain(a.text) == _plain(b.text) and worth[i][j] == _added(worth[i + 1][j + 1], a, b):
            pairs.append(Pair(a, b))
            i, j = i + 1, j + 1
        elif worth[i][j] == worth[i + 1][j]:
            only[0].append(a)
            i += 1
        else:
            only[1].append(b)
            j += 1
    return pairs, [*only[0], *first[i:]], [*only[1], *second[j:]]


_Worth = tuple[int, float]
"""How many pairs, and minus how far their starts are apart in all, seconds: more is better."""


def _worths(first: Sequence[Annotation], second: Sequence[Annotation]) -> list[list[_Worth]]:
    """Return what is the best for the rest of both from each place in them."""
    names = [_plain(a.text) for a in first], [_plain(b.text) for b in second]
    worth = [[(0, 0.0)] * (len(second) + 1) for _ in range(len(first) + 1)]
    for i in reversed(range(len(first))):
        for j in reversed(range(len(second))):
            best = max(worth[i + 1][j], worth[i][j + 1])
            if names[0][i] == names[1][j]:
                best = max(best, _added(worth[i + 1][j + 1], first[i], second[j]))
            worth[i][j] = best
    return worth


def _added(worth: _Worth, a: Annotation, b: Annotation) -> _Worth:
    return worth[0] + 1, worth[1] - abs(a.start_s - b.start_s)


def _plain(text: str) -> str:
    """Without case, and with one blank between words, so that `ARBRE` pairs with `arbre`."""
    return " ".join(unicodedata.normalize("NFC", text).casefold().split())
