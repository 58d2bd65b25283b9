"""The published figures beside ours, one fact a row: reproduced, or corrected with a reason."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.stats import ttest_rel

from azee.spelling.timing import published as theirs
from azee.spelling.timing.features import has_double
from azee.spelling.timing.published import Style, length_class
from azee.spelling.timing.timed_word import TimedWord

Array = NDArray[np.float64]
SIGNIFICANT = 0.05


@dataclass(frozen=True, slots=True)
class Fact:
    """A published figure and ours.

    name: what is measured. theirs, ours: with units. agrees: within the tolerance of the fact.
    reason: why ours is another, or what was assumed. given: our words were drawn from it, so that
    it says nothing when it agrees.
    """

    name: str
    theirs: str
    ours: str
    agrees: bool
    reason: str = ""
    given: bool = False

    @property
    def verdict(self) -> str:
        """In a word or three."""
        if self.agrees:
            return "drawn from it" if self.given else "reproduced"
        return "corrected" if self.reason else "differs"


def close(
    name: str,
    published: float,
    ours: float,
    tolerance: float,
    unit: str,
    reason: str = "",
    *,
    given: bool = False,
) -> Fact:
    """Return a fact that is a number, with as many digits as are published."""
    digits = 2 if max(abs(published), abs(ours)) < 10 else 1
    agrees = abs(published - ours) <= tolerance
    return Fact(
        name, f"{published:.{digits}f}{unit}", f"{ours:.{digits}f}{unit}", agrees, reason, given
    )


def hold_facts(words: Sequence[TimedWord], style: Style) -> Iterator[Fact]:
    """Table 4.1 and section 4.1, of one style."""
    for size, (mean_s, deviation_s) in theirs.HOLD_S[style].items():
        means = np.array([np.mean(w.holds_s) for w in words if length_class(w.word) == size])
        if not means.size:
            continue
        of = f"{style} holds, {size}{'+' if size == 5 else ''} letters"
        yield close(f"{of}: mean", mean_s, float(means.mean()), 0.005, " s", given=True)
        yield close(f"{of}: σ", deviation_s, float(means.std()), 0.005, " s", given=True)
    faster = doubles_faster(words)
    if np.isnan(faster):
        return
    yield close(
        f"{style}: words with doubles are faster by",
        100 * theirs.DOUBLES_FASTER[style],
        100 * faster,
        5,
        " %",
        given=True,
    )


def place_facts(words: Sequence[TimedWord]) -> Iterator[Fact]:
    """Figure 4.3: what the places of letters make of their holds, tested a word at a time."""
    long = [word for word in words if len(word.word) > 2]
    if len(long) < 2:
        return
    first, middle, last = hold_by_place(long).T
    p = float(ttest_rel(first, middle).pvalue)
    yield Fact(
        "first and middle holds",
        "no significant difference",
        f"p = {p:.2f}",
        p >= SIGNIFICANT,
        given=True,
    )
    p = float(ttest_rel(last, (first + middle) / 2).pvalue)
    longer = last.mean() > (first + middle).mean() / 2
    yield Fact(
        "last holds are longer",
        "significantly",
        f"p = {p:.1g}",
        bool(p < SIGNIFICANT and longer),
        given=True,
    )


def hold_by_place(words: Sequence[TimedWord]) -> Array:
    """Return the mean first, middle and last hold of words of three letters and more, (N, 3)."""
    return np.array([(w.holds_s[0], np.mean(w.holds_s[1:-1]), w.holds_s[-1]) for w in words])


def doubles_faster(words: Sequence[TimedWord]) -> float:
    """Return by what share words with doubles are faster than others of as many letters."""
    shares = []
    for word in words:
        others = [
            other.duration_s
            for other in words
            if len(other.word) == len(word.word) and not has_double(other.word)
        ]
        if has_double(word.word) and others:
            shares.append(1 - word.duration_s / np.mean(others))
    return float(np.mean(shares)) if shares else float("nan")


def word_facts(
    words: Sequence[TimedWord], repeated: Sequence[TimedWord], practice: float
) -> Iterator[Fact]:
    """Section 4.1: single words."""
    by_name = {word.word: word for word in words}
    if {"ELEPHANT", "CRYPTOGRAPHY"} <= by_name.keys():
        middles = [np.mean(by_name[name].holds_s[1:-1]) for name in ("ELEPHANT", "CRYPTOGRAPHY")]
        faster = 100 * float(1 - middles[0] / middles[1])
        yield close(
            "middle letters of ELEPHANT are faster than CRYPTOGRAPHY's by",
            100 * theirs.ELEPHANT_FASTER, faster, 4, " %", given=True,
        )  # fmt: skip
    shares = []
    for name in dict.fromkeys(word.word for word in repeated):
        times = [word.duration_s for word in repeated if word.word == name]
        shares.append(1 - times[-1] / times[0])
    if shares:
        yield close(
            "the last spelling of a repeated word is faster by",
            100 * theirs.REPEATED_FASTER, 100 * float(np.mean(shares)), 3, " %",
            given=True,
        )  # fmt: skip
    first, last = theirs.MOBILE_S
    yield close(
        "MOBILE's 23rd spelling takes, of its first",
        100 * last / first,
        100 * float(23**-practice),
        5,
        " %",
        "another signer, in a conversation; the exponent of practice is of the 20 % above",
    )


def transition_facts(words: Sequence[TimedWord]) -> Iterator[Fact]:
    """Section 4.2.2: all transitions, and those between A and T."""
    pairs = [pair for word in words for pair in pairwise(word.word)]
    times = np.array([t for word in words for t in word.transitions_s])
    least, most = theirs.TRANSITION_RANGE_S
    for name, value, ours in (
        ("shortest transition", least, times.min()),
        ("longest transition", most, times.max()),
        ("mean transition", theirs.TRANSITION_MEAN_S, times.mean()),
    ):
        yield close(name, 1000 * value, 1000 * float(ours), 8.4, " ms", given=True)
    both = [t for pair, t in zip(pairs, times, strict=True) if set(pair) == {"A", "T"}]
    one = [t for pair, t in zip(pairs, times, strict=True) if pair == ("T", "A")]
    if both and one:
        yield close(
            "T to A", 1000 * theirs.T_TO_A_S, 1000 * float(np.mean(one)), 8.4, " ms", given=True
        )
        yield close(
            "A to T and back",
            1000 * theirs.A_AND_T_S,
            1000 * float(np.mean(both)),
            8.4,
            " ms",
            given=True,
        )
