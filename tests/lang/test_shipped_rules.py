"""The rules that ship: all evaluate, say what they mean, and have the published forms."""

from __future__ import annotations

from fractions import Fraction

import pytest
from evaluations import constraints, group, problems, program, times, value

from azee.lang.library import shipped_library
from azee.lang.rule import STATUSES, Rule
from azee.lang.values import (
    BooleanValue,
    ConstraintsValue,
    ListValue,
    PointValue,
    ScoreValue,
    TextValue,
    VectorValue,
)
from azee.score.score import Group, Key, leaves
from azee_grammar.library import shipped_names
from azee_solver.constraint import LookAt, Morph, Place, Rotate
from azee_solver.geometry import Side

RULES = [
    rule for name in shipped_names() for rule in shipped_library(name).namespace.rules.values()
]
CORE = (
    *("info-about", "side-info", "instance-of", "about-ref", "in-context", "not-but"),
    *("tens-units", "nicht-sondern", "category", "about-point", "no-worries"),
)
SIGNS = (
    *("arbre", "armoire", "cinéma", "bien", "personne", "âge", "pays", "Irak", "irak", "chat"),
    *("mignon", "bonjour", "mercredi", "tree", "wardrobe", "cinema", "good", "person", "age"),
    *("country", "Iraq", "cat", "cute", "hello", "Wednesday"),
)
ARGUMENTS = {
    **dict.fromkeys(("pt", "loc", "centre", "from", "to", "position", "looking-at"), "^Rssp"),
    **dict.fromkeys(("shape", "more", "hand"), ":#fist"),
    **dict.fromkeys(("tens", "units"), ".nb-2"),
    "items": "list((blank 1), (blank 1))",
    "offsets": "list(^left, ^right)",
    "face": ".frown",
    "class": ".building-cl",
    "n": "3",
    "text": "concat('SAM)",
    "character": "concat('a)",
    "name": "concat('letter-A)",
    "done": "list(list(), 0, 'none)",
    "letter": "rule(concat('letter-A), 'of = 'asl)",
    "at": "^Mssp",
    "param$0": "s",
    "fingers": "^up",
    "palm": "^fwd",
    "point": "^Rssp",
}
"""What stands for an argument that must be given, by its name; a score for any other."""
OF_MULTIPLES = {"elt": ".personne"}


def _uses(rule: Rule) -> str:
    """The line that brings a rule into scope, where the core and LSF are not all."""
    return "" if rule.library in ("core", "lsf") else f"use '{rule.library}\n"


def _application(rule: Rule) -> str:
    """The rule applied with an argument for everything that must be given."""
    arguments = [_argument(rule, name) for name, mandatory in rule.parameters if mandatory]
    return f":{rule.name}({', '.join(arguments)})"


def _argument(rule: Rule, name: str) -> str:
    given = ARGUMENTS | (OF_MULTIPLES if rule.name.startswith("mult-") else {})
    return f"'{name} = {given.get(name, '(blank 1)')}"


def test_the_shipped_texts_are_sound() -> None:
    assert shipped_names() == ("asl", "core", "lsf", "tid")
    for name in shipped_names():
        assert shipped_library(name).diagnostics == []
    for rule in RULES:
        assert rule.procedure is not None
        assert list(rule.diagnostics) == []


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_a_rule_evaluates_and_says_what_it_is(rule: Rule) -> None:
    assert rule.entry("meaning")
    assert rule.entry("source")
    assert rule.entry("status") in STATUSES
    text = _application(rule)
    found = value(text, _uses(rule))
    if rule.name in ("in-space", "from"):
        assert isinstance(found, PointValue)
    elif rule.name in ("way", "axis"):
        assert isinstance(found, VectorValue)
    else:
        assert isinstance(
            found,
            ScoreValue | ConstraintsValue | ListValue | PointValue | TextValue | BooleanValue,
        )
    if isinstance(found, ScoreValue):
        assert problems(_uses(rule) + text) == []
        assert program(_uses(rule) + text).check(Side.LEFT) == ()


@pytest.mark.parametrize(
    "rule", [r for r in RULES if r.entry("example")], ids=lambda rule: rule.name
)
def test_the_example_of_a_rule_evaluates(rule: Rule) -> None:
    assert problems(_uses(rule) + (rule.entry("example") or "")) == []


def test_every_rule_with_mandatory_arguments_has_an_example() -> None:
    lacking = [
        rule.name
        for rule in RULES
        if any(mandatory for _, mandatory in rule.parameters) and not rule.entry("example")
    ]
    assert lacking == []


@pytest.mark.parametrize("name", [*CORE, *(f"nb-{n}" for n in range(10)), *SIGNS])
def test_the_published_names_are_there(name: str) -> None:
    assert name in {rule.name for rule in RULES}


# Forms: where blocks stand ---------------------------------------------------------------------


def test_info_about_has_a_gap_a_blink_and_two_holds() -> None:
    form = group("info-about(blank(2), blank(2))")
    assert times(form) == {
        "TOPIC": (0, 2),
        "HOLD1": (2, 2.1),
        "INFO": (2.3, 4.3),
        "BLINK": (4.18, 4.3),
        "HOLD2": (4.3, 4.5),
    }
    assert form.duration == Fraction(9, 2)
    blink = form.block("BLINK").score
    assert isinstance(blink, Key)
    assert blink.constraints == (Morph("AU43", None, 1.0),)


def test_side_info_has_the_chin_between_the_items() -> None:
    form = group("side-info(blank(2), blank(2))")
    assert times(form) == {"FOCUS": (0, 2), "INFO": (2.17, 4.17), "CHIN": (1.75, 2.71)}


def test_instance_of_has_the_chin_over_the_type() -> None:
    form = group("instance-of(blank(2), blank(2))")
    assert times(form) == {"TYPE": (0, 2), "FOCUS": (2.17, 4.17), "CHIN": (0, 2.33)}
    assert times(group("category('cat = blank(2), 'elt = blank(2))")) == times(form)


def test_about_ref_leans_and_looks_before_it_signs() -> None:
    form = group("about-ref(blank(2), ^Rssp)")
    assert times(form) == {"SIG": (0.09, 2.09), "BODYLEAN": (0, 2.17), "GAZE": (0, 0.2)}
    gaze = form.block("GAZE").score
    assert isinstance(gaze, Key)
    assert isinstance(gaze.constraints[0], LookAt)
    assert times(group("about-point(^Rssp, blank(2))")) == times(form)


def test_in_context_has_a_nod_and_three_moves() -> None:
    form = group("in-context(blank(2), blank(2))")
    assert times(form) == {
        "CONTEXT": (0, 2),
        "HOLD1": (2, 2.04),
        "PROCESS": (2.29, 4.29),
        "HEAD": (2.04, 2.25),
        "BODY1": (2.02, 2.13),
        "BODY2": (2.19, 2.31),
        "BODY3": (2.39, 2.59),
    }


def test_nicht_sondern_has_a_headshake_over_a_hold() -> None:
    form = group("nicht-sondern(blank(2), blank(2))")
    found = times(form)
    expected = {"NICHT": (0, 2), "HOLD": (2, 2.1), "SONDERN": (2.27, 4.27)}
    assert {name: found[name] for name in expected} == expected
    shake = [leaf for leaf in leaves(form) if leaf.path[0] == "HEADSHAKE"]
    starts = [float(leaf.interval.start - 2) for leaf in shake]
    assert starts == pytest.approx([-0.1, 0.03, 0.2, 0.32])
    turns = [leaf.score.constraints[0] for leaf in shake if isinstance(leaf.score, Key)]
    assert [isinstance(t, Rotate) and t.angle_rad > 0 for t in turns] == [False, True, False, True]
    assert times(group("not-but(blank(2), blank(2))")) == found


def test_tens_units_takes_operators_and_moves_the_units_outwards() -> None:
    form = group("tens-units(.nb-5, .nb-2)")
    assert times(form) == {"TENS": (0, 0.7), "UNITS": (1.0, 1.7)}
    places = [
        c.point
        for leaf in leaves(form)
        if isinstance(leaf.score, Key)
        for c in leaf.score.constraints
        if isinstance(c, Place)
    ]
    assert len(set(places)) == 2
    assert [call.rule for call in form.block("TENS").score.calls] == ["nb-5", "number-sign"]


def test_the_face_of_no_worries_starts_before_what_it_is_about() -> None:
    form = group("no-worries(blank(2))")
    assert times(form) == {"SIG": (0.25, 2.25), "MOUTH": (0, 2.25)}


def test_armoire_has_the_published_times() -> None:
    assert times(group(":armoire")) == {
        "PERM": (0, 1.83),
        "HANDS_CONTACT": (0, 0.25),
        "TRANS_H": (0.25, 0.74),
        "PALMS_DOWN": (0, 0.74),
        "HANDS_APART": (0.74, 1.09),
        "PALMS_FACING": (0.83, 1.83),
        "TRANS_V": (1.09, 1.58),
        "HANDS_BOTTOM": (1.58, 1.83),
    }


def test_arbre_puts_the_strong_elbow_on_the_weak_palm() -> None:
    key = value(":arbre")
    assert isinstance(key, ScoreValue)
    assert isinstance(key.content, Key)
    placed = {c.site.name: c for c in key.content.constraints if isinstance(c, Place)}
    assert placed.keys() == {"H_BACK", "EL"}
    assert placed["EL"].contact


def test_a_hand_shape_is_of_one_side() -> None:
    left = constraints(":#fist('side = L)")
    assert {c.side for c in left if isinstance(c, Morph)} == {Side.LEFT}


def test_the_sentence_about_a_person_aged_52_nests_as_it_is_written() -> None:
    text = (
        ":info-about\n    'topic\n    :personne\n    'info\n    :info-about\n        'topic\n"
        "        :âge\n        'info\n        :tens-units\n            'tens\n            .nb-5\n"
        "            'units\n            .nb-2\n"
    )
    found = program(text).score()
    assert isinstance(found, Group)
    paths = ["/".join(leaf.path) for leaf in leaves(found)]
    assert paths[0] == "TOPIC/PERM"
    assert "INFO/INFO/TENS" in paths
    assert "INFO/INFO/UNITS" in paths
