"""Signs in both notations: symbols of HamNoSys by name, and the manual part of gestural SiGML."""

from __future__ import annotations

from azee.lexicon.hamnosys_symbols import SYMBOLS


def symbols(names: str) -> str:
    """The symbols of names that are written apart, without their `ham`."""
    return "".join(SYMBOLS[name] for name in names.split())


def sigml(manual: str) -> bytes:
    """A document of one sign with that manual part."""
    return f'<sigml><hamgestural_sign gloss="PAIR">{manual}</hamgestural_sign></sigml>'.encode()


PAIRS = {
    "one hand, a straight movement": (
        "finger2 extfingeru palml shoulders lrat moveo largemod fast",
        """<sign_manual><handconfig handshape="finger2"/><handconfig extfidir="u" palmor="l"/>
        <location_bodyarm location="shoulders" side="right_at"/>
        <directedmotion direction="o" size="big" fast="true"/></sign_manual>""",
    ),
    "mirrored hands that touch, an arc to another posture": (
        (
            "symmlr flathand extfingerul palmdr parbegin indexfinger fingertip plus indexfinger"
            " fingertip parend touch shouldertop parbegin movedr smallmod arcu replace extfingero"
            " palml parend"
        ),
        """<sign_manual both_hands="true" lr_symm="true"><handconfig handshape="flat"/>
        <handconfig extfidir="ul"/><handconfig palmor="dr"/>
        <handconstellation contact="touch"><location_hand digits="2" location="tip"/>
        <location_hand digits="2" location="tip"/><location_bodyarm location="shouldertop"/>
        </handconstellation><par_motion><directedmotion curve="u" direction="dr" size="small"/>
        <tgt_motion><changeposture/><handconfig extfidir="o" palmor="l"/></tgt_motion>
        </par_motion></sign_manual>""",
    ),
    "alternating circles, repeated": (
        (
            "symmlr alternatingmotion fist thumbacrossmod extfingero palmd close shoulders between"
            " chest close circlel smallmod repeatfromstart"
        ),
        """<sign_manual both_hands="true" lr_symm="true" outofphase="true">
        <handconfig handshape="fist" thumbpos="across"/><handconfig extfidir="o"/>
        <handconfig palmor="d"/><handconstellation contact="close">
        <location_bodyarm contact="close" location="shoulders" second_location="chest"/>
        </handconstellation><rpt_motion repetition="fromstart">
        <circularmotion axis="l" size="small"/></rpt_motion></sign_manual>""",
    ),
    "a hand between two shapes at the chin": (
        (
            "finger2 fingerstraightmod thumbacrossmod between finger2 thumbacrossmod extfingerul"
            " palmd indexfinger fingermidjoint chin between lips touch mover smallmod"
        ),
        """<sign_manual><handconfig handshape="finger2" mainbend="bent" thumbpos="across"
        second_handshape="finger2" second_thumbpos="across"/><handconfig extfidir="ul"/>
        <handconfig palmor="d"/><location_bodyarm contact="touch" location="chin"
        second_location="lips"><location_hand digits="2" location="midjoint"/>
        </location_bodyarm><directedmotion direction="r" size="small"/></sign_manual>""",
    ),
    "two different hands, one on the other": (
        (
            "parbegin flathand extfingerol palmd plus fist extfingero palml parend"
            " parbegin palm plus pinkyside parend touch chest close"
            " parbegin moved plus nomotion parend"
        ),
        """<sign_manual><split_handconfig><handconfig handshape="flat"/>
        <handconfig handshape="fist"/></split_handconfig>
        <split_handconfig><handconfig extfidir="ol" palmor="d"/>
        <handconfig extfidir="o" palmor="l"/></split_handconfig>
        <handconstellation contact="touch"><location_hand location="palm"/>
        <location_hand location="pinkyside"/>
        <location_bodyarm location="chest" contact="close"/></handconstellation>
        <split_motion><directedmotion direction="d"/><nomotion/></split_motion></sign_manual>""",
    ),
    "fingers that play while a hand nods, then another shape": (
        (
            "pinch12open extfingeruo palml neck fingerplay nodding largemod replace finger2345"
            " extfingeru palml"
        ),
        """<sign_manual><handconfig handshape="pinch12open"/>
        <handconfig extfidir="uo" palmor="l"/><location_bodyarm location="neck"/>
        <fingerplay/><wristmotion motion="nodding" size="big"/>
        <tgt_motion><changeposture/><handconfig handshape="finger2345" extfidir="u" palmor="l"/>
        </tgt_motion></sign_manual>""",
    ),
    "movements in turn, several times, slow, with clock hours": (
        (
            "fist extfingeru palmd stomach seqbegin moveu arcr smallmod moved seqend"
            " repeatfromstartseveral circleo clockr clockd slow"
        ),
        """<sign_manual><handconfig handshape="fist"/><handconfig extfidir="u" palmor="d"/>
        <location_bodyarm location="stomach"/>
        <rpt_motion repetition="fromstart_several"><seq_motion>
        <directedmotion direction="u" curve="r" curve_size="small"/>
        <directedmotion direction="d"/></seq_motion></rpt_motion>
        <circularmotion axis="o" start="r" end="d" slow="true"/></sign_manual>""",
    ),
    "the weak hand alone, between two places": (
        (
            "nondominant cee12open extfingerul between extfingeru palmu between palmul"
            " lrbeside chest between lrat stomach"
        ),
        """<sign_manual nondominant="true"><handconfig handshape="cee12open"/>
        <handconfig extfidir="ul" second_extfidir="u" palmor="u" second_palmor="ul"/>
        <location_bodyarm location="chest" side="left_beside" second_location="stomach"
        second_side="left_at"/></sign_manual>""",
    ),
}
