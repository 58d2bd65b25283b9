"""What is not of the hands as AZee: mouth, brows, lids, gaze, head, trunk, shoulders.

The codes are those of gestural SiGML's non-manual tiers; the weights are ours.
"""

from __future__ import annotations

import re

from azee.lexicon.hand_text import Told
from azee.lexicon.model import NonManual, Tier
from azee_grammar.sounds import UnknownSoundError, sounds_of

_SOUND = re.compile(r"[^\s\"_]:?")
"""A sound of SAMPA as lexicons write it, perhaps long; `_` only joins two to one."""

_TIERS: dict[str, dict[str, str]] = {
    "head": {
        "SH": "trill !head ^up 'cycles 3 'amp 14",
        "NO": "trill !head ^left 'cycles 2 'amp 12 'back 4",
        "NF": "rotate !head ^left 15",
        "NB": "rotate !head ^left -15",
        "SL": "rotate !head ^up 25",
        "SR": "rotate !head ^up -25",
        "TL": "rotate !head ^fwd -12",
        "TR": "rotate !head ^fwd 12",
        "PF": "rotate !neck ^left 10",
        "PB": "rotate !neck ^left -10",
    },
    "body": {
        "TB": "rotate !back_2 ^left -6",
        "TF": "rotate !back_2 ^left 6",
        "TL": "rotate !back_2 ^fwd -6",
        "TR": "rotate !back_2 ^fwd 6",
        "RL": "rotate !back_2 ^up 12",
        "RR": "rotate !back_2 ^up -12",
        "SI": "morph 'shoulder_raise L .4 'shoulder_raise R .4",
    },
    "brows": {"RB": "morph 'AU1 .7 'AU2 .7", "FU": "morph 'AU4 .8"},
    "lids": {
        "WB": "morph 'AU5 .8",
        "SB": "morph 'AU43 .5",
        "TB": "morph 'AU43 1 'AU6 .5",
        "CB": "morph 'AU43 1",
    },
    "gaze": {
        "AD": "lookat ^addressee",
        "FR": "look ^fwd",
        "DN": "look vec(0, -.5, 1)",
        "UP": "look vec(0, .5, 1)",
        "LE": "look vec(.5, 0, 1)",
        "RI": "look vec(-.5, 0, 1)",
        "RD": "look vec(-.4, -.4, 1)",
        "LD": "look vec(.4, -.4, 1)",
        "RU": "look vec(-.4, .4, 1)",
        "LU": "look vec(.4, .4, 1)",
    },
    "shoulders": {
        "UB": "morph 'shoulder_raise L .7 'shoulder_raise R .7",
        "UR": "morph 'shoulder_raise R .7",
        "UL": "morph 'shoulder_raise L .7",
        "HR": "morph 'shoulder_shrug R .6",
        "HL": "morph 'shoulder_shrug L .6",
        "HB": "morph 'shoulder_shrug R .6 'shoulder_shrug L .6",
        "SB": "morph 'shoulder_shrug R .6 'shoulder_shrug L .6",
    },
}
_NEUTRAL = {("body", "ST")}
"""Codes of what a body does anyway."""
_MOUTH = {
    "C01": "morph 'AU34 .9",
    "C02": "morph 'AU34 .8 'AU18 .2",
    "C03": "morph 'AU34 .9",
    "C04": "morph 'AU34 .6",
    "C05": "morph 'AU34 .6",
    "C06": "morph 'AU34 .5",
    "C07": "morph 'AU35 .9",
    "C08": "morph 'AU35 .8 'AU18 .4",
    "D01": "morph 'AU25 .6 'AU20 .5 'AU10 .2",
    "D02": "morph 'AU28_bottom .6 'AU25 .2",
    "D03": "morph 'AU28_bottom .6 'AU25 .2",
    "D07": "morph 'AU25 .4 'AU32 .5",
    "J03": "morph 'AU26 .4 'AU25 .6 'AU29 .7",
    "L01": "morph 'AU22_25_up_down .7",
    "L02": "morph 'AU33 .6 'AU25 .2",
    "L03": "morph 'AU33 .6 'AU25 .2",
    "L04": "morph 'AU18 .7",
    "L05": "morph 'AU26 .6 'AU25 .8 'AU18 .4",
    "L06": "morph 'AU18 .8 'AU25 .3",
    "L07": "morph 'AU26 .5 'AU25 .7 'AU18 .3",
    "L12": "morph 'AU25 .5 'AU20 .4",
    "L18": "morph 'AU24 .6",
    "L19": "morph 'AU18 .6 'AU25 .4 'AU33 .3",
    "L20": "morph 'AU33 .8 'AU18 .3",
    "L21": "morph 'AU33 .5",
    "L22": "morph 'AU33 .8",
    "L23": "morph 'AU24 .5",
    "L24": "morph 'AU24 .7",
    "L25": "morph 'AU24 .6",
    "L29": "morph 'AU28 .5 'AU15 .6",
    "L30": "morph 'AU18 .5 'AU15 .7",
    "L31": "morph 'AU15 .8",
    "L34": "morph 'AU20 .6 'AU24 .4",
    "T01": "morph 'AU25 .5 'AU26 .3 'tongue_up .7",
    "T02": "morph 'AU25 .4 'AU26 .2 'tongue_out .4",
    "T03": "morph 'AU25 .5 'AU26 .3 'tongue_up .7",
    "T04": "morph 'AU26 .4 'AU25 .6 'tongue_out .8",
    "T05": "morph 'AU26 .6 'AU25 .8 'tongue_out .7",
    "T06": "morph 'AU26 .4 'AU25 .6 'tongue_out .8",
    "T12": "morph 'AU25 .4 'tongue_out .5",
    "T13": "morph 'AU25 .5 'AU26 .3 'tongue_wide .5",
    "T16": "morph 'AU18 .7 'tongue_out .5 'AU25 .3",
    "T17": "morph 'AU26 .4 'AU25 .6 'tongue_out .6",
}


def sampa(mouthing: str, told: Told) -> str:
    """Return the sounds of a text in SAMPA, without those that AZee does not know."""
    kept = ""
    for sound in _SOUND.findall(mouthing):
        try:
            sounds_of(kept + sound)
        except UnknownSoundError:
            told("sound", f"the sound `{sound.strip()}` has no shape of the mouth")
        else:
            kept += sound
    return kept if kept and sounds_of(kept) else ""


def gesture(nonmanual: NonManual, told: Told) -> str | None:
    """Return the shape of a gesture of the mouth, where nothing is mouthed."""
    for tier in nonmanual.tiers:
        if tier.name == "mouth":
            shape = _MOUTH.get(tier.code)
            if shape is None:
                told("mouth-gesture", f"the gesture {tier.code} of the mouth is not written")
            return shape
    return None


def others(nonmanual: NonManual, told: Told) -> list[str]:
    """Return constraints for head, trunk, shoulders, brows, lids and gaze, one for each."""
    found: dict[str, str] = {}
    for tier in nonmanual.tiers:
        if tier.name == "mouth" or (tier.name, tier.code) in _NEUTRAL:
            continue
        text = _TIERS.get(tier.name, {}).get(tier.code)
        if text is None:
            told(f"{tier.name}-not-written", f"{_described(tier)} is not written")
        elif tier.name in found:
            told("several-in-turn", f"of several movements of the {tier.name} the first is written")
        else:
            found[tier.name] = text
    return list(found.values())


def _described(tier: Tier) -> str:
    return f"{tier.code} of the {tier.name}"
