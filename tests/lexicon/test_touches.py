"""What a sign is notated to touch is touched, though the trunk is spared."""

from __future__ import annotations

import math

import numpy as np

import azee
from azee.compilation import Compilation
from azee_rig.rig import Rig
from azee_solver.outcome import Outcome

INDEX_AT_FOREHEAD = """
key .3
    cstr
        :#hamfinger2('yield = 20, 'thumb = .thumb-rests)
        :#hand-faces
            'fingers vsum(scale(out(s), -.414), ^up)
            'palm vsum(scale(out(s), -1), vec(0, -.414, .448))
        place @I_TIP(s) @FH(s) 'contact
"""


def largest_lean_deg(made: Compilation) -> float:
    """By how much the upper trunk is turned at most, in degrees."""
    node = made.rig.bones["back_2"].node
    turns = np.array(
        [np.trace(made.rig.chain.frames(q).rotations[node]) for q in made.clip.coordinates]
    )
    return math.degrees(math.acos(np.clip((turns.min() - 1) / 2, -1.0, 1.0)))


def test_what_touches_goes_on_touching_where_the_trunk_is_spared(signer: Rig) -> None:
    made = azee.compile(INDEX_AT_FOREHEAD, signer, life=False)
    (touch,) = (c for c in made.report.constraints if c.text.endswith("'contact"))
    assert touch.outcome is Outcome.MET
    assert largest_lean_deg(made) < 6
