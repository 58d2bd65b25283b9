"""Tiers of ELAN files by content: signs, parts of the signer, rules; read by pympi."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import pympi
import pytest
from any_scores import SCORES
from eaf_rules import check
from hypothesis import given

from azee.export.formats.eaf import write_eaf
from azee.export.formats.eaf_content import content_tiers
from azee.lang.program import load
from azee.lang.values import ConstraintsValue
from azee.score.articulators import ARTICULATORS, articulator_of
from azee.score.score import Score
from azee_grammar.source import Source

Annotations = Mapping[str, list[tuple[int, int, str]]]


def tiers_of(text: str, folder: Path) -> Annotations:
    """The tiers by content of the file of a text, as pympi reads them."""
    write_eaf(load(Source("text.azee", text)).score(), folder / "a.eaf")
    check(ElementTree.parse(folder / "a.eaf").getroot())
    file = pympi.Elan.Eaf(str(folder / "a.eaf"))
    return {
        name: sorted(file.get_annotation_data_for_tier(name))
        for name in file.get_tier_names()
        if not name.startswith(("score", "blocks"))
    }


def texts(found: Annotations, tier: str) -> list[str]:
    return [text for _, _, text in found[tier]]


SIGN = "def {}\n    key(.5, place(@I_TIP(s), @CH))\n\n"


def test_signs_rules_and_parts_of_the_signer_have_tiers_of_their_own(tmp_path: Path) -> None:
    text = (
        f"{SIGN.format('tea')}{SIGN.format('cup')}"
        "def over\n"
        "    azop\n"
        "        'sig\n"
        "        'nodefault\n"
        "        sync\n"
        "            'SIG ^sig\n"
        "            'NOD key(.1, rotate(!head, ^left, 5))\n"
        "            'start 'SIG:start\n"
        "            'FACE key(.2, cstr(morph('AU4, .5), morph('AU9, .2), look(^fwd)))\n"
        "            'start 'SIG:start:.1\n\n"
        "over(seq(list(:tea, :cup), 'gap = .5))\n"
    )
    assert tiers_of(text, tmp_path) == {
        "gloss": [(0, 500, "tea"), (1000, 1500, "cup")],
        "strong hand": [(0, 500, "tea"), (1000, 1500, "cup")],
        "head": [(0, 100, "rotate !head ^left 5")],
        "gaze": [(100, 300, "look ^fwd")],
        "face": [(100, 300, "morph 'AU4 0.5; morph 'AU9 0.2")],
        "rule over": [(0, 1500, "tea cup")],
    }


def test_numbers_that_are_handed_over_are_signs(tmp_path: Path) -> None:
    found = tiers_of("tens-units(.nb-5, .nb-2)\n", tmp_path)
    assert texts(found, "gloss") == ["nb-5", "nb-2"]
    assert texts(found, "rule tens-units") == ["nb-5 nb-2"]


def test_a_sign_whose_rule_applies_others_is_one_sign(tmp_path: Path) -> None:
    """In a library; a text's own rules are as good as its utterances."""
    (tmp_path / "drinks").mkdir()
    cup = SIGN.format("tea") + SIGN.format("cup") + "def teacup\n    seq(list(:tea, :cup))\n"
    (tmp_path / "drinks" / "all.azee").write_text(cup, encoding="utf-8")
    program = load(Source("text.azee", "use 'drinks\ninfo-about(:teacup, :tea)\n"), [tmp_path])
    gloss = content_tiers(program.score())[0]
    assert [note.text for note in gloss.notes] == ["teacup", "tea"]
    assert texts(tiers_of(f"{cup}\n:teacup\n", tmp_path), "gloss") == ["tea", "cup"]


def test_a_rule_without_hands_is_told_with_its_name(tmp_path: Path) -> None:
    found = tiers_of("def frown\n    key(.3, morph('AU4, .5))\n\n:frown\n", tmp_path)
    assert found == {
        "face": [(0, 300, "morph 'AU4 0.5")],
        "rule frown": [(0, 300, "frown")],
    }


def test_what_overlaps_is_on_two_tiers(tmp_path: Path) -> None:
    found = tiers_of("info-about(:bien, info-about(:chat, :pays))\n", tmp_path)
    assert [name for name in found if name.startswith("rule")] == [
        "rule info-about",
        "rule info-about 2",
    ]
    assert texts(found, "rule info-about 2") == ["chat pays"]


def test_a_hold_is_told_on_the_tiers_of_what_it_holds(tmp_path: Path) -> None:
    text = (
        f"{SIGN.format('tea')}"
        "sync\n"
        "    'A :tea\n"
        "    'H hold('A, .2)\n"
        "    'start 'A:end\n"
        "    'F key(.2, morph('AU4, 1))\n"
        "    'start 'A:start\n"
        "    'G hold('F, .2)\n"
        "    'start 'F:end\n"
    )
    found = tiers_of(text, tmp_path)
    assert found["strong hand"] == [(0, 500, "tea"), (500, 700, "hold tea")]
    assert texts(found, "face") == ["morph 'AU4 1"]  # a hold keeps hands, unless it says more


def test_a_hold_of_one_hand_is_told_on_its_tier_only(tmp_path: Path) -> None:
    both = "key(.5, cstr(place(@I_TIP(s), @CH), place(@PA(w), ^Mssp)))"
    text = f"sync\n    'A {both}\n    'H hold('A, .2, 'only = 'weak)\n    'start 'A:end\n"
    found = tiers_of(text, tmp_path)
    assert texts(found, "weak hand") == ["A", "hold A"]
    assert texts(found, "strong hand") == ["A"]


@pytest.mark.parametrize(
    ("constraint", "part"),
    [
        ("place(@I_TIP(s), @CH)", "strong hand"),
        ("place(@EL(w), @CH)", "weak hand"),
        ("place(@PA(L), @CH)", "left hand"),
        ("transpath(@I_TIP(R), straight)", "right hand"),
        ("place(@CH, @PA(s))", "head"),
        ("orient('dir, !index(w, 2), 'along, ^up)", "weak hand"),
        ("orient('dir, !back_2, 'along, ^up)", "trunk"),
        ("rotate(!neck, ^up, 10)", "head"),
        ("trill(!f_arm(s), ^up)", "strong hand"),
        ("look(^fwd)", "gaze"),
        ("lookat(^addressee)", "gaze"),
        ("morph('AU12, L, 1)", "face"),
        ("morph('smile, 1)", "face"),
        ("morph('index_bend, w, 1)", "weak hand"),
        ("morph('index_bend_L, 1)", "left hand"),
        ("morph('palm_l_closed, 1)", "left hand"),
        ("morph('spine_extended, 1)", "trunk"),
        ("morph('shoulder_shrug, s, 1)", "trunk"),
    ],
)
def test_a_constraint_moves_a_part_of_the_signer(constraint: str, part: str) -> None:
    found = load(Source("<none>", "")).value(f"cstr({constraint})")
    assert isinstance(found, ConstraintsValue)
    (only,) = found.content
    assert articulator_of(only) == part
    assert part in ARTICULATORS


@pytest.mark.long
@given(SCORES)
def test_annotations_of_a_tier_are_apart_and_inside_the_score(score: Score) -> None:
    end_ms = max(1, round(Fraction(score.duration) * 1000)) + 1
    for tier in content_tiers(score):
        notes = sorted(tier.notes, key=lambda note: note.start_ms)
        assert notes
        assert all(0 <= note.start_ms < note.end_ms <= end_ms for note in notes)
        assert all(a.end_ms <= b.start_ms for a, b in pairwise(notes))


def test_a_mouthing_has_its_text_and_its_sounds_and_no_part_of_the_face(tmp_path: Path) -> None:
    text = SIGN.format("tea") + 'with-mouth(:tea, mouthing("thé"))\n'
    found = tiers_of(text, tmp_path)
    assert found["mouthing"] == [(0, 500, "thé")]
    assert found["mouthing sounds"] == [(0, 200, "t"), (200, 500, "e")]
    assert texts(found, "gloss") == ["tea"]
    assert texts(found, "rule with-mouth") == ["tea"]
    assert "face" not in found
    assert not any("mouthing" in name for name in found if name.startswith("rule"))
