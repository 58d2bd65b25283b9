"""Registers with IPython how our objects are shown, by class names, without importing them."""

from __future__ import annotations

from typing import Any

SHOWN = {
    ("azee.score.score", "Key"): "score",
    ("azee.score.score", "Hold"): "score",
    ("azee.score.score", "Blank"): "score",
    ("azee.score.score", "Group"): "score",
    ("azee.compilation", "Compilation"): "compilation",
    ("azee.animation", "Animation"): "animation",
    ("azee.clip.clip", "Clip"): "clip",
    ("azee.quality.motion_report", "MotionReport"): "report",
    ("azee_rig.rig", "Rig"): "rig",
}
"""Maps module and name of a class to the function of display.py that shows it."""


def register(ipython: Any) -> None:
    """Let a running IPython show our objects."""
    formatter = ipython.display_formatter.mimebundle_formatter
    for (module, name), function in SHOWN.items():
        formatter.for_type_by_name(module, name, _shower(function))


def _shower(function: str) -> Any:
    def show(shown: object) -> dict[str, str | bytes]:
        from azee.notebook import display

        bundle: dict[str, str | bytes] = getattr(display, function)(shown)
        return bundle

    return show
