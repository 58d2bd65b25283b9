"""A site that slides on the skin touches it all the way, and the movement meets its path."""

from __future__ import annotations

import numpy as np
import pytest

from azee.animation import animate
from azee.lang.program import evaluate_expression
from azee_rig.rig import Rig
from azee_solver.sliding import skin_of
from azee_solver.winding import distances

TEXT = """\
sync
    'A
    key .3
        cstr
            place @I_TIP(s) @{start} 'contact
            morph 'M_closed s 1 'R_closed s 1 'L_closed s 1 'index_bend s 0 'index_hook s 0
    'B
    key .7 (transpath @I_TIP(s) (slide !{bone} ({path})))
    'start 'A:end
    'C
    key .3 (place @I_TIP(s) @{end} 'contact)
    'start 'B:end
    'H
    key 1.3
        cstr
            place @WR(w) (point .05 -.3 .3) 'within .05
            orient 'nrm !palm(w) 'along ^down 'within 30
    'start 'A:start
"""


@pytest.mark.long
@pytest.mark.parametrize(
    ("bone", "key", "start", "end", "path"),
    [
        ("f_arm(w)", "f_arm_L", "F_ARM(w)", "F_ARM(w)", "circle ^up .02"),
        ("back_2", "back_2", "ST(w)", "ST(w)", "circle ^fwd .04"),
    ],
)
def test_a_fingertip_slides_on_the_skin(
    signer: Rig, bone: str, key: str, start: str, end: str, path: str
) -> None:
    text = TEXT.format(bone=bone, start=start, end=end, path=path)
    made = animate(evaluate_expression(text).score, signer, fps=60.0, life=False)
    (slid,) = [c for c in made.report.constraints if c.kind == "transpath"]
    assert slid.residual is not None
    assert slid.residual < 0.004, slid
    skin = skin_of(signer, signer.bones[key])
    first, last = made.lead_s + slid.start_s, made.lead_s + slid.end_s
    rows = np.flatnonzero((made.clip.times >= first) & (made.clip.times <= last))
    assert len(rows) > 30
    way = []
    for row in rows:
        frames = signer.chain.frames(made.clip.coordinates[row])
        tip = signer.sites["I_TIP_R"].point(frames)
        surface = frames.positions[skin.node] + skin.vertices @ frames.rotations[skin.node].T
        assert float(distances(tip[None], surface[skin.triangles])[0]) < 0.012
        way.append(tip)
    assert np.linalg.norm(np.diff(way, axis=0), axis=1).sum() > 0.08
