"""The figures of likeness as columns of a table, and what each should be for a person."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from azee.quality.kinematics import Extreme
from azee.quality.likeness import Likeness

Values = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Figure:
    """A column: one value of a clip, or several that all should keep the bounds.

    unit: printed after the title. digits: after the point. signs: a clip of fewer is not judged.
    """

    title: str
    unit: str
    read: Callable[[Likeness], Values]
    digits: int = 0
    at_least: float | None = None
    at_most: float | None = None
    signs: int = 0

    @property
    def target(self) -> str:
        """The bounds as the table has them."""
        low, high = (None if v is None else f"{v:g}" for v in (self.at_least, self.at_most))
        if low is None:
            return "" if high is None else f"≤ {high}"
        return f"≥ {low}" if high is None else f"{low}–{high}"

    def kept(self, values: Sequence[float]) -> bool:
        """Whether values keep the bounds."""
        low = -float("inf") if self.at_least is None else self.at_least
        high = float("inf") if self.at_most is None else self.at_most
        return all(low <= v <= high for v in values)

    def judged(self, likeness: Likeness) -> bool | None:
        """Whether a clip keeps the bounds, none if there is nothing to judge."""
        values = self.read(likeness)
        if not self.target or not values or len(likeness.signs) < self.signs:
            return None
        return self.kept(values)

    def text(self, values: Sequence[float]) -> str:
        """The values as the table has them: one, or the least and the largest."""
        shown = dict.fromkeys(f"{v:.{self.digits}f}" for v in (min(values), max(values)))
        return "–".join(shown)

    def beyond(self, values: Sequence[float]) -> float:
        """By how much values miss the bounds, at the worst; none is below 0."""
        low = 0.0 if self.at_least is None else self.at_least - min(values)
        high = 0.0 if self.at_most is None else max(values) - self.at_most
        return max(low, high)


def _value(extreme: Extreme | None, factor: float = 1.0) -> Values:
    return () if extreme is None else (extreme.value * factor,)


def _of(value: float | None, factor: float = 1.0) -> Values:
    return () if value is None else (value * factor,)


FIGURES = (
    Figure(
        "wrist between signs", "m/s", lambda f: _value(f.transitional_wrist_speed_m_s), 2,
        at_most=2.5,
    ),
    Figure(
        "its acceleration", "m/s²", lambda f: _value(f.transitional_wrist_acceleration_m_s2),
        at_most=40.0,
    ),
    Figure("wrist inside signs", "m/s", lambda f: _value(f.lexical_wrist_speed_m_s), 2),
    Figure("arm joints", "°/s", lambda f: _value(f.arm_speed_deg_s), at_most=600.0),
    Figure("turns not asked for", "", lambda f: (float(len(f.unasked_turns)),)),
    Figure(
        "time with distance", "r", lambda f: _of(f.transition_correlation), 2, at_least=0.5
    ),
    Figure("onsets in an arm", "ms", lambda f: _of(f.onset_spread_ms), at_least=20, at_most=80),
    Figure("head still", "s", lambda f: (f.head_longest_still_s,), 2, at_most=0.1),
    Figure("trunk still", "s", lambda f: (f.trunk_longest_still_s,), 2, at_most=0.1),
    Figure("body still", "s", lambda f: (f.body_longest_still_s,), 2),
    Figure(
        "head", "cm/s", lambda f: _of(f.dynamics.head_mean_cm_s), 1, at_least=1.0, at_most=6.0
    ),
    Figure(
        "hands stopped", "%", lambda f: _of(f.dynamics.both_stopped_share, 100.0),
        at_least=10.0, at_most=45.0, signs=2,
    ),
    Figure("at limits", "%", lambda f: (100.0 * f.at_limits.share,), 1, at_most=0.0),
    Figure("trunk", "°", lambda f: _value(f.trunk_displacement_deg), 1),
    Figure("wrist bent", "°", lambda f: _value(f.wrists.largest_deg)),
    Figure("beyond 35°", "%", lambda f: (100.0 * f.wrists.beyond_share,)),
    Figure("roll under gaze", "°", lambda f: _value(f.head_under_gaze.roll_deg), 1, at_most=5.0),
    Figure("head back", "s", lambda f: _of(f.head_under_gaze.return_s), 2, at_most=0.3),
    Figure("eyes beyond 20°", "s", lambda f: (f.longest_far_gaze_s,), 2, at_most=0.3),
    Figure("elbows", "cm", lambda f: _value(f.elbow_asymmetry_cm), 1, at_most=2.0),
    Figure(
        "repetition", "%", lambda f: tuple(r.difference_percent for r in f.repetitions), 1,
        at_least=2.0, at_most=8.0,
    ),
    Figure("signs", "1/s", lambda f: _of(f.signs_per_s), 2),
    Figure("blinks", "1/min", lambda f: (f.blinks.per_minute,)),
    Figure("at boundaries", "%", lambda f: _of(f.blinks.at_boundaries_share, 100.0)),
)  # fmt: skip
