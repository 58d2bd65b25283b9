"""How like a person's a movement is, in figures: what docs/likeness.md explains.

Each figure is a function of the movement and of what the score asks when; none of them knows how
the movement was made. Lengths are those of a body with shoulders .36 m apart, times are the
score's, and clips are measured at 120 frames/s whatever rate they have.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

from azee.clip.clip import Clip
from azee.motion.tasks.signs import Sign
from azee.quality.head_and_gaze import (
    HeadUnderGaze,
    head_under_gaze,
    longest_far_gaze_s,
    trunk_displacement,
)
from azee.quality.joints import (
    AtLimits,
    UnaskedTurn,
    at_limits,
    largest_joint_speed,
    longest_stillness_s,
    unasked_turns,
)
from azee.quality.kinematics import Extreme, Kinematics
from azee.quality.repetitions import Repetition, repetitions
from azee.quality.rhythm import Blinks, blinks, signs_of, signs_per_s
from azee.quality.signing_dynamics import FPS, SigningDynamics, signing_dynamics
from azee.quality.symmetry import elbow_asymmetry_cm
from azee.quality.task_spans import TaskSpan
from azee.quality.transitions import Transition, correlation, transitions
from azee.quality.wrists import (
    WristBend,
    largest_wrist_acceleration,
    largest_wrist_speed,
    wrist_bend,
)
from azee.score.score import Score
from azee_rig.rig import Rig
from azee_solver.geometry import Side


@dataclass(frozen=True, slots=True)
class Likeness:
    """The figures of one clip; none where a clip has nothing to measure."""

    transitional_wrist_speed_m_s: Extreme | None
    transitional_wrist_acceleration_m_s2: Extreme | None
    lexical_wrist_speed_m_s: Extreme | None
    lexical_wrist_acceleration_m_s2: Extreme | None
    arm_speed_deg_s: Extreme | None
    trunk_speed_deg_s: Extreme | None
    head_speed_deg_s: Extreme | None
    finger_speed_deg_s: Extreme | None
    unasked_turns: tuple[UnaskedTurn, ...]
    transitions: tuple[Transition, ...]
    transition_correlation: float | None
    onset_spread_ms: float | None
    head_longest_still_s: float
    trunk_longest_still_s: float
    body_longest_still_s: float
    dynamics: SigningDynamics
    at_limits: AtLimits
    trunk_displacement_deg: Extreme
    wrists: WristBend
    head_under_gaze: HeadUnderGaze
    longest_far_gaze_s: float
    elbow_asymmetry_cm: Extreme | None
    signs: tuple[Sign, ...]
    signs_per_s: float | None
    blinks: Blinks
    repetitions: tuple[Repetition, ...]

    def as_json(self) -> dict[str, object]:
        """Return it as the report's JSON has it."""
        return asdict(self)


def likeness(
    clip: Clip,
    rig: Rig,
    score: Score,
    spans: Sequence[TaskSpan],
    *,
    zero_s: float = 0.0,
    dominant: Side = Side.RIGHT,
) -> Likeness:
    """Measure a clip.

    Args: spans: what the score asks of this body. zero_s: when the score's time line starts in
        the clip.
    """
    k = Kinematics.of(clip, rig, zero_s)
    moves = transitions(k, spans)
    found = signs_of(score, spans)
    spreads = sorted(t.onset_spread_ms for t in moves if t.onset_spread_ms is not None)
    return Likeness(
        transitional_wrist_speed_m_s=largest_wrist_speed(k, spans, "transitional"),
        transitional_wrist_acceleration_m_s2=largest_wrist_acceleration(k, spans, "transitional"),
        lexical_wrist_speed_m_s=largest_wrist_speed(k, spans, "lexical"),
        lexical_wrist_acceleration_m_s2=largest_wrist_acceleration(k, spans, "lexical"),
        arm_speed_deg_s=largest_joint_speed(k, "arm"),
        trunk_speed_deg_s=largest_joint_speed(k, "trunk"),
        head_speed_deg_s=largest_joint_speed(k, "head"),
        finger_speed_deg_s=largest_joint_speed(k, "fingers"),
        unasked_turns=unasked_turns(k, spans),
        transitions=moves,
        transition_correlation=correlation(moves),
        onset_spread_ms=spreads[len(spreads) // 2] if spreads else None,
        head_longest_still_s=longest_stillness_s(k, "head"),
        trunk_longest_still_s=longest_stillness_s(k, "trunk"),
        body_longest_still_s=longest_stillness_s(k, "body"),
        dynamics=signing_dynamics(Kinematics.of(clip, rig, zero_s, FPS).frontal, FPS),
        at_limits=at_limits(k),
        trunk_displacement_deg=trunk_displacement(k),
        wrists=wrist_bend(k),
        head_under_gaze=head_under_gaze(k, spans),
        longest_far_gaze_s=longest_far_gaze_s(k),
        elbow_asymmetry_cm=elbow_asymmetry_cm(k, spans, dominant),
        signs=found,
        signs_per_s=signs_per_s(found),
        blinks=blinks(k, found),
        repetitions=repetitions(k, spans),
    )
