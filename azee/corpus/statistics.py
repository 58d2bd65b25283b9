"""Counts over a corpus: rules, what their arguments hold, how deep they nest, what goes together.

Only utterances count, as written: nothing is evaluated, and texts that apply unknown rules are as
good as others. A rule that only forwards to another counts as the other.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

from azee.lang.program import Program
from azee.lang.provenance import written
from azee.lang.rule import Rule
from azee.lang.written import Written

NO_RULE = "(no rule)"
"""What an argument holds that has no rule in it, such as a number or a point."""


@dataclass(frozen=True, slots=True)
class RuleCount:
    """How often a rule occurs, and where.

    rank: from 1, by occurrences, then by name. texts: how many texts it occurs in. share: of all
    applications, 0 to 1; covered: that of this rule and all before it. depth_mean: number of
    applications around it, on average.
    """

    rank: int
    rule: str
    library: str | None
    status: str | None
    known: bool
    occurrences: int
    texts: int
    share: float
    covered: float
    depth_least: int
    depth_mean: float
    depth_most: int


@dataclass(frozen=True, slots=True)
class ArgumentCount:
    """How often an argument of a rule holds another rule, or no rule at all."""

    rule: str
    argument: str
    holds: str
    occurrences: int


@dataclass(frozen=True, slots=True)
class PairCount:
    """In how many utterances two rules occur together; names in order of the alphabet."""

    first: str
    second: str
    utterances: int


@dataclass(frozen=True, slots=True)
class DepthCount:
    """How many applications have so many others around them."""

    depth: int
    applications: int


@dataclass(frozen=True)
class CorpusStatistics:
    """The counts of a corpus.

    texts: the applications of each utterance of each text.
    """

    texts: Sequence[Sequence[Sequence[Written]]]

    @classmethod
    def of(cls, programs: Iterable[Program]) -> CorpusStatistics:
        """Read the applications of every utterance of some texts."""
        return cls(
            [
                [written(p, utterance=i + 1) for i, _ in enumerate(p.utterance_items())]
                for p in programs
            ]
        )

    @cached_property
    def utterances(self) -> Sequence[Sequence[Written]]:
        """The applications of each utterance of the corpus."""
        return [utterance for text in self.texts for utterance in text]

    @cached_property
    def applications(self) -> Sequence[Written]:
        """All applications of the corpus."""
        return [found for utterance in self.utterances for found in utterance]

    @cached_property
    def rules(self) -> Sequence[RuleCount]:
        """A count for every rule, the most frequent first."""
        where: dict[str, list[Written]] = {}
        for found in self.applications:
            where.setdefault(found.name, []).append(found)
        inside = Counter(name for text in self.texts for name in _names(text))
        total, so_far = len(self.applications), 0
        counts: list[RuleCount] = []
        for name in sorted(where, key=lambda name: (-len(where[name]), name)):
            written_here = where[name]
            depths = [found.depth for found in written_here]
            so_far += len(written_here)
            rule = _rule(written_here)
            counts.append(
                RuleCount(
                    rank=len(counts) + 1,
                    rule=name,
                    library=rule.library if rule else None,
                    status=rule.status if rule else None,
                    known=rule is not None,
                    occurrences=len(written_here),
                    texts=inside[name],
                    share=len(written_here) / total,
                    covered=so_far / total,
                    depth_least=min(depths),
                    depth_mean=sum(depths) / len(depths),
                    depth_most=max(depths),
                )
            )
        return counts

    @cached_property
    def unknown(self) -> Sequence[RuleCount]:
        """The rules that no library has, the most frequent first."""
        return [count for count in self.rules if not count.known]

    @cached_property
    def arguments(self) -> Sequence[ArgumentCount]:
        """What every argument of every rule holds, the most frequent of each argument first."""
        counts: Counter[tuple[str, str, str]] = Counter()
        held = {(id(f.around), f.slot) for f in self.applications}
        for found in self.applications:
            if found.around is not None and found.slot is not None:
                counts[found.around.name, found.slot, found.name] += 1
            bare = [slot for slot in found.slots if (id(found), slot) not in held]
            counts.update((found.name, slot, NO_RULE) for slot in bare)
        keys = sorted(counts, key=lambda key: (key[0], key[1], -counts[key], key[2]))
        return [ArgumentCount(*key, counts[key]) for key in keys]

    @cached_property
    def pairs(self) -> Sequence[PairCount]:
        """Which rules occur in the same utterance, the most frequent pairs first."""
        counts: Counter[tuple[str, str]] = Counter()
        for utterance in self.utterances:
            counts.update(combinations(sorted({found.name for found in utterance}), 2))
        keys = sorted(counts, key=lambda key: (-counts[key], key))
        return [PairCount(*key, counts[key]) for key in keys]

    @cached_property
    def depths(self) -> Sequence[DepthCount]:
        """How many applications stand at each depth, from the outermost."""
        counts = Counter(found.depth for found in self.applications)
        return [DepthCount(depth, counts[depth]) for depth in sorted(counts)]

    @property
    def known(self) -> int:
        """How many applications are of rules that a library or the text itself has."""
        return sum(found.rule is not None for found in self.applications)

    @property
    def whole_texts(self) -> int:
        """How many texts with utterances apply known rules only."""
        spoken = [text for text in self.texts if text]
        return sum(all(f.rule is not None for u in text for f in u) for text in spoken)


def _names(text: Sequence[Sequence[Written]]) -> set[str]:
    return {found.name for utterance in text for found in utterance}


def _rule(found: Sequence[Written]) -> Rule | None:
    """Return the rule of a name; texts may use libraries in which it differs: the first counts."""
    return next((f.rule for f in found if f.rule is not None), None)
