"""What tracks do that flattening does not, on the example that was made to show it."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from azee.animation import Animation, animate
from azee.lang.program import load
from azee.motion.tasks.key_selection import MODES, Mode
from azee.motion.tasks.limbs import Limbs
from azee.score.score import Group
from azee_grammar.files import read_source
from azee_rig.load import load_rig

NOT_BUT = Path(__file__).parents[2] / "examples" / "not-but" / "not-but.azee"


@cache
def score(shaking: bool) -> Group:
    whole = load(read_source(NOT_BUT)).score(None)
    assert isinstance(whole, Group)
    kept = tuple(b for b in whole.blocks if shaking or b.name != "HEADSHAKE")
    return replace(whole, blocks=kept)


@cache
def played(mode: Mode, *, shaking: bool = True) -> Animation:
    return animate(score(shaking), load_rig(), mode=mode, timing="exact", life=False, precise=True)


def moved_by_the_shake(mode: Mode) -> dict[str, float]:
    """By how much each limb differs with and without the head shake, degrees."""
    with_it, without = played(mode), played(mode, shaking=False)
    assert with_it.lead_s == without.lead_s
    far = np.abs(with_it.clip.coordinates - without.clip.coordinates).max(axis=0)
    limbs = Limbs.of(load_rig().coordinates)
    return {name: math.degrees(far[members].max()) for name, members in limbs.members.items()}


@pytest.mark.slow
def test_only_in_flat_a_head_shake_moves_what_it_does_not_need() -> None:
    tracks, flat = moved_by_the_shake("tracks"), moved_by_the_shake("flat")
    hands = [n for n in tracks if n[:-2] in ("thumb", "index", "middle", "ring", "little")]
    assert tracks["head"] > 10
    assert all(tracks[n] < 0.5 for n in ("trunk", *hands))
    assert flat["trunk"] > 9 * max(tracks["trunk"], 0.5)
    assert max(flat[n] for n in hands) > 5
    assert max(flat["arm_L"], flat["arm_R"]) > 2 * max(tracks["arm_L"], tracks["arm_R"])


@pytest.mark.slow
def test_tracks_are_smoother_than_flat_and_hold_what_it_misses() -> None:
    tracks, flat = (played(mode).report for mode in MODES)
    for of in ("speed", "acceleration", "jerk"):
        assert max(getattr(p, of) for p in tracks.peaks) < max(getattr(p, of) for p in flat.peaks)
    assert [c for c in tracks.constraints if not c.met] == []
    assert any(not c.met for c in flat.constraints)
    assert tracks.max_excess_rad == 0


@pytest.mark.slow
def test_the_trunk_is_the_track_of_whoever_had_it_first() -> None:
    owners: dict[float, set[tuple[str, ...]]] = {}
    for track in played("tracks").tracks:
        if any(c.startswith("back_") for c in track.coordinates):
            for key in track.keys_s:
                owners.setdefault(key, set()).add(track.path)
    assert ("NICHT",) in owners[0.0]
    shakes = [t for t in played("tracks").tracks if t.path[0] == "HEADSHAKE"]
    assert len(shakes) == 4
    heads: set[str] = {c.partition(".")[0] for t in shakes for c in t.coordinates}
    assert heads == {"head"}
