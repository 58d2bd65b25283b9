"""What a notation leaves to the reader is written so that a body can do it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from pairs import sigml

from azee.lexicon.clearance import circle_before_body, cleared
from azee.lexicon.hands import Hand
from azee.lexicon.model import Form, HandShape, Heading, OnBody
from azee.lexicon.phrase import CircleWay
from azee.lexicon.places import Place, Site, apart, body_place
from azee.lexicon.reading import read_bytes
from azee.lexicon.rule_text import rule_text
from azee_solver.path import circle

POINTING_UP = '<handconfig handshape="flat" extfidir="u" palmor="l"/>'


def _rule(manual: str) -> str:
    (found,) = read_bytes(sigml(manual), "x.sigml")
    assert found.sign is not None
    return rule_text(found.sign, "x", "test").text


def _both(inner: str, more: str = "") -> str:
    return _rule(f'<sign_manual both_hands="true" lr_symm="true" {more}>{inner}</sign_manual>')


def test_two_hands_before_one_part_of_the_face_are_beside_each_other() -> None:
    text = _both(f'{POINTING_UP}<location_bodyarm location="forehead" contact="close"/>')
    assert "place @PA(s) :from('point = @FH, 'out = .077, 'fwd = .077)" in text
    assert "place @PA(w) :from('point = @FH, 'side = w, 'out = .077, 'fwd = .077)" in text


def test_two_hands_touch_the_middle_of_the_face_on_their_own_sides() -> None:
    text = _both(f'{POINTING_UP}<location_bodyarm location="nose" contact="touch"/>')
    assert "@NO(s) 'contact" in text
    assert "@NO(w) 'contact" in text
    assert apart(Place((Site("CK", "w"),))) == Place((Site("CK", "w"),))


def test_a_touch_between_two_sites_is_a_contact() -> None:
    text = _rule(
        f'<sign_manual>{POINTING_UP}<location_bodyarm location="chin" second_location="lips"'
        ' contact="touch"/></sign_manual>'
    )
    assert "midpoint(@CH, @MO) 'contact\n" in text


def test_a_touch_beside_a_part_of_the_face_is_on_the_skin() -> None:
    beside = body_place(OnBody("forehead", side="right_beside", contact="touch"))
    assert beside == Place((Site("TE", "s"),), touches=True)
    before = body_place(OnBody("forehead", side="right_beside", contact="close"))
    assert before.sites == (Site("FH", "s"),)


def test_between_the_neck_and_the_chin_is_halfway_in_height() -> None:
    place = body_place(OnBody("neck", second="chin", contact="close"))
    neck, chin = (body_place(OnBody(at, contact="close")) for at in ("neck", "chin"))
    assert neck.is_space
    assert not chin.is_space
    assert place.offset[1] == pytest.approx((0.13 + 0.31) / 2 * 0.4808, abs=1e-3)
    ear = body_place(OnBody("ear", second="shoulders", contact="close"), "s")
    assert ear.offset[0] == pytest.approx(
        -body_place(OnBody("ear", second="shoulders", contact="close"), "w").offset[0]
    )
    assert ear.offset[0] < 0


@pytest.mark.parametrize(
    ("x", "y", "z", "fingers", "least"),
    [
        (0.0, -0.2, 0.05, "i", 0.13 + 0.01 + 0.128),
        (0.0, -0.2, 0.05, "u", 0.13 + 0.01),
        (0.0, 0.03, 0.05, "u", 0.10 + 0.01),
        (0.0, -0.2, 0.30, "i", 0.30),
        (0.3, -0.2, 0.05, "i", 0.05),
        (0.0, 0.5, 0.05, "i", 0.05),
    ],
)
def test_a_hand_that_moves_into_the_body_stays_before_it(
    x: float, y: float, z: float, fingers: str, least: float
) -> None:
    start = Place(offset=(x, y, 0.4))
    moved = start.moved((0.0, 0.0, z - 0.4))
    flat = Hand(HandShape(Form("flat")), Heading(fingers), Heading("l"), Site("PA", "s"), moved)
    place = cleared(flat).place
    assert place is not None
    assert place.offset == pytest.approx((x, y, least))
    way = place.way_from(start)
    assert way == pytest.approx((0.0, 0.0, least - 0.4))


def test_a_hand_that_turns_is_kept_before_the_body_where_its_palm_is() -> None:
    """The fingertip is at the belly, the palm beside the body: it may go back past the flank."""
    tip, form = Site("I_TIP", "s"), HandShape(Form("finger2"))
    at_belly = Place((Site("AB", "s"),), touches=True)
    before = Hand(form, Heading("l"), Heading("u"), tip, at_belly)
    turned = Hand(form, Heading("ol"), Heading("u"), tip, at_belly.moved((0.0, 0.0, -0.23)))
    assert cleared(turned, before) == turned
    assert cleared(turned) != turned


def test_a_movement_that_is_cut_short_is_told() -> None:
    inward = '<directedmotion direction="i" size="big"/>'
    place = '<location_bodyarm location="chest" contact="close"/>'
    manual = f"<sign_manual>{POINTING_UP}{place}{inward}</sign_manual>"
    assert "# Approximated: a movement that would end in the body ends before it." in _rule(manual)
    assert "Approximated" not in _rule(manual.replace('"i"', '"o"'))


def test_a_hand_that_touches_the_body_stays_where_it_is() -> None:
    hand = Hand(
        None, Heading("i"), Heading("l"), Site("PA", "s"), Place((Site("ST"),), touches=True)
    )
    assert cleared(hand) == hand
    other = Hand(None, Heading("i"), Heading("l"), Site("PA", "s"), Place((Site("PA", "w"),)))
    assert cleared(other) == other


TOLD_CIRCLE = "a circle that would lead into the body"


def _circles(location: str, circles: str, more: str = "") -> str:
    return _rule(f"<sign_manual {more}>{POINTING_UP}{location}{circles}</sign_manual>")


@pytest.mark.parametrize(
    ("location", "circles", "phase"),
    [
        ('location="chest" contact="touch"', 'axis="r"', "'phase, 90"),
        ('location="chest" contact="touch"', 'axis="l"', "'phase, 270"),
        ('location="chest" contact="touch"', 'axis="u"', "'phase, 180"),
        ('location="chest" contact="close"', 'axis="u" size="big"', "'phase, 180"),
        ('location="lips" contact="touch"', 'axis="r" size="small"', "'phase, 90"),
    ],
)
def test_a_circle_that_would_lead_into_the_body_starts_where_it_is_nearest_to_it(
    location: str, circles: str, phase: str
) -> None:
    text = _circles(f"<location_bodyarm {location}/>", f"<circularmotion {circles}/>")
    assert phase in text
    assert f"{TOLD_CIRCLE} starts where it is nearest to it" in text


@pytest.mark.parametrize(
    ("location", "circles", "more"),
    [
        ('location="chest" contact="touch"', 'axis="o"', ""),
        ('location="chest" contact="touch"', 'axis="r" start="d"', ""),
        ('location="chest" contact="touch"', 'axis="r" end="r"', ""),
        ('location="chest" contact="touch"', 'axis="r"', 'both_hands="true" outofphase="true"'),
        ('location="shouldertop" contact="touch"', 'axis="r"', ""),
        ('location="chest" contact="close"', 'axis="r" size="small"', ""),
    ],
)
def test_a_circle_that_stays_outside_or_whose_start_is_told_starts_as_it_is_notated(
    location: str, circles: str, more: str
) -> None:
    text = _circles(f"<location_bodyarm {location}/>", f"<circularmotion {circles}/>", more)
    assert "circle(" in text
    assert TOLD_CIRCLE not in text


def test_a_circle_whose_start_is_told_is_smaller_where_it_would_lead_into_the_body() -> None:
    place = '<location_bodyarm location="chest" contact="close"/>'
    text = _circles(place, '<circularmotion axis="u" size="big" start="u"/>')
    assert f"{TOLD_CIRCLE} is smaller" in text
    assert "'phase" not in text
    before = CircleWay((0.0, 1.0, 0.0), 0.144, 1.0)
    hand = Hand(None, site=Site("PA", "s"), place=Place(offset=(0.0, -0.1, 0.26)))
    way = circle_before_body(before, hand, is_start_told=True)
    assert 0.26 - 2 * way.radius_m == pytest.approx(0.14, abs=0.015)
    near = replace(hand, place=Place(offset=(0.0, -0.1, 0.15)))
    least = circle_before_body(before, near, is_start_told=True)
    assert least.radius_m == pytest.approx(0.4 * before.radius_m)
    far = replace(hand, place=Place(offset=(0.0, -0.1, 0.5)))
    assert circle_before_body(before, far, is_start_told=True) == before


@given(st.tuples(*(st.floats(-1, 1) for _ in range(3))), st.floats(0.5, 2.0), st.integers(0, 359))
def test_from_its_start_a_circle_at_the_chest_only_leads_away_from_it(
    axis: tuple[float, float, float], ratio: float, phase: int
) -> None:
    assume(math.hypot(*axis) > 0.1)
    assume(abs(axis[1]) < 0.999 * math.hypot(*axis))
    hand = Hand(None, site=Site("PA", "s"), place=Place((Site("ST"),), touches=True))
    way = circle_before_body(CircleWay(axis, 0.1, 1.0, phase, ratio), hand)
    start = np.zeros(3)
    points = circle(
        start, start, np.array(axis), 0.1, 1.0, np.linspace(0, 1, 73),
        phase=math.radians(way.phase), ratio=ratio,
    )  # fmt: skip
    assert points[:, 2].min() > -0.0101


def test_thumb_and_index_of_a_bent_pinch_touch() -> None:
    text = _rule('<sign_manual><handconfig handshape="pinch12" mainbend="bent"/></sign_manual>')
    assert "'index_bend s .84 'soft 'index_hook s .31 'soft" in text
    assert "place @T_TIP(s) @I_TIP(s) 'contact" in text
    wide = _rule('<sign_manual><handconfig handshape="pinch12open" mainbend="bent"/></sign_manual>')
    assert "'contact" not in wide


def test_a_hand_that_repeats_a_shape_keeps_its_place() -> None:
    fist = '<tgt_motion><changeposture/><handconfig handshape="fist"/></tgt_motion>'
    text = _rule(
        f'<sign_manual>{POINTING_UP}<location_bodyarm location="chest"/>'
        f'<rpt_motion repetition="fromstart">{fist}</rpt_motion></sign_manual>'
    )
    assert text.count("place @PA(s)") == 1
    hands = text[text.index("'HANDS") : text.index("'P1")]
    assert "place @PA(s)" in hands


@pytest.mark.parametrize(("more", "circles"), [("", 1), ('outofphase="true"', 2)])
def test_only_hands_that_circle_round_each_other_circle_each(more: str, circles: int) -> None:
    """Hands that circle in the same way are carried along by each other."""
    text = _rule(
        f'<sign_manual both_hands="true" {more}>'
        '<handconfig handshape="fist" extfidir="o" palmor="l"/>'
        '<handconstellation contact="touch"><location_hand location="palm"/>'
        '<location_hand location="palm"/></handconstellation>'
        '<circularmotion axis="l"/></sign_manual>'
    )
    assert text.count("circle(") == circles


def test_the_ball_of_the_thumb_is_a_site_of_its_own() -> None:
    text = _rule(
        f'<sign_manual>{POINTING_UP}<location_bodyarm location="chin" contact="touch">'
        '<location_hand location="thumbball"/></location_bodyarm></sign_manual>'
    )
    assert "place @T_BALL(s) @CH 'contact" in text


def test_below_the_chin_is_a_site_of_its_own() -> None:
    assert body_place(OnBody("underchin", contact="touch")) == Place((Site("CHu"),), touches=True)


def test_fingers_that_touch_yield_within_what_notations_distinguish() -> None:
    touching = '<location_bodyarm location="chin" contact="touch"/>'
    assert ":#hamflathand('yield = 20)" in _rule(
        f"<sign_manual>{POINTING_UP}{touching}</sign_manual>"
    )
    out = POINTING_UP.replace("/>", ' thumbpos="out"/>')
    text = _rule(f"<sign_manual>{out}{touching}</sign_manual>")
    assert ":#hamflathand('yield = 20, 'thumb = .thumb-out('yield = 20))" in text
    close = touching.replace("touch", "close")
    assert "'yield" not in _rule(f"<sign_manual>{POINTING_UP}{close}</sign_manual>")


def test_a_thumb_along_the_index_is_the_side_of_its_hand() -> None:
    def placed(thumb: str) -> str:
        hand = POINTING_UP.replace("/>", f"{thumb}/>")
        side = '<location_hand location="thumbside"/>'
        place = f'<location_bodyarm location="shoulders" contact="touch">{side}</location_bodyarm>'
        return _rule(f"<sign_manual>{hand}{place}</sign_manual>")

    assert "place @T_BACK(s, 2) @ST 'contact" in placed("")
    assert "place @I_KNt(s, 1) @ST 'contact" in placed(' thumbpos="out"')


def test_a_hand_in_space_has_a_bound_about_its_place_wherever_it_goes() -> None:
    text = _rule(
        f'<sign_manual>{POINTING_UP}<location_bodyarm location="chest"/>'
        '<directedmotion direction="u"/></sign_manual>'
    )
    assert text.count("place @PA(s) :in-space") == 2
    assert text.count(" 'within .028") == 2


def test_a_thumb_lies_anywhere_on_the_nail_of_the_closed_middle_finger() -> None:
    config = '<handconfig handshape="finger2" {}extfidir="u" palmor="d"/>'
    thumbs = {
        "": ".thumb-rests",
        'thumbpos="across" ': ".thumb-rests",
        'thumbpos="out" ': ".thumb-out",
    }
    for said, written in thumbs.items():
        text = _rule(f"<sign_manual>{config.format(said)}</sign_manual>")
        assert f":#hamfinger2('thumb = {written})" in text


def test_a_hand_that_goes_on_in_circles_goes_one_way() -> None:
    """Onward and round at once: a circle whose end is farther on, and no straight way beside it."""
    text = _rule(
        f"<sign_manual>{POINTING_UP}"
        '<location_bodyarm location="chest"/><par_motion><directedmotion direction="r"/>'
        '<circularmotion axis="o"/></par_motion></sign_manual>'
    )
    assert "transpath @PA(s) circle(" in text
    assert "straight" not in text


def test_a_long_way_with_steps_on_it_is_its_steps() -> None:
    text = _rule(
        f"<sign_manual>{POINTING_UP}"
        '<location_bodyarm location="chest"/><par_motion><directedmotion direction="r"/>'
        '<seq_motion><directedmotion direction="d"/><directedmotion direction="u"/></seq_motion>'
        "</par_motion></sign_manual>"
    )
    assert text.count("transpath @PA(s) straight") == 2


def _ends(inner: str, target: str, more: str = 'both_hands="true" lr_symm="true"') -> str:
    """Return the last posture of a rule that moves, at first as `inner` says, to a target."""
    moves = f"<tgt_motion>{target}</tgt_motion>"
    text = _rule(f"<sign_manual {more}>{POINTING_UP}{inner}{moves}</sign_manual>")
    return text.partition("'P2")[2].partition("'start")[0]


TIPS = '<location_hand location="tip" digits="2"/><location_hand location="tip" digits="2"/>'
AT_SIDES = '<location_bodyarm location="chest" side="right_at"/>'


def test_two_hands_that_go_to_each_other_meet_halfway() -> None:
    text = _ends(
        AT_SIDES,
        '<directedmotion direction="l"/>'
        f'<handconstellation contact="touch">{TIPS}</handconstellation>',
    )
    assert "place @I_TIP(s) @I_TIP(w) 'contact" in text
    assert "place @I_TIP(w) :in-space('side = w, 'up = -.12, 'fwd = .332)" in text


def test_two_hands_that_touch_go_on_together() -> None:
    text = _ends(
        f'<handconstellation contact="touch">{TIPS}<location_bodyarm location="chest"/>'
        "</handconstellation>",
        '<directedmotion direction="o"/>'
        f'<handconstellation contact="touch">{TIPS}</handconstellation>',
    )
    assert "place @I_TIP(w) :in-space('side = w, 'up = -.12, 'fwd = .476)" in text


def test_a_weak_hand_that_rests_is_where_the_hands_meet() -> None:
    text = _ends(
        AT_SIDES,
        '<split_motion><directedmotion direction="l"/><nomotion/></split_motion>'
        f'<handconstellation contact="touch">{TIPS}</handconstellation>',
    )
    assert "place @I_TIP(w) :in-space('side = w, 'out = .139" in text


def test_a_bare_contact_is_of_the_parts_that_were_near_each_other() -> None:
    text = _ends(
        f'<handconstellation contact="close">{TIPS}<location_bodyarm location="head"/>'
        "</handconstellation>",
        '<directedmotion direction="l"/><handconstellation contact="touch"/>',
    )
    assert "place @I_TIP(s) @I_TIP(w) 'contact" in text
    assert ":in-space" not in text


def test_a_bare_contact_of_one_hand_is_with_the_place_that_it_is_at() -> None:
    text = _ends(
        '<location_bodyarm location="chin" contact="close"/>',
        '<directedmotion direction="i"/><handconstellation contact="touch"/>',
        more="",
    )
    assert "place @I_KNt(s, 1) @CH 'contact" in text
    assert "(w" not in text


@pytest.mark.parametrize(
    ("palm", "site"), [("l", "@PA(s)"), ("d", "@I_KNt(s, 1)"), ("r", "@H_BACK(s)")]
)
def test_the_side_of_a_hand_touches_that_looks_at_the_body(palm: str, site: str) -> None:
    """Fingers point to the left: the palm looks back, down or forward."""
    config = f'<handconfig handshape="flat"/><handconfig extfidir="l" palmor="{palm}"/>'
    place = '<location_bodyarm location="chest" contact="touch"/>'
    assert f"place {site} midpoint(@ST, @ABST)" in _rule(
        f"<sign_manual>{config}{place}</sign_manual>"
    )


def test_a_palm_at_the_side_of_the_head_looks_inwards() -> None:
    config = '<handconfig handshape="flat"/><handconfig extfidir="u" palmor="l"/>'
    place = '<location_bodyarm location="cheek" side="right_at" contact="touch"/>'
    assert "place @PA(s) @CK(s)" in _rule(f"<sign_manual>{config}{place}</sign_manual>")


def test_a_hand_that_its_palm_leads_comes_back_by_its_palm() -> None:
    """Else the fingertip would be where it was when the fingers pointed elsewhere."""
    turning = (
        '<par_motion><directedmotion direction="{way}"/><tgt_motion><changeposture/>'
        '<handconfig extfidir="{to}"/></tgt_motion></par_motion>'
    )
    text = _rule(
        f'<sign_manual>{POINTING_UP}<location_bodyarm location="chin" contact="touch">'
        '<location_hand location="tip" digits="2"/></location_bodyarm>'
        f"{turning.format(way='o', to='o')}"
        f'<rpt_motion repetition="fromstart">{turning.format(way="l", to="u")}</rpt_motion>'
        "</sign_manual>"
    )
    assert "@I_TIP(s) :from(" not in text
    assert text.count("shift @PA(s) :way('out = -.144) 'from") == 2
    assert text.count("shift @PA(s) :way('out = .144) 'from") == 1
