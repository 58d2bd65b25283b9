"""What a word means and what kind of word it is, what is being applied, what is still missing."""

from __future__ import annotations

import pytest
from cursor import at_cursor, real_texts
from hypothesis import given
from hypothesis import strategies as st

from azee.assist.completeness import Completeness, completeness, wants_deeper
from azee.assist.completion import completions
from azee.assist.description import describe
from azee.assist.hover import hover
from azee.assist.knowledge import Knowledge
from azee.assist.pieces import Category, pieces
from azee.assist.signature import signature
from azee_grammar.layout import LayoutReader
from azee_grammar.parser import parse
from azee_grammar.source import Source

KNOWLEDGE = Knowledge.shipped()
TEXTS = sorted(set(real_texts()))


@pytest.mark.parametrize(
    ("text", "title", "meaning"),
    [
        (":inf|o-about", ":info-about", "info, said about topic"),
        ("key = |tree()", ":tree", "the English name of arbre"),
        ("place @|CH ^up", "@CH", "Chin"),
        ("rotate !head| ^up 1", "!head", "hangs on !neck"),
        ("morph 'AU43| 1", "'AU43", "Eye closure"),
        ("look ^f|wd", "^fwd", "forwards, away from the signer"),
        ("opposite s|", "s", "the strong side: that of the signer's dominant hand"),
        ("sync 'A :arbre 'B :chat 'wi|th 'A", "'with", "the block is the bounds of that block"),
        (":about-ref 'p|t ^up", "'pt", "'pt"),
        ("azop 'x 1 ^|x", "^x", "a parameter"),
        ("ke|y 1", "key", "The constraints hold for a duration in seconds; zero is legal."),
    ],
)
def test_a_word_is_described_where_it_stands(text: str, title: str, meaning: str) -> None:
    found = hover(*at_cursor(text), KNOWLEDGE)
    assert found is not None
    assert (found.described.title, found.described.meaning) == (title, meaning)


def test_a_rule_is_described_with_arguments_source_and_example() -> None:
    (found,) = describe("info-about", KNOWLEDGE)
    facts = dict(found.facts)
    assert found.signature == ":info-about 'topic 'info"
    assert facts["argument"] == "'info  mandatory"
    assert facts["gives"] == "a score"
    assert facts["example"] == ":info-about(:cinéma, :bien)"
    assert "Nunnari" in facts["source"]
    assert found.place is not None
    assert found.place.text == "info-about"


@pytest.mark.parametrize(
    ("text", "operand"),
    [
        (":about-ref 'pt |", "'pt"),
        ("about-ref(:arbre, |", "'pt"),
        ("about-ref('pt = |", "'pt"),
        ("place @CH |", "POINT"),
        ("key .5 (look |", "VECTOR"),
        ("vsum ^up ^up |", "VECTOR"),
    ],
)
def test_the_operand_at_hand_is_known(text: str, operand: str) -> None:
    found = signature(*at_cursor(text), KNOWLEDGE)
    assert found is not None
    assert found.active is not None
    start, end = found.operands[found.active]
    assert found.text[start:end] == operand


@pytest.mark.parametrize(
    ("text", "judged"),
    [
        ("", Completeness.WHOLE),
        (":arbre", Completeness.WHOLE),
        ("use 'lsf", Completeness.WHOLE),
        (":nobody-knows-it", Completeness.WHOLE),
        ("not-but(tree(),\n  wardrobe())", Completeness.WHOLE),
        ("key .5 )", Completeness.WHOLE),
        ("not-but(tree(),", Completeness.LACKING),
        (":info-about", Completeness.LACKING),
        ("key .5", Completeness.LACKING),
        ("sync", Completeness.LACKING),
        ("def x", Completeness.LACKING),
        ("def x\n    :arbre", Completeness.OPEN),
        (":info-about\n    'topic :arbre", Completeness.OPEN),
        ("def x\n    :arbre\n:x", Completeness.WHOLE),
    ],
)
def test_a_prompt_knows_when_more_must_follow(text: str, judged: Completeness) -> None:
    assert completeness(text, KNOWLEDGE) is judged


@pytest.mark.parametrize(
    ("line", "deeper"),
    [
        ("    cstr", True),
        ("'SIG sync", True),
        ("    key .5", True),
        ("'INFO :info-about", True),
        ("def x", True),
        ("    :chat", False),
        ("'SIG :chat", False),
        ("    place @CH @FH", False),
        ("    key .5 (look", False),
        ("'x", False),
    ],
)
def test_a_prompt_knows_where_deeper_lines_are_to_be_expected(line: str, deeper: bool) -> None:
    assert wants_deeper(line, KNOWLEDGE) is deeper


@pytest.mark.parametrize("text", TEXTS)
def test_pieces_are_the_tokens_of_the_parser(text: str) -> None:
    found = {(p.start, p.end): p.category for p in pieces(text)}
    reader = LayoutReader(Source("", text))
    tokens = [token for item in reader.items() for token in item.tokens if token.start < token.end]
    comments = dict.fromkeys(reader.comments, Category.COMMENT)
    told_apart = {"KEYWORD": {"USE", "DEF"}, "DEFINED": {"NAME"}, "WRONG": {"BAD"}}
    punctuation = {"_OPEN", "_CALL", "CLOSE", "_COMMA", "_EQUALS"}
    for token in tokens:
        category = found[token.start, token.end]
        kinds = punctuation if category is Category.PUNCTUATION else {category.name}
        assert token.kind in told_apart.get(category.name, kinds)
    if not parse(Source("", text)).diagnostics:
        assert set(found) == {(t.start, t.end) for t in tokens} | set(comments)
    assert {place: found[place] for place in comments} == comments


@pytest.mark.long
@given(st.data())
def test_whatever_is_typed_gets_an_answer(data: st.DataObject) -> None:
    """Real texts from which a piece was taken out, as they are while somebody edits them."""
    text = data.draw(st.sampled_from(TEXTS))
    start = data.draw(st.integers(0, len(text)))
    cut = text[:start] + text[data.draw(st.integers(start, len(text))) :]
    offset = data.draw(st.integers(0, len(cut)))
    for found in completions(cut, offset, KNOWLEDGE):
        assert found.start <= found.end == offset
    if meant := hover(cut, offset, KNOWLEDGE):
        assert meant.start <= offset <= meant.end
    signature(cut, offset, KNOWLEDGE)
    completeness(cut, KNOWLEDGE)
    at = 0
    for piece in pieces(cut):
        assert at <= piece.start < piece.end
        at = piece.end
