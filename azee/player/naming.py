"""Which sign is shown when: the rules that a score comes from, without the blocks inside them."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from azee.clip.clip import Label
from azee.score.score import Group, Score, is_mouthing

LETTER = "letter-"
"""How the names of rules for letters begin."""


def sign_labels(score: Score, lead_s: float) -> tuple[Label, ...]:
    """Return a label for each application of a rule, in order of start; letters by themselves.

    Args: lead_s: when the score's time line starts in the clip.
    """
    found = _labels(score, Fraction(0), (), lead_s)
    return tuple(sorted(found, key=lambda label: (label.start_s, label.depth)))


def _labels(
    score: Score, start: Fraction, outer: tuple[str, ...], lead_s: float
) -> Iterator[Label]:
    if score.calls:
        outer = (*outer, score.calls[0].title.removeprefix(LETTER))
        yield Label(outer, float(start) + lead_s, float(start + score.duration) + lead_s)
    if isinstance(score, Group) and not is_mouthing(score):
        for block in score.blocks:
            inner = start + block.interval_in_parent.start
            yield from _labels(block.score, inner, outer, lead_s)
