"""Notated movements of wrist and fingers as trills.

Cycles, times and angles: the configuration of the engine of JASigning. Nodding is 2 cycles of
.31 s, .5 rad towards the palm and .3 back; swinging .3 and .2 rad; twisting 3 cycles of .4 rad to
either side; stirring nods and swings a quarter of a cycle apart.
"""

from __future__ import annotations

from math import degrees

from azee.lexicon.model import FingerPlay, Wrist
from azee.lexicon.numbers import number
from azee.lexicon.phrase import Tremor
from azee.lexicon.sizes import STEP_S

_CYCLE_S = 1.15 * STEP_S
_SIZES = {None: 1.0, "small": 0.5, "big": 1.5}
_PLAY_S = 2 * STEP_S
_PLAY_DEGREES = 10
_FINGERS = {"2": "index", "3": "middle", "4": "ring", "5": "little"}


def wrist_tremor(move: Wrist, sides: tuple[str, ...], slow: float, alternate: bool) -> list[Tremor]:
    """Return the trills of the hands that a movement of the wrist is."""
    cycles = 3 if move.kind == "twisting" else 2
    length_s = cycles * _CYCLE_S * slow
    found = []
    for name in sides:
        phase = 180 if alternate and name == "w" else 0
        for text in _trills(move, name, cycles, phase):
            found.append(Tremor(0.0, length_s, text))
    return found


def _trills(move: Wrist, name: str, cycles: int, phase: int) -> list[str]:
    size = _SIZES[move.size]
    match move.kind:
        case "nodding":
            return [_trill(name, _nod_axis(name), cycles, 0.5 * size, 0.3 * size, phase)]
        case "swinging":
            return [_trill(name, _swing_axis(name), cycles, 0.3 * size, 0.2 * size, phase)]
        case "twisting":
            axis = f"dir(!palm({name}))"
            return [_trill(name, axis, cycles, 0.4 * size, 0.4 * size, phase)]
        case _:
            quarter = 90 if move.kind == "stircw" else 270
            return [
                _trill(name, _nod_axis(name), cycles, 0.3 * size, 0.3 * size, phase),
                _trill(
                    name, _swing_axis(name), cycles, 0.3 * size, 0.3 * size, (phase + quarter) % 360
                ),
            ]


def _nod_axis(name: str) -> str:
    return f"cross(dir(!palm({name})), nrm(!palm({name})))"


def _swing_axis(name: str) -> str:
    """Return the axis about which a hand swings to the side of its little finger first."""
    normal = f"nrm(!palm({name}))"
    return normal if name == "s" else f"oppvect({normal})"


def _trill(name: str, axis: str, cycles: int, there: float, back: float, phase: int) -> str:
    text = f"trill !palm({name}) {axis} 'cycles {cycles} 'amp {number(degrees(there))}"
    if back != there:
        text += f" 'back {number(degrees(back))}"
    return text + (f" 'phase {phase}" if phase else "")


def finger_play(move: FingerPlay, sides: tuple[str, ...], slow: float) -> list[Tremor]:
    """Return the trills of fingers that move one after the other."""
    length_s = _PLAY_S * slow
    digits = [d for d in move.digits if d in _FINGERS] or list(_FINGERS)
    return [
        Tremor(
            0.0,
            length_s,
            f"trill !{_FINGERS[digit]}({name}, 1) {_nod_axis(name)} 'cycles 2"
            f" 'amp {_PLAY_DEGREES}" + (f" 'phase {90 * i}" if i else ""),
        )
        for name in sides
        for i, digit in enumerate(digits)
    ]
