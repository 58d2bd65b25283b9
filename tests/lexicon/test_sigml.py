"""Gestural SiGML: faults are told and survived; no file can do more than that."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pairs import sigml

from azee.lexicon.model import Heading, Sign, Straight
from azee.lexicon.moving import TooLongError
from azee.lexicon.reading import Found, read_all, read_bytes
from azee.lexicon.rule_text import rule_text
from azee_grammar.format import format_file
from azee_grammar.source import Source

SIGNS = Path(__file__).parent / "signs"


def _found(document: bytes) -> Found:
    (found,) = read_bytes(document, "x.sigml")
    return found


def _sign(document: bytes) -> Sign:
    found = _found(document)
    assert found.sign is not None, found.problems
    return found.sign


FAULTS = {
    "gaze-in-face-tier": '<facialexpr_tier><eye_gaze movement="DN"/></facialexpr_tier>',
    "shoulder-in-head-tier": '<head_tier><shoulder_movement movement="UB"/></head_tier>',
    "unknown-brows": '<facialexpr_tier><eye_brows movement="DN"/></facialexpr_tier>',
    "unknown-head": '<head_tier><head_movement movement="ND"/></head_tier>',
    "unknown-shoulders": '<shoulder_tier><shoulder_movement movement="NU"/></shoulder_tier>',
    "gesture-as-mouthing": '<mouthing_tier><mouth_picture picture="C04"/></mouthing_tier>',
    "odd-palm": '<handconfig palmor="o"/>',
    "odd-direction": '<handconfig extfidir="xy"/>',
    "between-itself": '<handconfig handshape="fist" second_handshape="fist"/>',
    "unknown-bend": '<handconfig handshape="fist" mainbend="0.50.5"/>',
    "not-two-hands": '<split_location><location_bodyarm location="chin"/></split_location>',
    "unknown-element": "<leapmotion/>",
    "unknown-value": '<location_bodyarm location="knee"/>',
    "no-direction": "<directedmotion/>",
}


@pytest.mark.parametrize("kind", FAULTS)
def test_a_fault_is_told_with_its_line_and_the_rest_is_read(kind: str) -> None:
    fault = FAULTS[kind]
    tier = "_tier>" in fault
    sign = _sign(
        sigml(
            f"<sign_nonmanual>{fault if tier else ''}</sign_nonmanual>\n"
            f'<sign_manual><handconfig handshape="flat" extfidir="u" palmor="l"/>\n'
            f'{"" if tier else fault}<directedmotion direction="u"/></sign_manual>'
        )
    )
    assert [(found.kind, found.line) for found in sign.faults] == [(kind, 1 if tier else 3)]
    assert sign.manuals[0].moves == (Straight(Heading("u")),)
    assert f"# In the notation: {sign.faults[0].detail}." in rule_text(sign, "x", "test").text


def test_numeric_bends_and_speeds_are_read() -> None:
    manual = '<sign_manual><handconfig handshape="flat" mainbend="410"/>'
    manual += '<directedmotion direction="u" speed="{}"/></sign_manual>'
    sign = _sign(sigml(manual.format("0.5")))
    assert sign.faults == ()
    assert sign.manuals[0].moves[0].manner.speed == 0.5  # type: ignore[union-attr]
    for odd in ("nan", "-1", "x", "1e9"):
        assert [f.kind for f in _sign(sigml(manual.format(odd))).faults] == ["unknown-value"]


BOMB = b"""<?xml version="1.0"?><!DOCTYPE lolz [<!ENTITY a "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa">
%s]><sigml><hamgestural_sign gloss="&z;"><sign_manual>&z;</sign_manual></hamgestural_sign>
</sigml>"""


def test_entities_neither_grow_nor_read_files(tmp_path: Path) -> None:
    names = "abcdefghijklmnopqrstuvwxyz"
    grow = "".join(f'<!ENTITY {b} "{f"&{a};" * 12}">' for a, b in itertools.pairwise(names))
    found = _found(BOMB % grow.encode())
    assert found.sign is None or len(found.sign.gloss) < 1000
    secret = tmp_path / "secret"
    secret.write_text("SECRET")
    outside = f'<!ENTITY z SYSTEM "{secret.as_uri()}">'
    found = _found(BOMB % outside.encode())
    assert "SECRET" not in repr(found)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "is not XML: "),
        (b"<sigml>", "is not XML: "),
        (b"<sigml/>", "has no sign"),
        (b"\xff\xfe\x00", "is not XML: "),
        (b"<a>" * 5000, "is not XML: "),
        (b'<?xml version="1.0" encoding="ebcdic-nonsense"?><a/>', "is not XML: "),
    ],
)
def test_what_is_no_sigml_is_told(data: bytes, message: str) -> None:
    found = _found(data)
    assert found.sign is None
    assert [problem.code for problem in found.problems] == ["bad-sigml"]
    assert message in found.problems[0].message


def test_a_sign_that_repeats_repetitions_is_refused() -> None:
    inner = '<directedmotion direction="u"/>'
    for _ in range(12):
        inner = f'<rpt_motion repetition="fromstart_several">{inner}</rpt_motion>'
    with pytest.raises(TooLongError):
        rule_text(_sign(sigml(f"<sign_manual>{inner}</sign_manual>")), "x", "test")


TAGS = [
    "sign_manual",
    "sign_nonmanual",
    "handconfig",
    "split_handconfig",
    "location_bodyarm",
    "location_hand",
    "split_location",
    "handconstellation",
    "directedmotion",
    "circularmotion",
    "wristmotion",
    "fingerplay",
    "nomotion",
    "tgt_motion",
    "par_motion",
    "seq_motion",
    "split_motion",
    "rpt_motion",
    "changeposture",
    "mouthing_tier",
    "mouth_picture",
    "mouth_gesture",
    "head_tier",
    "head_movement",
    "eye_gaze",
    "unheard",
]
ATTRIBUTES = {
    "handshape": "flat fist pinch12 cee12open finger2345 nonsense",
    "second_handshape": "flat pinchall ceeall",
    "thumbpos": "out across opposed nonsense",
    "second_thumbpos": "out across opposed",
    "mainbend": "bent round 123 9",
    "bend2": "hooked 1",
    "specialfingers": "2 35 1 9",
    "exempteddigits": "2 345",
    "contactpair": "12 23 45 1",
    "extfidir": "u ol dir xx",
    "second_extfidir": "d ir",
    "palmor": "l u dr o",
    "location": "chin chest head palm tip elbow lowerarm neck nothing underchin",
    "second_location": "lips stomach midjoint",
    "side": "left_at right_beside palmar dorsal front",
    "second_side": "right_at",
    "contact": "touch close armextended",
    "digits": "1 2 234 9",
    "direction": "u or dil zz",
    "axis": "l ui o",
    "curve": "u l z",
    "size": "small big huge",
    "start": "r ur",
    "end": "d",
    "ellipse_direction": "ul h v",
    "zigzag_style": "wavy zigzag",
    "motion": "nodding stircw twisting odd",
    "repetition": "fromstart reverse continue_several tofroto",
    "repetition_baseshift": "o l",
    "both_hands": "true",
    "lr_symm": "true",
    "ud_symm": "true",
    "oi_symm": "true",
    "outofphase": "true",
    "nondominant": "true",
    "fast": "true",
    "speed": "2 0 x",
    "picture": "fOo: C04 ßü",
    "movement": "SH L06 XX",
    "fused": "true",
}


def _elements(depth: int) -> st.SearchStrategy[str]:
    attribute = st.sampled_from(sorted(ATTRIBUTES)).flatmap(
        lambda name: st.sampled_from(ATTRIBUTES[name].split()).map(lambda v: (name, v))
    )
    inner = st.just("") if depth == 0 else st.lists(_elements(depth - 1), max_size=4).map("".join)

    def element(tag: str, pairs: list[tuple[str, str]], content: str) -> str:
        written = "".join(f' {name}="{value}"' for name, value in dict(pairs).items())
        return f"<{tag}{written}>{content}</{tag}>"

    return st.builds(element, st.sampled_from(TAGS), st.lists(attribute, max_size=6), inner)


@given(st.lists(_elements(3), min_size=1, max_size=5).map("".join))
def test_any_elements_are_rules_or_diagnostics(inner: str) -> None:
    document = f'<hamgestural_sign gloss="x"><sign_manual both_hands="true">{inner}</sign_manual>'
    found = _found(f"<sigml>{document}</hamgestural_sign></sigml>".encode())
    assert found.sign is not None
    try:
        rule = rule_text(found.sign, "x", "test").text
    except TooLongError:
        return
    format_file(Source("x", rule))


@given(st.binary(max_size=200), st.sampled_from(["x.sigml", "x.csv"]))
def test_any_bytes_are_signs_or_diagnostics(data: bytes, name: str) -> None:
    for found in read_bytes(data, name):
        assert found.sign is not None or found.problems


def test_all_signs_of_the_folder_are_read() -> None:
    found = list(read_all(SIGNS))
    assert len(found) >= 20
    assert all(one.sign is not None for one in found)
