"""Motion of one body on another: the places of hands and the directions of palms are kept.

Angles cannot be copied between bodies: arms of other lengths miss what they touched. So the source
is measured in the frame of its chest: the wrists from the middle of the shoulders, in arm lengths,
so that hands that touch still touch; the orientation of the palms; the elbows, as near as hands
allow; the bending of every finger. Trunk, neck and head turn as those of the source.

Damped Gauss–Newton within the limits finds the postures of all frames together: first each frame by
itself, then close to the smoothed result, so that free coordinates do not jump.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.clip.digits import DIGITS, SIDES, DigitFit
from azee.clip.finite import LEAST_STEP_S
from azee.clip.retarget_source import Measured
from azee_rig.chain import Chain, Frames
from azee_rig.rig import Rig
from azee_rig.rotation import rotation_vectors

Floats = NDArray[np.float64]
Rows = NDArray[np.int64]

ARM = (
    "clav_{S}.elevation", "clav_{S}.protraction", "arm_{S}.flexion", "arm_{S}.abduction",
    "arm_{S}.rotation", "f_arm_{S}.flexion", "f_arm_{S}.pronation", "palm_{S}.flexion",
    "palm_{S}.deviation",
)  # fmt: skip
"""Coordinates of an arm."""
WRIST_M, PALM_RAD, ELBOW_M, WISH_RAD = 0.004, np.radians(1.0), 0.02, np.radians(60.0)
"""Scales of equal weight: errors of place, of turn, of the elbow, and of the wanted posture."""
HASTE_RAD = np.radians(1.0)
"""A turn from one frame to the next that weighs as much, where there is a choice of ways."""
PRONATION = ARM.index("f_arm_{S}.pronation")
KEPT_SHARE, KEPT_OFF_RAD, KEPT_TIP_M = 0.03, np.radians(5.0), 0.003
"""Up to here, in arm lengths, radians and metres, hands and fingers count as where they were."""
SWEEPS, STEP_RAD = 40, 1e-6
ENOUGH = 1e-6
"""A step that gains less, in squares of what weighs as 1, is the last of its frame."""
CHUNK = 1024
"""Frames that are solved together: each for itself, so that long recordings need no more room."""
FASTEST_RAD_S = 25.0
"""Faster turns, 1,430°/s, are jumps: about the largest measured of an elbow (docs/motion.md)."""
SMOOTH_S = 0.15
"""Half the window for smoothing the first solution."""


@dataclass(frozen=True, eq=False)
class Retargeted:
    """A clip on the new body, and the remaining errors, per frame and side (L, R).

    wrist_m: (T, 2) metres off on the new body. palm_rad: (T, 2) turn of the palm that is off.
    tip_m: by digit, such as `thumb_L`, (T,) metres that its tip is off in the palm's frame.
    """

    clip: Clip
    wrist_m: Floats
    palm_rad: Floats
    tip_m: Mapping[str, Floats]

    @property
    def is_as_it_was(self) -> bool:
        """Whether nothing had to be carried over."""
        errors = (self.wrist_m, self.palm_rad, *self.tip_m.values())
        return not any(error.any() for error in errors)

    def kept(self, body: Rig) -> str:
        """Tell in how many frames hands are where they were, and how far hands and fingers are off.

        Args: body: the new one.
        """
        return f"{self._hands_kept(body)}; {self._fingers_kept()}"

    def _fingers_kept(self) -> str:
        if not self.tip_m:
            return "no finger is carried over"
        worst: dict[str, float] = {}
        for name, off in self.tip_m.items():
            digit = name.split("_")[0]
            worst[digit] = max(worst.get(digit, 0.0), 1e3 * float(off.max()))
        if max(worst.values()) <= 1e3 * KEPT_TIP_M:
            return (
                f"finger tips are within {1e3 * KEPT_TIP_M:.0f} mm of where they were in the palm"
            )
        each = ", ".join(f"{digit} {most:.0f} mm" for digit, most in worst.items())
        return f"finger tips are off in the palm by up to: {each}"

    def report(self, body: Rig) -> dict[str, Any]:
        """Return how far hands and digits are off, as docs/formats.md describes it."""

        def spread(values: Floats) -> dict[str, float]:
            return {"mean": float(values.mean()), "max": float(values.max())}

        return {
            "rig": body.name,
            "frames": len(self.clip.times),
            "arm_m": body.landmarks.arm_m,
            "hands": {
                side: {
                    "wrist_m": spread(self.wrist_m[:, s]),
                    "palm_rad": spread(self.palm_rad[:, s]),
                }
                for s, side in enumerate(SIDES)
            },
            "digits": {name: {"tip_m": spread(off)} for name, off in self.tip_m.items()},
        }

    def _hands_kept(self, body: Rig) -> str:
        share = self.wrist_m / body.landmarks.arm_m
        off = (share > KEPT_SHARE) | (self.palm_rad > KEPT_OFF_RAD)
        frames = int(off.any(axis=1).sum())
        if not frames:
            return f"hands are where they were in all {len(off)} frames"
        return (
            f"hands are where they were in {len(off) - frames} of {len(off)} frames; in the others "
            f"the body does not reach: up to {100 * float(share.max()):.0f} % of its arm's length "
            f"and {np.degrees(float(self.palm_rad.max())):.0f}° off"
        )


def as_it_was(clip: Clip) -> Retargeted:
    """Return a clip of the body's own, of which nothing has to be carried over."""
    frames = len(clip.times)
    tips = {f"{digit}_{side}": np.zeros(frames) for side in SIDES for digit in DIGITS}
    return Retargeted(clip, np.zeros((frames, 2)), np.zeros((frames, 2)), tips)


def retarget(source: Measured, rig: Rig) -> Retargeted:
    """Play measured motion on a body."""
    q = np.tile(rig.coordinates.idle, (len(source.times), 1))
    for name, values in source.coordinates.items():
        if name in rig.coordinates.index:
            q[:, rig.coordinates.index[name]] = values
    q = np.clip(q, rig.coordinates.lower, rig.coordinates.upper)
    tips: dict[str, Floats] = {}
    for digit in source.digits:
        hand = DigitFit(rig, digit.name)
        if hand.exists:
            columns = [rig.coordinates.index[name] for name in hand.coordinates]
            q[:, columns], tips[digit.name] = hand.angles(digit)
    fit = _Arms(rig, source, q)
    first = fit.solved(q, q)
    wish = q.copy()  # arms alone are smoothed: what moves the trunk and the fingers is known
    arms = fit.columns.ravel()
    wish[:, arms] = smoothed(first[:, arms], source.times)
    found = fit.steadiest([fit.solved(start, wish) for start in fit.starts(wish)], wish)
    found[:, arms] = eased(found[:, arms], source.times)
    wrist, palm = fit.off(found)
    names, weights = source.units
    known = [i for i, name in enumerate(names) if name in rig.units]
    units = tuple(names[i] for i in known)
    clip = Clip(source.times, found, units, weights[:, known], source.labels)
    return Retargeted(clip, wrist, palm, tips)


class _Arms:
    """Targets for both arms of a body, in all frames."""

    def __init__(self, rig: Rig, source: Measured, q: Floats) -> None:
        self.rig = rig
        c = rig.coordinates
        self.columns = np.array([[c.index[n.format(S=s)] for n in ARM] for s in SIDES])
        self.palms = [rig.bones[f"palm_{s}"].node for s in SIDES]
        self.chain, number = _only(rig.chain, self.palms)
        self.palms = [number[node] for node in self.palms]
        self.nodes = {
            bone: [number[rig.bones[f"{bone}_{s}"].origin_node] for s in SIDES]
            for bone in ("f_arm", "palm")
        }
        chest = rig.bones["back_2"].node
        still = rig.chain.frames(c.idle)
        middle = still.rotations[chest].T @ (rig.landmarks.shoulder_middle - still.positions[chest])
        at = rig.chain.frames(q)
        R, origin = at.rotations[:, chest], at.positions[:, chest]
        origin = origin + R @ middle
        size = rig.landmarks.arm_m / source.arm_m

        def place(points: Floats) -> Floats:
            return np.asarray(origin[:, None] + size * np.einsum("tab,tsb->tsa", R, points))

        self.wrists, self.elbows = place(source.wrists), place(source.elbows)
        self.turns = np.einsum("tab,tsbc->tsac", R, source.palms)

    def solved(self, start: Floats, wish: Floats) -> Floats:
        """Postures (T, V) that come nearest, from others; what is free stays near the wish."""
        q = start.copy()
        for first in range(0, len(q), CHUNK):
            frames = np.arange(first, min(first + CHUNK, len(q)))
            q[frames] = self._some(frames)._solved(q[frames], wish[frames])
        return q

    def _some(self, frames: Rows) -> _Arms:
        """Return the wishes for some of the frames."""
        some = copy(self)
        for name in ("wrists", "elbows", "turns"):
            setattr(some, name, getattr(self, name)[frames])
        return some

    def _solved(self, start: Floats, wish: Floats) -> Floats:
        """Solve each frame for itself; those that no step improves any more are left alone."""
        q = start.copy()
        cost, r = self._residual(q, wish)
        damping = np.full((len(q), 2), 1e-2)
        busy = np.arange(len(q))
        for _ in range(SWEEPS):
            some = self._some(busy)
            tried = some._step(q[busy], wish[busy], r[busy], damping[busy])
            after, r_after = some._residual(tried, wish[busy])
            better = after < cost[busy]
            for s, columns in enumerate(self.columns):
                rows = np.flatnonzero(better[:, s])
                q[busy[rows][:, None], columns] = tried[rows[:, None], columns]
            gain = np.where(better, cost[busy] - after, 0.0)
            r[busy] = np.where(better[..., None], r_after, r[busy])
            cost[busy] = np.where(better, after, cost[busy])
            factor = np.where(better, 0.3, 5.0)
            damping[busy] = (factor * damping[busy]).clip(1e-8, 1e8)
            stuck = ~better & (damping[busy] < 1e4)
            busy = busy[((gain > ENOUGH) | stuck).any(axis=1)]
            if not len(busy):
                break
        return q

    def _step(self, q: Floats, wish: Floats, r: Floats, damping: Floats) -> Floats:
        """Postures (T, V) a damped Gauss–Newton step further, inside the limits."""
        c = self.rig.coordinates
        J = self._jacobian(q, wish, r)
        JT = np.swapaxes(J, -1, -2)
        normal = JT @ J + damping[..., None, None] * np.eye(len(ARM))
        step = -np.linalg.solve(normal, JT @ r[..., None])[..., 0]
        tried = q.copy()
        for s, columns in enumerate(self.columns):
            moved = q[:, columns] + np.clip(step[:, s], -0.5, 0.5)
            tried[:, columns] = np.clip(moved, c.lower[columns], c.upper[columns])
        return tried

    def starts(self, q: Floats) -> list[Floats]:
        """Return start postures (T, V): the given ones, and ones with forearms turned out and in.

        If a palm is turned further than the forearm can turn, both limits of it are equally good.
        """
        c = self.rig.coordinates
        found = [q]
        for share in (0.2, 0.8):
            turned = q.copy()
            for columns in self.columns:
                v = columns[PRONATION]
                turned[:, v] = c.lower[v] + share * (c.upper[v] - c.lower[v])
            found.append(turned)
        return found

    def steadiest(self, ways: Sequence[Floats], wish: Floats) -> Floats:
        """Of several solutions (T, V), return per arm that with the least errors and speed.

        It may change between solutions where they are near each other: a shortest path over frames.
        """
        out = ways[0].copy()
        cost = np.stack([self._residual(q, wish)[0] for q in ways])
        for s, columns in enumerate(self.columns):
            q = np.stack([way[:, columns] for way in ways])
            best = cost[:, :, s].copy()
            came = np.zeros(best.shape, np.int64)
            for t in range(1, best.shape[1]):
                haste = ((q[:, None, t - 1] - q[None, :, t]) / HASTE_RAD) ** 2
                total = best[:, None, t - 1] + haste.sum(axis=-1)
                came[:, t] = total.argmin(axis=0)
                best[:, t] += total.min(axis=0)
            way = int(best[:, -1].argmin())
            for t in range(best.shape[1] - 1, -1, -1):
                out[t, columns] = q[way, t]
                way = int(came[way, t])
        return out

    def off(self, q: Floats) -> tuple[Floats, Floats]:
        """Return the errors of wrists and palms, (T, 2) each."""
        at = self.chain.frames(q)
        wrists = at.positions[:, self.nodes["palm"]] - self.wrists
        return np.linalg.norm(wrists, axis=-1), np.linalg.norm(self._turned(at), axis=-1)

    def _turned(self, at: Frames) -> Floats:
        """Return rotation vectors from the present palms to the wanted ones, (…, 2, 3)."""
        R = self.turns @ np.swapaxes(at.rotations[..., self.palms, :, :], -1, -2)
        return rotation_vectors(R)

    def _residual(self, q: Floats, wish: Floats) -> tuple[Floats, Floats]:
        """Return sums of squares (…, T, 2), and their terms, (…, T, 2, 18)."""
        at = self.chain.frames(q)
        parts = [
            (at.positions[..., self.nodes["palm"], :] - self.wrists) / WRIST_M,
            self._turned(at) / PALM_RAD,
            (at.positions[..., self.nodes["f_arm"], :] - self.elbows) / ELBOW_M,
            (q[..., self.columns] - wish[:, self.columns]) / WISH_RAD,
        ]
        r = np.concatenate(parts, axis=-1)
        return np.asarray((r**2).sum(axis=-1)), r

    def _jacobian(self, q: Floats, wish: Floats, r: Floats) -> Floats:
        moved = np.tile(q, (len(ARM), 1, 1))
        for k in range(len(ARM)):
            moved[k][:, self.columns[:, k]] += STEP_RAD
        change = (self._residual(moved, wish)[1] - r) / STEP_RAD
        return np.moveaxis(change, 0, -1)


def _only(chain: Chain, wanted: Sequence[int]) -> tuple[Chain, dict[int, int]]:
    """Return the part of a chain that carries some nodes, and the nodes' numbers in it."""
    kept = set(wanted)
    for node in range(len(chain.names) - 1, -1, -1):
        if node in kept and chain.parents[node] >= 0:
            kept.add(int(chain.parents[node]))
    order = sorted(kept)
    number = {node: i for i, node in enumerate(order)}
    runs = [np.arange(chain.dof_start[n], chain.dof_start[n + 1]) for n in order]
    dofs = np.concatenate(runs)
    part = Chain(
        names=tuple(chain.names[n] for n in order),
        parents=np.array([number.get(int(chain.parents[n]), -1) for n in order]),
        offsets=chain.offsets[order],
        zero=chain.zero[order],
        dof_start=np.cumsum([0, *(len(run) for run in runs)]),
        dof_axis=chain.dof_axis[dofs],
        dof_scale=chain.dof_scale[dofs],
        dof_coordinate=chain.dof_coordinate[dofs],
    )
    return part, number


def eased(q: Floats, times: Floats) -> Floats:
    """Spread over some frames what no joint does in one, such as a forearm from limit to limit."""
    if len(times) < 3:
        return q
    fast = np.zeros(q.shape)
    fast[1:] = np.abs(np.diff(q, axis=0)) > FASTEST_RAD_S * np.diff(times)[:, None]
    first, last = _window(times, np.full(len(times), SMOOTH_S))
    sums = np.cumsum(np.vstack([np.zeros(q.shape[1]), fast]), axis=0)
    near = sums[last] > sums[first]
    share = smoothed(near.astype(np.float64), times)
    return np.asarray(q + share * (smoothed(q, times) - q))


def smoothed(q: Floats, times: Floats) -> Floats:
    """Means over a window of time that is the narrower the nearer to an end, (T, V)."""
    sums = np.cumsum(np.vstack([np.zeros(q.shape[1]), q]), axis=0)
    reach = np.minimum(SMOOTH_S, np.minimum(times - times[0], times[-1] - times))
    first, last = _window(times, reach)
    return np.asarray((sums[last] - sums[first]) / (last - first)[:, None])


def _window(times: Floats, reach: Floats) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the first frame, and the one after the last, that lie within a time of each, (T,)."""
    first = np.searchsorted(times, times - reach - LEAST_STEP_S / 2.0)
    last = np.searchsorted(times, times + reach + LEAST_STEP_S / 2.0)
    return first, last
