"""Names of the cameras of films and pictures; light, for whoever only lists them."""

SHOTS = (
    "front",
    "side",
    "three-quarter",
    "face",
    "hands",
    "right hand",
    "left hand",
    "whole",
    "back",
)
