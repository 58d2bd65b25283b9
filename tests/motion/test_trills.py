"""Trills of the rules that ship are seen: most finger tips go to and fro by 30 mm or more."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from azee.animation import animate
from azee.lang.library import shipped_library
from azee.lang.program import evaluate_expression
from azee.lang.rule_example import example_of
from azee.motion.overlay.trill import FADE_S
from azee.score.score import Key, Score, leaves
from azee_grammar.library import shipped_names
from azee_rig.rig import Rig
from azee_solver.constraint import Trill
from azee_solver.geometry import Side

SEEN_M = 0.03
FPS = 120.0
TIPS = tuple(f"{digit}_TIP" for digit in "TIMRL")


def trills(score: Score) -> Iterator[tuple[Trill, float, float]]:
    """Yield each trill, with its start and its end in seconds."""
    for leaf in leaves(score):
        for constraint in leaf.score.constraints if isinstance(leaf.score, Key) else ():
            if isinstance(constraint, Trill):
                yield constraint, float(leaf.interval.start), float(leaf.interval.end)


def test_trills_of_rules_are_seen_at_the_finger_tips(signer: Rig) -> None:
    """The hand stays at its place meanwhile, so that all movement of the tips is the trill's."""
    found = {}
    for library in shipped_names():
        for rule in shipped_library(library).namespace.rules.values():
            score = evaluate_expression(example_of(rule)).score
            if any(trills(score)):
                found[rule.name] = score
    assert {"cinéma", "mignon"} <= found.keys()
    for name in ("cinéma", "mignon"):
        made = animate(found[name], signer, fps=FPS, life=False)
        for trill, start_s, end_s in trills(found[name]):
            assert trill.bone.side is Side.STRONG
            a, b = (
                np.searchsorted(made.clip.times, made.lead_s + t)
                for t in (start_s + FADE_S, end_s - FADE_S)
            )
            frames = signer.chain.frames(made.clip.coordinates[a:b])
            ways = []
            for tip in TIPS:
                at = signer.sites[f"{tip}_R"].point(frames)
                ways.append(np.linalg.norm(at[:, None] - at[None], axis=-1).max())
            assert np.median(ways) > SEEN_M, (name, ways)
