"""Checks the arguments of the library; a message says what is allowed."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from contextlib import suppress
from fractions import Fraction
from numbers import Integral, Real
from pathlib import Path
from reprlib import repr as shown
from typing import TypeGuard, cast

SLOWEST_FPS = 1.0
"""Fewer frames a second show no movement."""
SLOWEST_TEMPO, FASTEST_TEMPO = 0.1, 10.0
"""Factors of speed beyond which nothing is left of a sign."""


def require_one_of(value: object, known: Sequence[str], one: str, all_of_them: str) -> None:
    """Require one of the known names. Raises: ValueError."""
    if not (isinstance(value, str) and value in known):
        names = ", ".join(known)
        raise ValueError(f"there is no {one} {shown(value)}; the {all_of_them} are: {names}")


def rate(value: object) -> float:
    """Return a number of frames per second; fractions stay exact. Raises: ValueError."""
    with suppress(OverflowError):
        if _is_number(value) and SLOWEST_FPS <= float(value) < math.inf:
            exact = isinstance(value, int | float | Fraction)
            return cast("float", value) if exact else float(value)
    told = f"{shown(value)} frames per second make no clip"
    raise ValueError(f"{told}; fps is a number from 1 on, such as 25 or 30")


def require_tempo(value: object) -> None:
    """Require a factor of speed. Raises: ValueError."""
    if not (_is_number(value) and SLOWEST_TEMPO <= float(value) <= FASTEST_TEMPO):
        raise ValueError(
            f"nobody signs {shown(value)} times as fast; tempo is a number "
            f"from {SLOWEST_TEMPO:g} to {FASTEST_TEMPO:g}, such as 1.2"
        )


def require_seed(value: object) -> None:
    """Require a seed of random numbers, None for that of the score. Raises: ValueError."""
    if value is not None and not (_is_whole(value) and int(value) >= 0):
        raise ValueError(f"the seed is a whole number from 0 on, not {shown(value)}")


def require_switch(value: object, name: str) -> None:
    """Require True or False. Raises: ValueError."""
    if not isinstance(value, bool):
        raise ValueError(f"{name} is True or False, not {shown(value)}")


def require_text(text_or_path: object, expression: object, utterance: object) -> None:
    """Require a text, an expression or both, and at most one choice of them. Raises: ValueError."""
    if text_or_path is None and expression is None:
        raise ValueError(
            "there is nothing to compile: give a text, a path, or an expression, "
            "as in azee.compile(expression=':arbre')"
        )
    if not isinstance(text_or_path, str | os.PathLike | None):
        raise ValueError(f"a text is a str, and a path a str or a Path, not {shown(text_or_path)}")
    if not isinstance(expression, str | None):
        raise ValueError(f"an expression is a str such as ':arbre', not {shown(expression)}")
    if utterance is None:
        return
    if expression is not None:
        raise ValueError("utterance counts the text's own and does not go with expression")
    if not _is_whole(utterance):
        raise ValueError(
            f"utterance is a whole number from 1 on, or None for all, not {shown(utterance)}"
        )


def folders(value: object) -> list[Path]:
    """Return folders of libraries as paths. Raises: ValueError: also if one does not exist."""
    if isinstance(value, str | os.PathLike):
        raise ValueError(f"libraries are a list of folders, as in libraries=['{value}']")
    if isinstance(value, bytes) or not isinstance(value, Sequence):
        raise ValueError(f"libraries are a list of folders, not {shown(value)}")
    found = []
    for folder in value:
        if not isinstance(folder, str | os.PathLike):
            raise ValueError(f"a folder of libraries is a str or a Path, not {shown(folder)}")
        found.append(_existing(Path(folder)))
    return found


def _existing(folder: Path) -> Path:
    with suppress(OSError):  # such as a name that is too long
        if folder.is_dir():
            return folder
        if folder.exists():
            raise ValueError(f"libraries are in folders, and `{folder}` is a file")
    raise ValueError(f"there is no folder `{folder}` to look for libraries in")


def _is_number(value: object) -> TypeGuard[Real]:
    """Whether a value is a number of Python or numpy; True and False are not."""
    return isinstance(value, Real) and not isinstance(value, bool)


def _is_whole(value: object) -> TypeGuard[Integral]:
    return isinstance(value, Integral) and not isinstance(value, bool)
