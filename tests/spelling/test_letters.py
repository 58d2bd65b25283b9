"""The letters as a body performs them: constraints met, fingers clear of fingers, paths drawn."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.compilation import Compilation, perform, score_of
from azee.lang.library import shipped_library
from azee.lang.program import load
from azee.score.score import Key, leaves
from azee.spelling.text import LANGUAGES
from azee_grammar.source import Source
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver.constraint import Place
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Side, SitePoint
from azee_solver.penetration import meant_contact, mesh_penetration
from benchmarks.letters_on_bodies import missed
from benchmarks.spelled_pairs import SEEN_M, measured

LETTERS = [
    (language, name)
    for language in LANGUAGES
    for name in shipped_library(language).namespace.rules
    if name.startswith("letter-")
]
OVERLAP_M = 0.003


def performed(language: str, letter: str, rig: Rig) -> Compilation:
    text = f"use '{language}\n:{letter} 'hold .4"
    return perform(score_of(load(Source(letter, text)), None, None), rig, life=False)


def posture(made: Compilation, share: float) -> NDArray[np.float64]:
    """The posture at a share of the score, (V,)."""
    instant = made.report.lead_s + share * float(made.score.duration)
    return np.asarray(made.clip.coordinates[int(np.abs(made.clip.times - instant).argmin())])


def site(made: Compilation, name: str, share: float) -> NDArray[np.float64]:
    """Where a site is at a share of the score, metres, (3,)."""
    frames = made.rig.chain.frames(posture(made, share))
    return np.asarray(made.rig.sites[name].point(frames))


def test_all_alphabets_are_whole() -> None:
    assert len(LETTERS) == 26 + 26 + 29


@pytest.mark.slow
@pytest.mark.parametrize(("language", "letter"), LETTERS)
def test_a_letter_misses_nothing_and_no_finger_passes_through_another(
    language: str, letter: str
) -> None:
    rig = load_rig()
    made = performed(language, letter, rig)
    assert [c.text for c in made.report.constraints if c.missed] == []
    evaluator, q = Evaluator(rig, Side.RIGHT), posture(made, 0.5)
    frames = rig.chain.frames(q)
    contacts = [
        meant_contact(evaluator, frames, constraint)
        for leaf in leaves(made.score)
        if isinstance(leaf.score, Key)
        for constraint in leaf.score.constraints
        if isinstance(constraint, Place) and isinstance(constraint.point, SitePoint)
    ]
    fingers = [
        p
        for p in mesh_penetration(rig, q, contacts)
        if p.depth_m > OVERLAP_M and not {p.limb[:3], p.body[:3]} & {"arm", "tru", "hea"}
    ]
    assert fingers == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("body", "language", "letters"),
    [("child", "tid", "J"), ("heavy", "asl", "J"), ("heavy", "tid", "BJT"), ("game", "asl", "J"),
     ("game", "tid", "AEJ")],
)  # fmt: skip
def test_letters_fit_hands_and_arms_of_other_sizes(body: str, language: str, letters: str) -> None:
    rig = load_rig(body)
    for letter in letters:
        assert missed(language, f"letter-{letter}", rig) == []


@pytest.mark.slow
def test_a_thumb_that_flies_past_a_finger_is_led_round_it() -> None:
    """From Q to U it would be inside the middle finger for one frame of 60 Hz."""
    assert measured("QU", 0.2, load_rig()).depth_mm < 1000.0 * SEEN_M


@pytest.mark.long
def test_j_is_drawn_down_and_inwards() -> None:
    made = performed("asl", "letter-J", load_rig())
    top, bottom, hook = (site(made, "L_TIP_R", share) for share in (0.1, 0.55, 0.95))
    assert bottom[1] < top[1] - 0.05
    assert hook[0] > top[0] + 0.04
    assert hook[1] > bottom[1]


def test_z_is_drawn_out_down_and_out() -> None:
    made = performed("asl", "letter-Z", load_rig())
    path = np.array([site(made, "I_TIP_R", share) for share in np.linspace(0.05, 0.98, 30)])
    assert np.ptp(path[:, 1]) > 0.07
    across = np.diff(path[:, 0])
    turns = np.flatnonzero(np.diff(np.sign(across[np.abs(across) > 1e-3])))
    assert len(turns) >= 2


@pytest.mark.parametrize(
    ("letter", "first", "second"),
    [
        ("A", "I_INT_R_2", "I_BACK_L_2"),
        ("D", "I_PAD_R", "I_PAD_L"),
        ("D", "T_PAD_R", "I_INT_L_1"),
        ("F", "I_INT_R_2", "I_BACK_L_2"),
        ("M", "I_TIP_R", "I_TIP_L"),
        ("N", "I_TIP_R", "I_TIP_L"),
        ("T", "I_INT_R_2", "I_TIP_L"),
    ],
)
def test_two_handed_letters_touch(letter: str, first: str, second: str) -> None:
    made = performed("tid", f"letter-{letter}", load_rig())
    apart = site(made, first, 0.5) - site(made, second, 0.5)
    assert float(np.linalg.norm(apart)) < 0.01
