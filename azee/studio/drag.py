"""What a page may ask of a posing session, checked where it comes in."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from azee.studio.folder import RefusedError
from azee.studio.job import MOST_NUMBER

ACTS = {"open": (), "drag": ("handle", "target"), "release": ("handle",),
        "propose": ("handle",), "close": ()}  # fmt: skip
LONGEST_HANDLE = 80
"""Characters; a handle is the text of a part of the body."""


def read_act(message: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a message asks for: `act`, `session`, `serial` and what the act needs.

    Raises: RefusedError: a field is missing, or has a wrong type or value.
    """
    act = message.get("act")
    if not isinstance(act, str) or act not in ACTS:
        raise RefusedError(400, "there is no such act")
    asked: dict[str, Any] = {"act": act}
    for name in ("session", "serial"):
        number = message.get(name)
        if type(number) is not int or not 0 <= number <= MOST_NUMBER:
            raise RefusedError(400, f"`{name}` is no number")
        asked[name] = number
    if act == "open":
        asked["at_s"] = _number(message.get("at_s"))
    if "handle" in ACTS[act]:
        handle = message.get("handle")
        if not isinstance(handle, str) or not 0 < len(handle) <= LONGEST_HANDLE:
            raise RefusedError(400, "`handle` is missing")
        asked["handle"] = handle
    if "target" in ACTS[act]:
        target = message.get("target")
        if not isinstance(target, list) or len(target) not in (1, 3):
            raise RefusedError(400, "`target` is no point and no weight")
        asked["target"] = [*map(_number, target)]
    return asked


def _number(value: object) -> float:
    """Return a finite number. Raises: RefusedError: it is none."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise RefusedError(400, "that is no number")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise RefusedError(400, "that is no number")
    return number
