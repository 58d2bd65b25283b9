"""What is offered for a word that is being written."""

from __future__ import annotations

import pytest
from cursor import at_cursor

from azee.assist.completion import completions
from azee.assist.knowledge import Knowledge
from azee.lang.program import load
from azee_grammar.source import Source

KNOWLEDGE = Knowledge.shipped()


def offered(marked: str) -> list[str]:
    text, offset = at_cursor(marked)
    return [completion.insert for completion in completions(text, offset, KNOWLEDGE)]


@pytest.mark.parametrize(
    ("text", "likely"),
    [
        (":info-a|", ":info-about"),
        ("cine|", ":cinéma"),
        (":about-ref |", "'sig"),
        (":about-ref 'sig :arbre |", "'pt"),
        (":about-ref\n    'sig :arbre\n    'p|", "'pt"),
        ("about-ref(|", "'sig = "),
        ("about-ref(:arbre, |", "'pt = "),
        ("key .2 (rotate !he|", "!head"),
        ("key .5\n    place @I_T|", "@I_TIP"),
        ("place @CH @FH '|", "'dist"),
        ("orient 'dir !palm(s) '|", "'along"),
        ("morph 'smi|", "'smile"),
        ("morph 'AU43 s 1 'smi|", "'smile"),
        ("look ^|", "^up"),
        ("key 1 :fla|", ":#flat-hand"),
        ("key 1 (look |", "^up"),
        ("seq (list :bonjour :arb|", ":arbre"),
        (":#flat|", ":#flat-hand"),
        ("sync\n    'A :chat\n    'B :arbre\n    '|", "'start/end"),
        ("sync\n    'A :chat\n    'B :arbre\n    'start |", "'A:end"),
        ("sync\n    'A :chat\n    'B :arbre\n    'with |\n    'C :chat", "'A"),
        ("sync\n    'A :chat\n    'H hold('|, 1)\n    'start 'A:end", "'A"),
        ("sync\n    'A :chat\n    'H hold('A, 1, 'only, list('ha|))", "'hands"),
        ("use 'l|", "'lsf"),
        ("def x\n    'me|", "'meaning"),
        ("azop\n    'loc |\n    :arbre", "'nodefault"),
        ("def x\n    azop\n        'loc ^Mssp\n        :chat 'loc ^|", "^loc"),
        ("let 'q 3\n    key ^|", "^q"),
        ("def mine\n    :arbre\n:mi|", ":mine"),
    ],
)
def test_the_likeliest_name_comes_first(text: str, likely: str) -> None:
    assert offered(text)[0] == likely


def test_the_places_of_a_text_are_offered() -> None:
    program = load(Source("", "places 'ici ^Rssp\n"))
    text, offset = at_cursor("key 1 (lookat ^ic|")
    found = completions(text, offset, Knowledge(program.scope))
    assert [(c.insert, c.described.meaning) for c in found][:1] == [
        ("^ici", "a place of this text")
    ]


@pytest.mark.parametrize(
    ("text", "absent"),
    [
        (":about-ref 'sig :arbre '|", "'sig"),
        ("sync\n    'A :chat\n    'B :arbre\n    'start '|", "'B:end"),
        ("place |", "!head"),
        ("key |", ":arbre"),
        ("let 'q ^|\n    1", "^q"),
        (":arbre # :info-a|", ":info-about"),
        ('def x\n    \'meaning ":info-a|"', ":info-about"),
    ],
)
def test_what_cannot_stand_there_is_not_offered(text: str, absent: str) -> None:
    assert absent not in offered(text)


def test_only_the_word_before_the_cursor_is_replaced_and_its_meaning_is_shown() -> None:
    text, offset = at_cursor("key .5\n    place @I_T|x")
    found = completions(text, offset, KNOWLEDGE)[0]
    assert text[found.start : found.end] == "@I_T"
    assert found.described.meaning == "Tip of the index finger"
    assert found.described.signature == "@I_TIP SIDE"
