"""What is printed about AZee, in its original shape, evaluates."""

from __future__ import annotations

import pytest
from evaluations import found, group, program, times, value

from azee.lang.values import ConstraintsValue, ScoreValue
from azee.score.score import Key
from azee_solver.constraint import Morph, Orient, Place, Transpath, Trill
from azee_solver.geometry import Dir, Nrm, Opp, Side

NO_WORRIES = """def no-worries-again
    azop
        'sig
        'nodefault
        sync
            'SIG
            ^sig
            'MOUTH
            key
                1
                cstr
                    morph
                        'smile
                        -.4
                        'lipBrollout
                        .5
                        'jawdrop
                        .1
                        'mouthstretch
                        .2
                        'mouthdown
                        .3
            'start/end
            'SIG:start:-.25
            'SIG:end:0
"""

SCORES = {
    "nested rules, one token a line": """:about-point
    'pt
    ^Rssp
    'locsig
    :category
        'cat
        :pays
        'elt
        :Irak
""",
    "nicht-sondern": ":nicht-sondern\n    'nicht\n    :arbre\n    'sondern\n    :armoire\n",
    "inline": "not-but(tree(), wardrobe())\n",
    "info-about": ":info-about\n    'topic\n    :chat\n    'info\n    :mignon\n",
    "numbers": """:info-about
    'topic
    :âge
    'info
    :tens-units
        'tens
        .nb-5
        'units
        .nb-2
""",
    "a sync of one block": (
        "sync\n    'PALM-L-HALF-CLOSED\n    key\n        1\n        cstr\n            morph\n"
        "                'palm_l_closed\n                0.5\n"
    ),
    "a name of two words": (":info-about\n    'topic\n    :mois sgn1\n    'info\n    :décembre\n"),
    "a posture rule in a key": "key\n    1\n    :#all5_curled_morph_l\n",
    "a person": ":une personne\n",
    "nicht and sondern in a row": ":nicht-sondern 'nicht :arbre 'sondern :armoire\n",
    "commas without spaces": ":info-about(:âge,:mignon)\n",
}

POSTURES = {
    "L_closed": (
        "def L_closed\n    azop\n        'param$0\n        'nodefault\n        orient\n"
        "            'dir\n            !little\n                ^param$0\n                2\n"
        "            'along\n            oppvect\n                dir\n                    !palm\n"
        "                        ^param$0\n"
    ),
    "its morph": (
        "def L_closed\n    azop\n        'param$0\n        'nodefault\n        morph\n"
        "            'little_closed\n            ^param$0\n            1.0\n"
    ),
}


@pytest.mark.parametrize("name", SCORES)
def test_a_published_expression_evaluates(name: str) -> None:
    assert found(SCORES[name]) == []


def test_no_worries_in_its_original_shape_is_the_rule_that_ships() -> None:
    mine = group("no-worries-again(blank(1))", NO_WORRIES)
    assert times(mine) == times(group("no-worries(blank(1))"))
    ours = group("no-worries(blank(1))").block("MOUTH").score
    printed = mine.block("MOUTH").score
    assert isinstance(ours, Key)
    assert isinstance(printed, Key)
    assert printed.constraints == ours.constraints


def test_anonymous_parameters_and_operands_on_the_line_of_a_bone() -> None:
    little = value("L_closed(s)", POSTURES["L_closed"])
    assert isinstance(little, ConstraintsValue)
    (orient,) = little.content
    assert isinstance(orient, Orient)
    assert (orient.bone.name, orient.bone.side, orient.bone.phalanx) == ("little", Side.STRONG, 2)
    assert isinstance(orient.vector, Opp)
    assert isinstance(orient.vector.vector, Dir)
    morph = value("L_closed(L)", POSTURES["its morph"])
    assert morph.content == (Morph("little_closed", Side.LEFT, 1.0),)
    assert value("orient 'dir !index(L, 2) 'along oppvect(dir(!palm(L)))").kind is morph.kind


def test_a_posture_rule_may_stand_where_constraints_do() -> None:
    text = "def all5_curled_morph_l\n    morph 'fist_close L 1\nkey 1 :#all5_curled_morph_l\n"
    (utterance,) = program(text).utterances
    assert isinstance(utterance.score, Key)
    assert utterance.score.constraints == (Morph("fist_close", Side.LEFT, 1.0),)


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("place(@I_TIP(w), vtranslate(@FH, vec(0, 0, .1)))", Place),
        ("orient 'nrm !palm(w) 'along ^up", Orient),
        ("transpath @I_TIP(s) arc-vect(vec(0, .1, 0))", Transpath),
        ("trill !palm(s) nrm(!palm(s)) s", Trill),
    ],
)
def test_published_operators_keep_their_orders(text: str, kind: type) -> None:
    found = value(text)
    assert isinstance(found, ConstraintsValue)
    assert isinstance(found.content[0], kind)


def test_the_operands_of_an_orientation_stay_symbolic() -> None:
    found = value("orient 'nrm !palm(s) 'along nrm(!palm(w))")
    assert isinstance(found, ConstraintsValue)
    (orient,) = found.content
    assert isinstance(orient, Orient)
    assert isinstance(orient.vector, Nrm)


def test_a_rule_that_does_not_ship_is_unknown_and_nothing_else() -> None:
    text = ":info-about\n    'topic\n    :mois sgn9\n    'info\n    :brumaire\n"
    assert found(text) == ["unknown-rule 3:5", "unknown-rule 5:5"]


def test_the_inline_form_is_the_canonical_one() -> None:
    inline = program("not-but(tree(), wardrobe())").score()
    canonical = program(SCORES["nicht-sondern"]).score()
    assert inline.duration == canonical.duration
    found = value("not-but(tree(), wardrobe())")
    assert isinstance(found, ScoreValue)
    assert times(group("not-but(tree(), wardrobe())")) == times(
        group("nicht-sondern(arbre(), armoire())")
    )
