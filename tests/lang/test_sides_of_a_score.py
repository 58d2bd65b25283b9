"""Other sides: the mirror image, and another dominant hand."""

from __future__ import annotations

import numpy as np
import pytest
from evaluations import constraints, content, group
from every_member import PATHS, POINTS, VECTORS, title
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from azee.lang.reflection import MIRROR, WithDominant
from azee.score.score import Group, Hold, Key, Score, leaves
from azee_rig.rig import Rig
from azee_solver.constraint import Constraint, Morph, Orient, Place, Rotate
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import (
    Bone,
    Cross,
    FreePoint,
    NamedPoint,
    Path,
    Point,
    Rotated,
    Side,
    SigningSpace,
    Site,
    Vec,
    Vector,
)

SIGNS = (
    *("arbre", "armoire", "bien", "personne", "âge", "pays", "Irak", "chat", "mignon"),
    *("bonjour", "mercredi", "cinéma", "nb-7"),
)


def _constraints(score: Score) -> list[Constraint]:
    return [
        c for leaf in leaves(score) if isinstance(leaf.score, Key) for c in leaf.score.constraints
    ]


def _score(expression: str) -> Score:
    found = content(expression)
    assert isinstance(found, Group | Key)
    return found


def test_a_mirror_image_swaps_sides_vectors_and_places() -> None:
    found = constraints(
        """mirror
    cstr
        place @I_TIP(s) ^Rssp
        place @I_TIP(L) (point .1 .2 .3)
        orient 'dir !palm(R) 'along (vec 1 2 3)
        orient 'nrm !palm(w) 'along rotated(^up, ^left, 90)
        orient 'dir !head 'along cross(^up, ^left)
        rotate !head ^up 90
        morph 'index_bend_L 1 'AU12 1 'AU1_R 1 'thumb_bend s 1
"""
    )
    assert found[0] == Place(Site("I_TIP", Side.WEAK), NamedPoint(SigningSpace.LSSP))
    assert found[1] == Place(Site("I_TIP", Side.RIGHT), FreePoint(-0.1, 0.2, 0.3))
    assert isinstance(found[2], Orient)
    assert (found[2].bone, found[2].vector) == (Bone("palm", Side.LEFT), Vec(-1, 2, 3))
    assert isinstance(found[3], Orient)
    assert isinstance(found[3].vector, Rotated)
    assert found[3].vector.axis == Vec(-1, 0, 0)
    assert found[3].vector.angle_rad == pytest.approx(-1.5707963)
    assert isinstance(found[4], Orient)
    assert found[4].vector == Cross(Vec(-1, 0, 0), Vec(0, 1, 0))
    assert isinstance(found[5], Rotate)
    assert found[5].angle_rad == pytest.approx(-1.5707963)
    assert found[6:] == (
        Morph("index_bend_R", None, 1.0),
        Morph("AU12", None, 1.0),
        Morph("AU1_L", None, 1.0),
        Morph("thumb_bend", Side.WEAK, 1.0),
    )


@pytest.mark.parametrize("part", [*VECTORS, *POINTS, *PATHS], ids=title)
def test_geometry_is_seen_in_a_mirror(part: Vector | Point | Path, signer: Rig) -> None:
    """On a body that is its own mirror image: what is mirrored lies where the mirror shows it."""
    measure, mirror = Evaluator(signer, Side.RIGHT), np.array([-1.0, 1.0, 1.0])
    frames = signer.chain.frames(np.zeros(len(signer.coordinates)))
    ends = np.array([[0.1, 1.2, 0.3], [-0.2, 1.3, 0.4]])

    def numbers(shown: Vector | Point | Path, ends: NDArray[np.float64]) -> NDArray[np.float64]:
        if isinstance(shown, Vector):
            return measure.vector(shown, frames)
        if isinstance(shown, Point):
            return measure.point(shown, frames, 0.3)
        return measure.path(shown, ends[0], ends[1], 0.3, frames)

    mirrored = numbers(MIRROR.node(part), ends * mirror)
    np.testing.assert_allclose(mirrored, numbers(part, ends) * mirror, atol=1e-12)


def test_times_and_calls_stay() -> None:
    mirrored, plain = group("mirror :armoire"), group(":armoire")
    assert mirrored.calls == plain.calls
    assert [b.interval_in_parent for b in mirrored.blocks] == [
        b.interval_in_parent for b in plain.blocks
    ]


@pytest.mark.parametrize("name", SIGNS)
def test_the_mirror_image_of_the_mirror_image_is_the_sign(name: str) -> None:
    assert _score(f"mirror (mirror :{name})") == _score(f":{name}")
    assert _score(f"mirror :{name}") != _score(f":{name}")


@pytest.mark.parametrize("name", SIGNS)
def test_a_left_handed_signer_s_mirror_image_is_a_right_handed_sign(name: str) -> None:
    """Mirroring after binding to a hand equals binding the mirror image to the other hand."""
    bound_then_mirrored = _score(f"mirror (with-dominant R :{name})")
    mirrored_then_bound = _score(f"with-dominant R (mirror :{name})")
    assert bound_then_mirrored == mirrored_then_bound


@pytest.mark.parametrize("name", SIGNS)
def test_with_a_dominant_hand_no_side_is_relative(name: str) -> None:
    text = repr(_constraints(_score(f"with-dominant L :{name}")))
    assert "STRONG" not in text
    assert "WEAK" not in text
    assert "SSSP: 'Sssp'" not in text


def test_weak_as_the_dominant_hand_swaps_the_hands_only() -> None:
    found = constraints("with-dominant w (cstr (place @I_TIP(s) ^Sssp) (look ^left))")
    assert found[0] == Place(Site("I_TIP", Side.WEAK), NamedPoint(SigningSpace.WSSP))
    assert found[1] == constraints("look ^left")[0]
    assert constraints("with-dominant L (place @I_TIP(w) ^Wssp)") == (
        Place(Site("I_TIP", Side.RIGHT), NamedPoint(SigningSpace.RSSP)),
    )


sides = st.sampled_from(Side)


@given(sides, sides)
def test_sides_change_as_groups_do(side: Side, strong: Side) -> None:
    assert MIRROR.side(MIRROR.side(side)) is side
    change = WithDominant(strong)
    if side in (Side.LEFT, Side.RIGHT):
        assert change.side(side) is side
    assert change.side(side.opposite) is change.side(side).opposite


@pytest.mark.parametrize(
    ("change", "channels"),
    [
        ("mirror", ("weak", "strong", "right", "hands")),
        ("with-dominant L", ("left", "right", "left", "hands")),
        ("with-dominant s", ("strong", "weak", "left", "hands")),
    ],
)
def test_a_hold_of_one_hand_changes_with_it(change: str, channels: tuple[str, ...]) -> None:
    held = "hold :bien .4 'only (list 'strong 'weak 'left 'hands)"
    hold = group(f"{change} ({held})").block("HOLD").score
    assert isinstance(hold, Hold)
    assert hold.channels == channels
