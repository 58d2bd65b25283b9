"""The symbols of HamNoSys 4 in the private area of Unicode, by the names that SiGML gives them.

Code points and names: the font HamNoSysUnicode of the University of Hamburg (Schulder and Hanke
2022, package `hamnosys` of CTAN).
"""

from __future__ import annotations

from azee.lexicon.codeset import words

FIRST, LAST = 0xE000, 0xE0F1
_ROWS: tuple[tuple[int, str], ...] = (
    (0xE000, "fist flathand finger2 finger23 finger23spread finger2345 pinch12 pinchall"),
    (0xE008, "pinch12open cee12 ceeall ceeopen thumboutmod thumbacrossmod thumbopenmod"),
    (0xE010, "fingerstraightmod fingerbendmod fingerhookmod doublebent doublehooked"),
    (0xE020, "extfingeru extfingerur extfingerr extfingerdr extfingerd extfingerdl extfingerl"),
    (0xE027, "extfingerul extfingerol extfingero extfingeror extfingeril extfingeri extfingerir"),
    (0xE02E, "extfingerui extfingerdi extfingerdo extfingeruo"),
    (0xE038, "palmu palmur palmr palmdr palmd palmdl palml palmul"),
    (0xE040, "head headtop forehead eyebrows eyes nose nostrils ear earlobe cheek lips tongue"),
    (0xE04C, "teeth chin underchin neck shouldertop shoulders chest stomach belowstomach"),
    (0xE058, "lrbeside lrat coreftag corefref"),
    (0xE05F, "neutralspace upperarm elbow elbowinside lowerarm wristback wristpulse thumbball"),
    (0xE067, "palm handback thumbside pinkyside"),
    (0xE070, "thumb indexfinger middlefinger ringfinger pinky fingertip fingernail fingerpad"),
    (0xE078, "fingermidjoint fingerbase fingerside"),
    (0xE07C, "wristtopulse wristtoback wristtothumb wristtopinky"),
    (0xE080, "moveu moveur mover movedr moved movedl movel moveul moveol moveo moveor moveil"),
    (0xE08C, "movei moveir moveui movedi movedo moveuo"),
    (0xE092, "circleo circlei circled circleu circlel circler circleul circledr circleur"),
    (0xE09B, "circledl circleol circleir circleor circleil circleui circledo circleuo circledi"),
    (0xE0A4, "fingerplay nodding swinging twisting stircw stirccw replace"),
    (0xE0AD, "movecross movex nomotion"),
    (0xE0B0, "clocku clockul clockl clockdl clockd clockdr clockr clockur clockfull"),
    (0xE0B9, "arcl arcu arcr arcd wavy zigzag"),
    (0xE0C0, "ellipseh ellipseur ellipsev ellipseul increasing decreasing smallmod largemod"),
    (0xE0C8, "fast slow tense rest halt"),
    (0xE0D0, "close touch interlock cross armextended behind brushing"),
    (0xE0D8, "repeatfromstart repeatfromstartseveral repeatcontinue repeatcontinueseveral"),
    (0xE0DC, "repeatreverse alternatingmotion"),
    (0xE0E0, "seqbegin seqend parbegin parend fusionbegin fusionend between plus symmpar symmlr"),
    (0xE0EA, "nondominant nonipsi etc orirelative"),
    (0xE0F0, "mime version40"),
)

NAMES = {chr(first + i): name for first, row in _ROWS for i, name in enumerate(row.split())}
"""The names of symbols, without the `ham` that SiGML puts before them."""
SYMBOLS = {name: symbol for symbol, name in NAMES.items()} | {
    "cee12open": chr(0xE00B),
    "moveX": chr(0xE0AE),
}
"""The symbols of names."""
NOT_READ = words("coreftag corefref mime version40 etc nonipsi orirelative")
"""Symbols that say nothing of the form of a sign, or what it refers to; they are skipped."""


def is_symbol(character: str) -> bool:
    """Whether a character is in the range of HamNoSys."""
    return FIRST <= ord(character) <= LAST


def title(symbol: str) -> str:
    """Return the name of a symbol as SiGML has it."""
    return f"ham{NAMES.get(symbol, f'? (U+{ord(symbol):04X})')}"
