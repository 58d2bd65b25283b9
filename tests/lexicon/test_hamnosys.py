"""HamNoSys: the same sign as in SiGML, and diagnostics that mark the symbol amiss."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pairs import PAIRS, sigml, symbols

from azee.lexicon.hamnosys import MOST_SYMBOLS, read_symbols
from azee.lexicon.hamnosys_symbols import NAMES, NOT_READ, SYMBOLS
from azee.lexicon.model import Sign
from azee.lexicon.moving import TooLongError
from azee.lexicon.reading import read_bytes
from azee.lexicon.rule_text import rule_text
from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.format import format_file
from azee_grammar.source import Source


def _read(document: bytes) -> Sign:
    (found,) = read_bytes(document, "pair.sigml")
    assert found.sign is not None, found.problems
    return found.sign


@pytest.mark.parametrize("name", PAIRS)
def test_a_sign_is_the_same_rule_from_either_notation(name: str) -> None:
    names, manual = PAIRS[name]
    from_symbols, from_sigml = read_symbols(symbols(names), "PAIR"), _read(sigml(manual))
    assert from_symbols == from_sigml
    rules = [rule_text(sign, "pair", "test") for sign in (from_symbols, from_sigml)]
    assert rules[0] == rules[1]
    assert len(rules[0].text.splitlines()) > 8


@pytest.mark.parametrize("name", PAIRS)
def test_symbols_are_the_same_as_elements_of_xml(name: str) -> None:
    names, _ = PAIRS[name]
    elements = "".join(f"<ham{word}/>" for word in names.split())
    document = '<sigml><hns_sign gloss="PAIR"><hamnosys_nonmanual><hnm_mouthpicture picture="pEr"/>'
    document += f'<hnm_eyebrows tag="RB"/></hamnosys_nonmanual><hamnosys_manual>{elements}'
    sign = _read(f"{document}</hamnosys_manual></hns_sign></sigml>".encode())
    assert sign.manuals == read_symbols(symbols(names), "PAIR").manuals
    assert sign.nonmanual.mouthing == "pEr"
    assert [(tier.name, tier.code) for tier in sign.nonmanual.tiers] == [("brows", "RB")]


def _amiss(text: str) -> Diagnostic:
    with pytest.raises(AZeeError) as caught:
        read_symbols(text, "X")
    (found,) = caught.value.diagnostics
    return found


def test_the_symbol_amiss_is_marked_by_its_name() -> None:
    found = _amiss(symbols("flathand palmu extfingeru"))
    assert found.code == "bad-hamnosys"
    assert found.span is not None
    assert found.span.text == "hamextfingeru"
    assert found.span.source.text == "hamflathand hampalmu hamextfingeru"
    assert "ends before it is complete" in _amiss(symbols("parbegin flathand plus")).message
    assert "no symbols" in _amiss("abc").message
    assert _amiss(symbols("fist") * (MOST_SYMBOLS + 1)).code == "size-limit"


def test_symbols_that_say_nothing_of_the_form_are_told() -> None:
    text = symbols("flathand extfingeru palml coreftag version40 chest") + "x"
    sign = read_symbols(text, "X")
    told = [fault.detail for fault in sign.faults]
    assert told == [
        "`hamcoreftag` is not read",
        "`hamversion40` is not read",
        "`x` is no symbol of HamNoSys",
    ]


def test_the_table_of_symbols() -> None:
    assert NAMES["\ue000"] == "fist"
    assert NAMES["\ue031"] == "extfingeruo"
    assert NAMES["\ue0e9"] == "symmlr"
    assert NAMES["\ue0f1"] == "version40"
    assert len(NAMES) == len(set(NAMES.values())) == 201
    assert set(SYMBOLS) >= NOT_READ - {"mime", "etc"}


KNOWN = sorted(set(NAMES) - {SYMBOLS[name] for name in NOT_READ if name in SYMBOLS})


@given(st.lists(st.sampled_from(KNOWN), min_size=1, max_size=14).map("".join))
def test_any_symbols_are_a_rule_or_a_diagnostic(text: str) -> None:
    try:
        rule = rule_text(read_symbols(text, "X"), "x", "test").text
    except (AZeeError, TooLongError):
        return
    format_file(Source("x", rule))
