"""Face units as expressions of VRM: presets where one means the same, else custom ones by name."""

from __future__ import annotations

PRESETS = {
    "eyeBlinkLeft": "blinkLeft",
    "eyeBlinkRight": "blinkRight",
    "mh_eye-left-closure": "blinkLeft",
    "mh_eye-right-closure": "blinkRight",
    "jawOpen": "aa",
    "mouthPucker": "ou",
    "mouthFunnel": "oh",
}
"""Presets of VRM by face unit. Two units that close an eye are one preset: their sum."""
EYE_UNITS = "eyeLook"
"""Units that move lids with the eyes: an avatar does so by itself, in following `lookAt`."""


def expression(unit: str) -> tuple[str, str]:
    """Return the kind and the name of the expression that a face unit is: preset or custom."""
    preset = PRESETS.get(unit)
    return ("custom", unit) if preset is None else ("preset", preset)
