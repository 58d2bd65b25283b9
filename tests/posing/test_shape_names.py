"""Which rules of a text name the shape that a hand has."""

from __future__ import annotations

import numpy as np

from azee.lang.program import load
from azee.lang.values import ConstraintsValue
from azee.posing.handshapes import shape_names
from azee_grammar.source import Source
from azee_rig.rig import Rig
from azee_solver.evaluate import evaluator
from azee_solver.geometry import Side

TEXT = """\
def plain-fist
    azop
        'side
        ^s
        :#fist('side = ^side)
def smiling-fist
    azop
        'side
        ^s
        cstr
            :#fist('side = ^side)
            morph 'AU12 .5
"""


def test_a_rule_that_also_moves_the_face_is_no_shape_of_a_hand(signer: Rig) -> None:
    program, body = load(Source("text.azee", TEXT)), evaluator(signer, Side.RIGHT)
    assert not program.check()
    limits = signer.coordinates
    q = np.array(limits.idle)
    value = program.value(":#plain-fist")
    assert isinstance(value, ConstraintsValue)
    fist = body.binding.presets(value.content)
    q[[*fist]] = [*fist.values()]
    q = np.clip(q, limits.lower, limits.upper)
    found = [shape.text for shape in shape_names(program, body, q, Side.STRONG)]
    assert {":#fist", ":#plain-fist"} <= {*found}
    assert ":#smiling-fist" not in found
