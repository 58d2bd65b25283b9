"""The work of a check grows with its text, counted in calls: clocks depend on the machine."""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import FrameType

import pytest
from evaluations import program

from azee.assist.hover import hover
from azee.assist.knowledge import Knowledge
from azee_grammar.excerpt import Excerpt
from azee_grammar.source import Source, Span


def _calls(work: Callable[[], object]) -> int:
    """Count the calls, and the steps of generators, of some work."""
    calls = 0

    def count(_: FrameType, event: str, __: object) -> None:
        nonlocal calls
        calls += event in ("call", "c_call")

    before = sys.getprofile()
    sys.setprofile(count)
    try:
        work()
    finally:
        sys.setprofile(before)
    return calls


@pytest.mark.parametrize("one", [" :bien", " (key .2 (place @I_TIP(s) @CH 'contact))"])
def test_a_check_of_twice_the_text_is_twice_the_work(one: str) -> None:
    program(":bien").check()  # the rules that ship are resolved once
    texts = [program(f"seq (list{one * count})") for count in (40, 80)]
    small, large = (_calls(text.check) for text in texts)
    assert all(text.check() == () for text in texts)
    assert small > 1000
    assert large < 2.2 * small


def test_the_meaning_of_a_word_costs_what_its_rule_is_long() -> None:
    knowledge = Knowledge.shipped()
    calls = []
    for count in (10, 100):
        text = "".join(f"def r{i}\n    seq (list :bien :arbre)\n" for i in range(count))
        offset = text.index(":arbre", len(text) // 2) + 2

        def work(text: str = text, offset: int = offset) -> None:
            found = hover(text, offset, knowledge)
            assert found is not None
            assert found.described.title == ":arbre"

        work()
        calls.append(_calls(work))
    assert calls[1] < calls[0] + 4 * 90  # to find where a rule begins costs a call or two each


def test_an_excerpt_of_plain_text_needs_no_call_for_each_character() -> None:
    source = Source("<text>", ":bein " * 1500)
    calls = _calls(lambda: Excerpt.of(Span(source, 6000, 6005)))
    assert calls < 400


def test_what_a_misspelt_word_may_mean_is_searched_once_however_often_it_stands() -> None:
    program(":bein").check()  # the rules that ship are resolved once
    once, often = (program("seq (list" + " :biein" * count + ")") for count in (1, 100))
    searched = _calls(once.check)
    assert _calls(often.check) < searched + 100 * 300
    assert len(often.check()) == 100
