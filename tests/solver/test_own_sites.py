"""Sites that are ours: where they lie on every body, and hands that are placed there."""

from __future__ import annotations

import numpy as np
import pytest
from test_comfort import run
from tree_sign import S, W

from azee_rig.load import load_rig, shipped_rigs
from azee_rig.rig import Rig
from azee_solver.constraint import Place
from azee_solver.geometry import Site, SitePoint


@pytest.mark.parametrize("body", shipped_rigs())
def test_they_lie_where_their_names_say(body: str) -> None:
    rig = load_rig(body)
    frames = rig.chain.frames(rig.coordinates.idle)

    def at(name: str) -> np.ndarray:
        return rig.sites[name].point(frames)

    chin, under = at("CH"), at("CHu")
    assert abs(under[0]) < 0.004
    assert 0.0 < chin[1] - under[1] < 0.04
    assert at("NK")[2] < under[2] < chin[2]
    assert rig.sites["CHu"].outward(frames)[1] < -0.7
    for side, sign in (("L", 1.0), ("R", -1.0)):
        thigh = at(f"TH_{side}")
        assert sign * thigh[0] > 0.03
        assert thigh[1] < at(f"AB_{side}")[1] - 0.1
        assert rig.sites[f"TH_{side}"].outward(frames)[2] > 0.7
        ball, root = at(f"T_BALL_{side}"), at(f"WRt_{side}")
        assert np.linalg.norm(ball - root) < np.linalg.norm(at(f"T_TIP_{side}") - root)
        for finger in "MR":
            for k in (2, 3):
                thumbs, littles = at(f"{finger}_KNt_{side}_{k}"), at(f"{finger}_l_{side}_{k}")
                index = at(f"I_KN_{side}_{k}")
                assert np.linalg.norm(thumbs - index) < np.linalg.norm(littles - index)


def test_a_thigh_stands_still(signer: Rig) -> None:
    rig = signer
    drawn = np.random.default_rng(0).uniform(size=(8, len(rig.coordinates)))
    q = rig.coordinates.lower + drawn * (rig.coordinates.upper - rig.coordinates.lower)
    frames = rig.chain.frames(q)
    site = rig.sites["TH_L"]
    assert np.ptp(site.point(frames), axis=0).max() == 0.0
    assert site.outward(frames).shape == (8, 3)


@pytest.mark.parametrize("body", shipped_rigs())
@pytest.mark.parametrize(
    ("own", "target"),
    [
        (Site("PA", S), Site("TH", S)),
        (Site("I_TIP", S), Site("CHu")),
        (Site("I_TIP", S), Site("T_BALL", W)),
    ],
    ids=["thigh", "chin", "thumb"],
)
def test_a_hand_reaches_them(body: str, own: Site, target: Site) -> None:
    rig = load_rig(body)
    report = run(rig, Place(own, SitePoint(target), contact=True))
    (found,) = report.constraints
    assert not found.missed, found
