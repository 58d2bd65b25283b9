"""Forms of production rules: where their blocks stand, and what they make of their arguments."""

from __future__ import annotations

from fractions import Fraction

import pytest
from evaluations import content, found, group, times

from azee.score.score import Group, Key, leaves
from azee_solver.constraint import Morph, Rotate

FACES = ("with-worry", "closer-look", "peacefully", "trouble-disturbance", "with-chaos")


@pytest.mark.parametrize("face", FACES)
def test_a_face_begins_before_its_sign_and_ends_with_it(face: str) -> None:
    form = group(f":{face}(blank(2))")
    assert times(form) == {
        "SIG": (0.25, 2.25),
        "ONSET": (0, 0.65),
        "APEX": (0.65, 1.75),
        "DECAY": (1.75, 2.25),
    }


def test_a_face_is_strongest_at_its_apex() -> None:
    form = group(":closer-look(blank(2))")
    weights = {}
    for name in ("ONSET", "APEX", "DECAY"):
        key = form.block(name).score
        assert isinstance(key, Key)
        weights[name] = {c.name: c.weight for c in key.constraints if isinstance(c, Morph)}
        assert any(isinstance(c, Rotate) for c in key.constraints)
    for morph, apex in weights["APEX"].items():
        assert weights["ONSET"][morph] == weights["DECAY"][morph] == pytest.approx(0.55 * apex)


def test_items_of_a_list_stand_in_order() -> None:
    for rule in ("all-of", "each-of", "mutex-list", "time-seq", "sign-supported-sequence"):
        form = content(f":{rule}(list(:nb-1, :nb-2, :nb-3))")
        assert isinstance(form, Group)
        seen = _rules(form)
        assert [name for name in seen if name.startswith("nb-")] == ["nb-1", "nb-2", "nb-3"], rule


def _rules(form: Group) -> list[str]:
    out: list[str] = []
    for block in sorted(form.blocks, key=lambda b: b.interval_in_parent.start):
        out += [call.rule for call in block.score.calls]
        if isinstance(block.score, Group):
            out += _rules(block.score)
    return out


@pytest.mark.parametrize("n", [1, 3, 5])
@pytest.mark.parametrize("rule", ["mult-in-a-row", "mult-around"])
def test_multiples_repeat_their_sign_at_places(rule: str, n: int) -> None:
    for elt in (".personne", ":mignon"):
        form = content(f":{rule}({elt}, {n})")
        assert isinstance(form, Group)
        assert len(form.blocks) == n
        assert all(b.interval_in_parent.duration == Fraction(1, 2) for b in form.blocks)
    places = content(f":{rule}(.personne, 3)")
    assert isinstance(places, Group)
    hands = [tuple(str(leaf) for leaf in leaves(b.score)) for b in places.blocks]
    assert len(set(hands)) == len(hands)


def test_a_count_is_a_rule_or_a_score() -> None:
    for count in (".nb-3", ":nb-3", ":number(12)", ":tens-units(.nb-1, .nb-2)"):
        form = group(f":element-count(blank(1), {count})")
        assert times(form)["COUNT"][0] == pytest.approx(1.3)


def test_older_names_forward() -> None:
    items = "list(blank(1), blank(2))"
    for older, newer in (
        ("seq-res(blank(1), blank(2))", "sequence-result(blank(1), blank(2))"),
        ("sign-supported-spoken(" + items + ")", "sign-supported-sequence(" + items + ")"),
    ):
        assert times(group(f":{older}")) == times(group(f":{newer}"))


def test_a_question_is_of_one_of_two_kinds() -> None:
    asked = group(":question(blank(1))"), group(":question(blank(1), 'wh)")
    assert times(asked[0]) == times(group(":yes-no-question(blank(1))"))
    assert times(asked[1]) == times(group(":wh-question(blank(1))"))
    assert found(":question('sig = blank(1), 'kind = 'wh)") == []
