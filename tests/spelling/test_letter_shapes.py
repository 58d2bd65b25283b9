"""The letters of LSF and TID by what can be seen of them: fingers, touches, order, directions.

What each letter must show is read from descriptions, which the rules name, not from the rules.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.compilation import Compilation, perform, score_of
from azee.lang.library import shipped_library
from azee.lang.program import load
from azee_grammar.source import Source
from azee_rig.load import load_rig

Array = NDArray[np.float64]
FINGERS = ("index", "middle", "ring", "little")
INITIALS = {"index": "I", "middle": "M", "ring": "R", "little": "L"}
AXES = {"in": 0, "up": 1, "forward": 2}
TOUCHING_M, APART_M, BESIDE_M = 0.01, 0.035, 0.024
"""Sites that touch; tips of fingers that are spread; tips of fingers that lie side by side."""
TOWARDS = 0.55
"""Cosine of the angle within which something points somewhere."""
ELBOW_M = 0.05
"""How far elbows of arms that spell are below their shoulders at least. In 29 recorded Turkish
letters they are lower by a third of the width of the shoulders and more."""


@dataclass(frozen=True)
class Hand:
    """What one hand of a letter shows.

    fingers: index to little: s straight, b bent at the knuckle alone, r round, h hooked, c closed.
    palm, points: what the palm faces and where the hand points: up, down, forward, back, in or out,
    each as seen by the signer.
    """

    fingers: str
    palm: str = ""
    points: str = ""
    down: str = ""
    """Fingers that point down, by their initials."""


@dataclass(frozen=True)
class Shown:
    """What a letter shows.

    touches: sites that meet. free: sites that do not, and how far they are apart at least, metres.
    beside, spread: tips that are near each other and tips that are not. crossed: fingers that have
    changed places. before: sites of which the viewer sees the first before the second.
    """

    strong: Hand | None = None
    weak: Hand | None = None
    touches: tuple[tuple[str, str], ...] = ()
    free: Mapping[tuple[str, str], float] = field(default_factory=dict)
    beside: tuple[str, ...] = ()
    spread: tuple[str, ...] = ()
    crossed: str = ""
    before: tuple[tuple[str, str], ...] = ()


def up(fingers: str, palm: str = "forward") -> Hand:
    return Hand(fingers, palm, "up")


LSF: Mapping[str, Shown] = {
    "A": Shown(up("cccc"), free={("T_TIP_R", "I_t_R_2"): 0.03, ("T_TIP_R", "M_KN_R_3"): 0.03}),
    "B": Shown(up("ssss"), touches=(("T_TIP_R", "M_KNi_R_1"),), beside=("IM", "MR")),
    "C": Shown(up("rrrr", "in"), free={("T_TIP_R", "I_TIP_R"): 0.03}, beside=("IM", "MR")),
    "D": Shown(up("srrr"), touches=(("T_PAD_R", "M_PAD_R"),)),
    "E": Shown(up("hhhh"), free={("T_TIP_R", f"{f}_TIP_R"): 0.006 for f in "IMRL"}),
    "F": Shown(up("rsss"), touches=(("T_PAD_R", "I_t_R_2"),), spread=("MR", "RL")),
    "G": Shown(up("sccc"), free={("T_TIP_R", "M_KN_R_3"): 0.03}),
    "H": Shown(up("sccs"), before=(("T_TIP_R", "M_KN_R_2"),)),
    "I": Shown(up("cccs"), before=(("T_TIP_R", "M_KN_R_2"),)),
    "J": Shown(Hand("cccs"), free={("T_TIP_R", "I_t_R_2"): 0.05}),
    "K": Shown(up("sbcc"), touches=(("T_PAD_R", "M_INT_R_1"),)),
    "L": Shown(up("sccc"), free={("T_TIP_R", "I_KNt_R_1"): 0.06}),
    "M": Shown(Hand("sssc", "back", "in"), beside=("IM", "MR")),
    "N": Shown(Hand("sscc", "back", "in"), beside=("IM",)),
    "O": Shown(up("rrrr", "in"), touches=(("T_PAD_R", "M_PAD_R"),)),
    "P": Shown(Hand("sbcc", "down"), touches=(("T_PAD_R", "M_INT_R_1"),)),
    "Q": Shown(Hand("bccc", "down"), free={("T_TIP_R", "I_TIP_R"): 0.015}),
    "R": Shown(up("sscc"), crossed="IM"),
    "S": Shown(up("cccc"), touches=(("T_TIP_R", "M_KN_R_3"),), before=(("T_TIP_R", "M_KN_R_2"),)),
    "T": Shown(up("rsss"), touches=(("T_NA_R", "I_INT_R_2"),)),
    "U": Shown(up("sscc"), beside=("IM",)),
    "V": Shown(up("sscc"), spread=("IM",)),
    "W": Shown(up("sssc"), touches=(("T_PAD_R", "L_NA_R"),), spread=("IM", "MR")),
    "X": Shown(up("hhcc"), free={("I_TIP_R", "M_TIP_R"): 0.02}),
    "Y": Shown(up("cccs"), free={("T_TIP_R", "I_t_R_2"): 0.05}),
    "Z": Shown(Hand("sccc")),
}
CROSS = (("I_INT_R_2", "I_BACK_L_2"),)
OVER = (("I_INT_R_2", "I_INT_L_2"),)
ON_C = Shown(weak=Hand("rccc", "in", "up"), free={("T_TIP_L", "I_TIP_L"): 0.025})
TID: Mapping[str, Shown] = {
    "A": Shown(Hand("sccc", "back", "in"), Hand("bbcc", "back", "in", "IM"), CROSS, spread=("IM",),
               before=OVER),
    "B": Shown(Hand("rccc"), Hand("rccc"), (("T_PAD_R", "I_PAD_R"), ("T_PAD_L", "I_PAD_L"),
               ("I_KN_R_3", "I_KN_L_3"))),
    "C": ON_C,
    "Ç": ON_C,
    "D": Shown(Hand("rccc", "in", "up"), Hand("sccc", "in", "up"),
               (("I_PAD_R", "I_PAD_L"), ("T_PAD_R", "I_INT_L_1"))),
    "E": Shown(Hand("sssc", "back", "in"), Hand("sccc", "in", "up"), (("M_TIP_R", "I_INT_L_2"),)),
    "F": Shown(Hand("sccc", "back", "in"), Hand("bccc", "back", "in", "I"), CROSS,
               {("T_TIP_L", "I_KNt_L_1"): 0.06}, before=OVER),
    "G": Shown(Hand("cccc", "back", "in"), Hand("cccc", "back", "in"), (("L_l_R_2", "I_t_L_2"),)),
    "Ğ": Shown(Hand("cccc", "back", "in"), Hand("cccc", "back", "in"), (("L_l_R_2", "I_t_L_2"),)),
    "H": Shown(Hand("sccc", "back", "in"), Hand("bccb", "back", "in", "IL"), CROSS, before=OVER),
    "I": Shown(weak=Hand("sccc", "back", "up")),
    "İ": Shown(weak=Hand("sccc", "back", "up")),
    "J": Shown(Hand("sccc"), Hand("sccc", "back", "up")),
    "K": Shown(Hand("sscc", "back", "in"), Hand("bbcc", "back", "in", "IM"),
               (("I_PAD_R", "I_BACK_L_2"),), before=(("I_PAD_R", "I_INT_L_2"),)),
    "L": Shown(weak=Hand("sccc", "forward", "up"), free={("T_TIP_L", "I_KNt_L_1"): 0.06}),
    "M": Shown(Hand("sscc", "back", "down", "IM"), Hand("sscc", "back", "down", "IM"),
               (("I_TIP_R", "I_TIP_L"),), {("M_TIP_R", "M_TIP_L"): 0.04}),
    "N": Shown(Hand("sccc", "back", "down", "I"), Hand("sscc", "back", "down", "IM"),
               (("I_TIP_R", "I_TIP_L"),)),
    "O": Shown(weak=Hand("rsss", "in", "up"), touches=(("T_PAD_L", "I_PAD_L"),)),
    "Ö": Shown(weak=Hand("rsss", "in", "up"), touches=(("T_PAD_L", "I_PAD_L"),)),
    "P": Shown(weak=Hand("rbcc", "down", "in", "M"), touches=(("T_PAD_L", "I_PAD_L"),)),
    "R": Shown(Hand("sccc", "back", "in"), Hand("rbcc", "down", "in", "M"),
               (("T_PAD_L", "I_PAD_L"), ("I_TIP_R", "I_KN_L_2"))),
    "S": Shown(Hand("rccc", "in", "up"), Hand("rccc", "in", "up"), (("T_TIP_R", "I_PAD_L"),),
               {("I_TIP_R", "I_TIP_L"): 0.03}),
    "Ş": Shown(Hand("rccc", "in", "up"), Hand("rccc", "in", "up"), (("T_TIP_R", "I_PAD_L"),),
               {("I_TIP_R", "I_TIP_L"): 0.03}),
    "T": Shown(Hand("sccc", "down", "in"), Hand("sccc", "in", "up"), (("I_INT_R_2", "I_TIP_L"),)),
    "U": Shown(weak=Hand("rccc", "up", "forward"), free={("T_TIP_L", "I_TIP_L"): 0.025}),
    "Ü": Shown(weak=Hand("rccc", "up", "forward"), free={("T_TIP_L", "I_TIP_L"): 0.025}),
    "V": Shown(weak=Hand("sscc", "back", "up"), spread=("IM",)),
    "Y": Shown(Hand("sccc"), Hand("sscc", "back", "up"), spread=("IM",)),
    "Z": Shown(Hand("sscc", "back", "in"), Hand("sccc", "back", "in"), (("M_TIP_R", "I_TIP_L"),)),
}  # fmt: skip
MEANT = [("lsf", letter, shown) for letter, shown in LSF.items()]
MEANT += [("tid", letter, shown) for letter, shown in TID.items()]


class Seen:
    """One posture of a letter."""

    def __init__(self, made: Compilation, share: float = 0.5) -> None:
        instant = made.report.lead_s + share * float(made.score.duration)
        self.rig = made.rig
        self.q = made.clip.coordinates[int(np.abs(made.clip.times - instant).argmin())]
        self.frames = made.rig.chain.frames(self.q)

    def site(self, name: str) -> Array:
        """Where a site is, metres, (3,)."""
        return np.asarray(self.rig.sites[name].point(self.frames))

    def apart(self, first: str, second: str) -> float:
        """How far two sites are apart, metres."""
        return float(np.linalg.norm(self.site(first) - self.site(second)))

    def finger(self, finger: str, side: str) -> str:
        """How a finger is held, as `Hand.fingers` has it."""
        knuckle, middle, end = (
            float(np.degrees(self.q[self.rig.coordinates.index[f"{finger}_{side}_{n}.flexion"]]))
            for n in (1, 2, 3)
        )
        bend = middle + end
        if knuckle + bend < 45:
            return "s"
        if bend < 30:
            return "b"
        if bend < 90:
            return "r"
        return "h" if knuckle < 45 else "c"

    def lowered(self, finger: str, side: str) -> float:
        """Cosine of the angle between a finger, an initial, and what is below the signer."""
        way = self.site(f"{finger}_TIP_{side}") - self.site(f"{finger}_KN_{side}_1")
        return float(-way[1] / np.linalg.norm(way))

    def elbow_below_m(self, side: str) -> float:
        """How far an elbow is below its shoulder, metres."""
        shoulder, elbow = (
            self.frames.positions[self.rig.bones[f"{bone}_{side}"].node]
            for bone in ("arm", "f_arm")
        )
        return float(shoulder[1] - elbow[1])

    def turned(self, side: str, column: int, towards: str) -> float:
        """Cosine of the angle between an axis of a palm, and a direction of its signer."""
        axis = self.frames.rotations[self.rig.bones[f"palm_{side}"].node][:, column].copy()
        axis[0] *= 1.0 if side == "R" else -1.0
        names = {"down": "up", "back": "forward", "out": "in"}
        sign = -1.0 if towards in names else 1.0
        return float(sign * axis[AXES[names.get(towards, towards)]])


@cache
def performed(language: str, letter: str) -> Compilation:
    text = f"use '{language}\n:letter-{letter} 'hold .4"
    return perform(score_of(load(Source(letter, text)), None, None), load_rig(), life=False)


def faults(seen: Seen, shown: Shown) -> list[str]:
    """What a posture does not show."""
    out = []
    for side, hand in (("R", shown.strong), ("L", shown.weak)):
        if hand is None:
            continue
        fingers = "".join(seen.finger(finger, side) for finger in FINGERS)
        if fingers != hand.fingers:
            out.append(f"fingers {side}: {fingers}")
        for name, column, towards in (("points", 1, hand.points), ("palm", 2, hand.palm)):
            if towards and seen.turned(side, column, towards) < TOWARDS:
                out.append(f"{name} {side}: {seen.turned(side, column, towards):.2f} {towards}")
        for finger in hand.down:
            if seen.lowered(finger, side) < TOWARDS:
                out.append(f"{finger} {side}: {seen.lowered(finger, side):.2f} down")
        if seen.elbow_below_m(side) < ELBOW_M:
            out.append(f"elbow {side}: {seen.elbow_below_m(side):.3f}")
    side = "R" if shown.weak is None else "L"
    tips = [(pair, *(f"{f}_TIP_{side}" for f in pair)) for pair in (*shown.beside, *shown.spread)]
    out += [f"{a} {b}: {seen.apart(a, b):.3f}" for a, b in shown.touches
            if seen.apart(a, b) > TOUCHING_M]  # fmt: skip
    out += [f"{a} {b}: {seen.apart(a, b):.3f}" for (a, b), least in shown.free.items()
            if seen.apart(a, b) < least]  # fmt: skip
    for pair, a, b in tips:
        near = seen.apart(a, b)
        if near > BESIDE_M if pair in shown.beside else near < APART_M:
            out.append(f"tips {pair}: {near:.3f}")
    if shown.crossed:
        one, other = shown.crossed[0], shown.crossed[1]
        tip, knuckle = (seen.site(f"{one}_{site}")[0] - seen.site(f"{other}_{site}")[0]
                        for site in ("TIP_R", "KN_R_1"))  # fmt: skip
        if np.sign(tip) == np.sign(knuckle):
            out.append(f"{shown.crossed} not crossed")
    return out + [
        f"{a} is behind {b}" for a, b in shown.before if seen.site(a)[2] <= seen.site(b)[2]
    ]


@pytest.mark.slow
@pytest.mark.parametrize(("language", "letter", "shown"), MEANT)
def test_a_letter_shows_what_it_is_described_by(language: str, letter: str, shown: Shown) -> None:
    assert faults(Seen(performed(language, letter)), shown) == []


def test_every_letter_is_described() -> None:
    for language, table in (("lsf", LSF), ("tid", TID)):
        names = shipped_library(language).namespace.rules
        assert {n.removeprefix("letter-") for n in names if n.startswith("letter-")} == {*table}


def test_letters_are_told_from_those_that_are_like_them() -> None:
    """Descriptions that would fit other letters would prove nothing."""
    for one, other in (("U", "V"), ("U", "R"), ("S", "A"), ("N", "M"), ("V", "K")):
        assert faults(Seen(performed("lsf", one)), LSF[one]) == []
        assert faults(Seen(performed("lsf", one)), LSF[other])


@pytest.mark.slow
def test_letters_that_move_go_where_their_descriptions_say() -> None:
    def way(language: str, letter: str, site: str) -> Array:
        made = performed(language, letter)
        return np.array([Seen(made, share).site(site) for share in (0.1, 0.5, 0.95)])

    nod = way("lsf", "P", "M_TIP_R")
    assert nod[2, 1] < nod[0, 1] - 0.03
    hook = way("lsf", "J", "L_TIP_R")
    assert hook[1, 1] < hook[0, 1] - 0.05
    assert hook[2, 0] > hook[0, 0] + 0.04
    leg = way("tid", "Y", "I_TIP_R")
    assert leg[2, 1] < leg[0, 1] - 0.03
    traced = way("tid", "J", "I_TIP_R")
    assert traced[1, 1] < traced[0, 1] - 0.03
    for letter, base in (("Ö", "M_TIP_L"), ("İ", "I_TIP_L"), ("Ü", "I_TIP_L")):
        seen = Seen(performed("tid", letter))
        assert seen.site("I_KN_R_2")[1] > seen.site(base)[1]
    seen = Seen(performed("tid", "Ç"))
    assert seen.site("I_KN_R_2")[1] < seen.site("I_TIP_L")[1]
