"""The idle loop begins again without a jump."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from azee.clip.clip import Clip
from azee.player.idle import JOIN_S, LOOP_S, idle_loop
from azee.player.naming import sign_labels
from azee.score.interval import Interval
from azee.score.score import Block, Call, Group, Key
from azee_rig.rig import Rig

FPS = 30


@pytest.fixture(scope="module")
def loop(signer: Rig) -> Clip:
    return idle_loop(signer)


def test_the_loop_ends_where_it_begins_with_the_speed_that_it_begins_with(loop: Clip) -> None:
    q = loop.coordinates
    assert loop.duration_s == LOOP_S
    np.testing.assert_allclose(q[0], q[-1], atol=1e-9)
    np.testing.assert_allclose(loop.unit_weights[0], loop.unit_weights[-1], atol=1e-9)
    bends = np.abs(np.diff(np.vstack([q[:-1], q[:2]]), n=2, axis=0)).max(axis=1)
    joined = round(JOIN_S * FPS) + 2  # frames in which the end is blended, and the join itself
    assert bends[-joined:].max() <= 1.5 * bends[:-joined].max()


def test_the_signer_breathes_and_blinks_meanwhile(loop: Clip, signer: Rig) -> None:
    assert np.ptp(loop.coordinates, axis=0).max() > np.radians(0.5)
    lids = [u for u in loop.units if "closure" in u]
    assert max(loop.unit_weights[:, loop.units.index(u)].max() for u in lids) > 0.8
    assert np.all(loop.coordinates >= signer.coordinates.lower - 1e-9)
    assert np.all(loop.coordinates <= signer.coordinates.upper + 1e-9)


def test_names_are_those_of_rules_and_letters_stand_by_themselves() -> None:
    def key(rule: str | None) -> Key:
        return Key(Fraction(1), calls=(Call(rule),) if rule else ())

    blocks = tuple(
        Block(f"PART{n}", Interval(Fraction(n), Fraction(n + 1)), key(rule))
        for n, rule in enumerate(["letter-H", None, "tree"])
    )
    score = Group(Fraction(3), blocks=blocks, calls=(Call("fingerspelling"),))
    found = [(label.text, label.start_s, label.end_s) for label in sign_labels(score, 0.5)]
    assert found == [("fingerspelling", 0.5, 3.5), ("H", 0.5, 1.5), ("tree", 2.5, 3.5)]
