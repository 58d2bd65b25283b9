"""Numbers on the command line."""

from __future__ import annotations

import math
import re
from typing import Any

import click


class Number(click.FloatRange):
    """A number in a range; NaN, which click finds in every range, is none."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """Return the number. Raises: click.BadParameter: it is none, or out of the range."""
        number = float(super().convert(value, param, ctx))
        if math.isnan(number):
            self.fail("it is not a number", param, ctx)
        return number


class Seconds(Number):
    """A time or duration, as a number or with its unit: 1.2, 1.2s, .6s."""

    name = "time"
    _WRITTEN = re.compile(
        r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)\s*s?\s*", re.ASCII | re.IGNORECASE
    )

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """Return the seconds. Raises: click.BadParameter: it is no time, or out of the range."""
        if isinstance(value, str):
            written = self._WRITTEN.fullmatch(value)
            if written is None:
                self.fail(f"`{value}` is no time in seconds such as 1.2 or 1.2s", param, ctx)
            value = written[1]
        return super().convert(value, param, ctx)
