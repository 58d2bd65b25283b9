"""Names of the cameras of films and pictures, in a module that is fast to import."""

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
