"""Life: what a living body does besides what a score asks of it, on all coordinates, always.

Four parts add up:

- *drift*: each coordinate wanders by a sum of sines between `DRIFT_HZ` with power that falls as
  1/f, as posture does in quiet standing (Winter 1995 gives sway of 4–8 mm with most power below
  1 Hz), the trunk slower than hands and fingers;
- *breath*: chest and shoulders rise and fall about every four seconds, no two breaths alike;
- *reaction*: the trunk yields to the mean acceleration of the hands, by a share of their mass;
- *following*: head and trunk turn a little where the hands go, later than they.

The result is not limited: constraints and limits are kept by the projection that follows it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from azee_rig.rig import Rig
from azee_solver import kinematics

Array = NDArray[np.float64]

BEFORE_S, AFTER_S = 0.3, 0.5
"""How long the signer stands at rest before and after all movement, at least."""

DRIFT_HZ = (0.12, 2.2)
SLOW_DRIFT_HZ = (0.1, 0.9)
_SINES = 9
DRIFT_DEG: Mapping[str, float] = {
    "back": 0.35, "neck": 0.75, "head": 0.9, "eye": 0.12, "clav": 0.35, "arm": 0.4, "f_arm": 0.4,
    "palm": 0.4,
}  # fmt: skip
"""Root mean square of the drift of coordinates, by the beginning of their bones' names."""
FINGER_DRIFT_DEG = 0.6

BREATH_S, BREATH_SPREAD = 3.8, 0.15
"""Mean length of a breath, and the standard deviation as a share of it."""
BREATH_DEG: Mapping[str, float] = {
    "back_2.flexion": -0.6, "clav_L.elevation": 0.6, "clav_R.elevation": 0.6,
}  # fmt: skip

REACTION_HZ = 2.0
REACTION_DEG_S2_M = 0.12
"""Turn of the trunk against an acceleration of the hands of 1 m/s², degrees."""
FOLLOWING_HZ = 0.9
FOLLOWING_DEG_M: Mapping[str, tuple[float, float, float]] = {
    "back_1.axial": (3.0, 0.0, 0.0),
    "head.axial": (7.0, 0.0, 0.0),
    "head.lateral": (-2.0, 0.0, 0.0),
    "head.flexion": (0.0, -4.5, 0.0),
    "back_1.flexion": (0.0, -1.0, 3.0),
}
"""Turn of coordinates where the mean of the hands is by so many metres to the left, up, forward."""


def life(rig: Rig, q: Array, times_s: Array, seed: int) -> Array:
    """Return what life adds to a movement (T, V) at even times (T,), (T, V) radians."""
    rng = np.random.default_rng(seed)
    out = _drift(rig, times_s, rng)
    _add(out, rig, {n: math.radians(d) * _breath(times_s, rng) for n, d in BREATH_DEG.items()})
    if len(times_s) > 1:
        _add(out, rig, _with_hands(rig, q, times_s))
    return out


def _drift(rig: Rig, times_s: Array, rng: np.random.Generator) -> Array:
    names = rig.coordinates.names
    amplitude = np.array([_amplitude_deg(name) for name in names])
    slow = np.array([name.startswith("back") for name in names])
    out = np.zeros((len(times_s), len(names)))
    quick_hz, slow_hz = (np.geomspace(*band, _SINES) for band in (DRIFT_HZ, SLOW_DRIFT_HZ))
    share = 1.0 / np.sqrt(quick_hz)
    share *= np.sqrt(2.0 / np.sum(share**2))
    for k in range(_SINES):
        phase = rng.uniform(0.0, 2.0 * math.pi, len(names))
        hz = np.where(slow, slow_hz[k], quick_hz[k]) * rng.uniform(0.85, 1.15, len(names))
        out += share[k] * np.sin(2.0 * math.pi * np.outer(times_s, hz) + phase)
    return np.asarray(out * np.radians(amplitude))


def _amplitude_deg(coordinate: str) -> float:
    found = [d for start, d in DRIFT_DEG.items() if coordinate.startswith(f"{start}_")]
    found += [d for start, d in DRIFT_DEG.items() if coordinate.startswith(f"{start}.")]
    return found[0] if found else FINGER_DRIFT_DEG


def _breath(times_s: Array, rng: np.random.Generator) -> Array:
    """Return breaths of differing lengths, −1 to 1, (T,)."""
    count = math.ceil((times_s[-1] - times_s[0]) / BREATH_S * 2.0) + 3
    lengths = BREATH_S * np.exp(rng.normal(0.0, BREATH_SPREAD, count))
    starts = times_s[0] - rng.uniform(0.0, 1.0) * lengths[0] + np.cumsum([0.0, *lengths])
    return -np.cos(2.0 * math.pi * np.interp(times_s, starts, np.arange(len(starts))))


def _with_hands(rig: Rig, q: Array, times_s: Array) -> dict[str, Array]:
    """Return what trunk and head do as the hands move, by coordinate, (T,) radians."""
    palms = [rig.bones[name].node for name in ("palm_L", "palm_R") if name in rig.bones]
    hands = kinematics.frames(rig.chain, q).positions[:, palms].mean(axis=1)
    fps = (len(times_s) - 1) / (times_s[-1] - times_s[0])
    away = _low_passed(hands - hands[0], FOLLOWING_HZ, fps)
    out = {name: np.radians(away @ np.array(gains)) for name, gains in FOLLOWING_DEG_M.items()}
    smooth = _low_passed(hands, REACTION_HZ, fps)
    acceleration = np.gradient(np.gradient(smooth, axis=0), axis=0) * fps**2
    for name, component, sign in (
        ("back_1.lateral", 0, 1.0),
        ("back_1.flexion", 2, -1.0),
    ):
        turn = sign * np.radians(REACTION_DEG_S2_M) * acceleration[:, component]
        out[name] = out.get(name, 0.0) + turn
    return out


def _low_passed(values: Array, hz: float, fps: float) -> Array:
    """Return a signal (T, n) without what is quicker, not delayed: half of the power at `hz`.

    A Gaussian of the deviation √(ln 2) / (2π hz); the ends of the signal are continued.
    """
    deviation = math.sqrt(math.log(2.0)) / (2.0 * math.pi * hz) * fps
    reach = math.ceil(4.0 * deviation)
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / deviation) ** 2)
    kernel /= kernel.sum()
    longer = np.pad(values, ((reach, reach), (0, 0)), mode="edge")
    columns = [np.convolve(column, kernel, mode="valid") for column in longer.T]
    return np.stack(columns, axis=1)


def _add(out: Array, rig: Rig, turns: Mapping[str, Array]) -> None:
    for name, turn in turns.items():
        if name in rig.coordinates.index:
            out[:, rig.coordinates.index[name]] += turn
