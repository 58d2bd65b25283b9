"""What a problem's block of words holds, and the numbers that name it for Python and for kernels.

All that a problem is lies in one block of eight-byte words that `layout` lays out, read as
integers or as reals; the first words say where each section starts.
"""

from __future__ import annotations

# Operations of a tape; its table is in `tape`.
CONSTANT, POINT, VECTOR, COMBINE, UNIT, CROSS, TURN = range(7)

# Kinds of residual.
MEET, AT_DISTANCE, PERPENDICULAR = range(3)

# Sections of integers, then of reals; word s of a block says where section s starts. What is
# needed only while working stands last and is never set up.
(
    SIZE,
    COUNT,
    ROUNDS,
    PARENTS,
    DOF_START,
    DOF_AXIS,
    DOF_COORDINATE,
    ACTIVE,
    FREE,
    COLUMN,
    FOLLOWED,
    CODES,
    ROWS,
    CAPSULE_NODE,
    PAIRS,
    BALL_NODE,
    RUNS,
    Q,
    OFFSETS,
    ZERO,
    DOF_SCALE,
    NUMBERS,
    ROW_NUMBERS,
    CAPSULE_ENDS,
    PAIR_REACH,
    BALLS,
    RUN_REACH,
    POSTURE,
    BOUNDS,
    MISS_SHARE,
    OVERLAP_WEIGHT,
    TOLERANCE,
    DAMPING,
    POSITIONS,
    ROTATIONS,
    AXES,
    DEEPEST,
    BEST,
    FORCES,
    MOMENTS,
    VALUES,
    PULLS,
    ENDS,
    CENTRES,
    CONTACTS,
    PULL_ON_Q,
    SLOPES,
    HESSIAN,
    FACTOR,
    VECTORS,
    SECTIONS_END,
) = range(51)

COMFORTABLE = 0.8
"""Part of a coordinate's range, about its middle, that costs nothing."""

FOLLOWING = 2.0 / 3.0
"""Angle of a finger's last joint over that of the one before (Rijpkema and Girard 1991)."""

SHORT = 1e-12

FIRST_DAMPING, MOST_DAMPING = 1e-4, 1e6
"""Of Gauss-Newton steps: at first, as parts of the curvature, and where they are given up."""

UNDEFINED = 1e300
"""Stands for NaN, so that a line search backs off."""

BAND_PAD = 8
"""Rows of a band matrix that are subtracted at once, and zeros at the end of each row: every number
below them is then loaded and stored once for eight products, which takes a third of the time of two
at once (1.8 ms against 5.3 for 2,460 rows of 83)."""
