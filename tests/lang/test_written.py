"""Which applications a text writes, and where they stand in each other."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from any_programs import programs
from evaluations import program
from hypothesis import given

from azee.lang.program import load
from azee.lang.provenance import written
from azee_grammar.source import Source


def rows(text: str) -> Sequence[tuple[str, int, str | None]]:
    """Name, depth and slot of every application of the utterances of a text."""
    return [(found.name, found.depth, found.slot) for found in written(program(text))]


def test_applications_stand_in_the_arguments_of_others() -> None:
    assert rows(":info-about\n    'topic :âge\n    'info tens-units(.nb-5, .nb-2)\n") == [
        ("info-about", 0, None),
        ("âge", 1, "topic"),
        ("tens-units", 1, "info"),
        ("nb-5", 2, "tens"),
        ("nb-2", 2, "units"),
    ]


def test_operators_and_lists_between_rules_add_no_depth() -> None:
    assert rows("info-about(seq(list(:chat, :bien)), :pays)\n") == [
        ("info-about", 0, None),
        ("chat", 1, "topic"),
        ("bien", 1, "topic"),
        ("pays", 1, "info"),
    ]
    assert rows("seq(list(:chat, :bien))\n") == [("chat", 0, None), ("bien", 0, None)]


def test_a_rule_that_only_forwards_counts_as_the_other_with_its_arguments() -> None:
    assert rows("not-but(tree(), wardrobe())\n") == [
        ("nicht-sondern", 0, None),
        ("arbre", 1, "nicht"),
        ("armoire", 1, "sondern"),
    ]


def test_unknown_rules_keep_their_names_and_slots() -> None:
    text = ":never-defined\n    'loc :nowhere\n    'what :arbre\n"
    assert rows(text) == [("never-defined", 0, None), ("nowhere", 1, "loc"), ("arbre", 1, "what")]
    found = written(program(text))
    assert [f.rule is None for f in found] == [True, True, False]
    assert found[0].slots == ("loc", "what")
    assert [f.around and f.around.name for f in found] == [None, "never-defined", "never-defined"]


def test_wrong_arguments_hide_no_application() -> None:
    assert rows(":info-about\n    'subject :chat\n") == [
        ("info-about", 0, None),
        ("chat", 1, None),
    ]


def test_definitions_do_not_count_and_one_utterance_or_an_expression_can_be_chosen() -> None:
    text = program("def tea\n    :bien\n\n:chat\n:tea\n")
    assert [f.name for f in written(text)] == ["chat", "bien"]
    assert [f.name for f in written(text, utterance=1)] == ["chat"]
    assert [f.name for f in written(text, "side-info(:tea, :pays)")] == [
        "side-info",
        "bien",
        "pays",
    ]


@pytest.mark.long
@given(programs)
def test_every_application_lies_in_the_one_around_it(text: str) -> None:
    found = written(load(Source("<any>", text)))
    for inner in found:
        outer = inner.around
        assert inner.depth == (0 if outer is None else outer.depth + 1)
        if outer is not None:
            assert outer.span.start <= inner.span.start <= inner.span.end <= outer.span.end
            assert inner.slot is None or inner.slot in outer.slots
    assert len({(f.span.start, f.span.end) for f in found}) == len(found)


@pytest.mark.parametrize("text", ["key 1 (look ^fwd)\n", ""])
def test_a_text_without_rules_has_none(text: str) -> None:
    assert rows(text) == []
