"""The seed of what is random in a performance, from what is performed."""

from __future__ import annotations

import hashlib

from azee.score.score import Hold, Key, Recorded, Score, leaves
from azee_solver.notation import constraint_text


def seed_of(score: Score) -> int:
    """Return a number of 64 bits, the same for equal scores on every machine and in every run.

    It counts what the score asks and when; file names and places in the text do not matter.
    """
    digest = hashlib.sha256(str(score.duration).encode())
    for leaf in leaves(score):
        lines = ["/".join(leaf.path), str(leaf.interval.start), str(leaf.interval.end)]
        if isinstance(leaf.score, Key):
            lines += map(constraint_text, leaf.score.constraints)
        elif isinstance(leaf.score, Hold):
            lines += (leaf.score.block, *leaf.score.channels)
        elif isinstance(leaf.score, Recorded):
            lines.append(leaf.score.motion.digest)
        digest.update("\n".join([*lines, ""]).encode())
    return int.from_bytes(digest.digest()[:8], "big")
