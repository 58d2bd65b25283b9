"""Labels of a clip: the blocks of its score, with the rules they come from."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from azee.clip.clip import Label
from azee.score.score import Blank, Group, Score, is_mouthing


def labels(score: Score, lead_s: float) -> tuple[Label, ...]:
    """Return all blocks, by rule where a rule made them, else by block name, in order of start.

    The sounds of a mouthing have no labels; its text is one.

    Args: lead_s: when the score's time line starts in the clip.
    """
    found = _labels(score, Fraction(0), None, (), lead_s)
    return tuple(sorted(found, key=lambda label: (label.start_s, label.depth)))


def _labels(
    score: Score, start: Fraction, name: str | None, outer: tuple[str, ...], lead_s: float
) -> Iterator[Label]:
    text = score.calls[0].title if score.calls else name
    if text is not None and not isinstance(score, Blank):
        outer = (*outer, text)
        yield Label(outer, float(start) + lead_s, float(start + score.duration) + lead_s)
    if isinstance(score, Group) and not is_mouthing(score):
        for block in score.blocks:
            inner = start + block.interval_in_parent.start
            yield from _labels(block.score, inner, block.name, outer, lead_s)
