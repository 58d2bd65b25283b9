"""A person's hand on a body: the body's joints and limits, the person's lengths and markers.

The body gets the person's bones, and the markers as sites, so that `azee_solver` sees in a marker
what it sees in any site: something that a constraint can place. Limits are the body's. Positions
are in the palm's frame, metres.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from azee.capture.markers import Floats
from azee.capture.places import Place
from azee.clip.digits import DIGITS, FINGERS
from azee_rig.chain import Chain
from azee_rig.coordinates import Coordinates
from azee_rig.rig import Rig, RigSite
from azee_rig.skeleton import frozen
from azee_solver import kinematics

Rows = NDArray[np.int64]

TIP_SHARE = 2.0 / 3.0
"""Wheatland 2016, equation 2.1: θ_DIP = ⅔ θ_PIP, as tendons have it."""


@dataclass(frozen=True, eq=False)
class HandShape:
    """What is a person's own.

    offsets: (15, 3) each joint of thumb, index, … little in the frame of the bone before. markers:
    of each marker on a digit its place and (3,) where it is in that bone's frame. rotation (3, 3)
    and shift (3,): from the frame of the root's markers to the palm's, x ↦ rotation x + shift.
    """

    offsets: Floats
    markers: Mapping[str, tuple[Place, Floats]]
    rotation: Floats
    shift: Floats

    def __post_init__(self) -> None:
        for field in fields(self):
            if field.name != "markers":
                array = frozen(getattr(self, field.name), np.float64)
                object.__setattr__(self, field.name, array)

    def into_palm(self, points: Floats) -> Floats:
        """Return points (…, 3) of the root's frame in the palm's."""
        return np.asarray(points @ self.rotation.T + self.shift)

    def into_root(self, points: Floats) -> Floats:
        """Return points (…, 3) of the palm's frame in the root's."""
        return np.asarray((points - self.shift) @ self.rotation)


@dataclass(frozen=True, eq=False)
class Hand:
    """One hand of a body. side: L or R. coupled: whether last joints follow equation 2.1."""

    body: Rig
    side: str
    coupled: bool = False

    @cached_property
    def nodes(self) -> Rows:
        """Nodes of the 15 bones, the thumb's first, each digit from the palm outwards."""
        names = [f"{digit}_{self.side}_{bone}" for digit in DIGITS for bone in (1, 2, 3)]
        return np.array([self.body.bones[name].node for name in names])

    @cached_property
    def palm(self) -> int:
        """Node of the palm."""
        return self.body.bones[f"palm_{self.side}"].node

    @cached_property
    def columns(self) -> Rows:
        """Coordinates of the digits, in the body's order."""
        starts = tuple(f"{digit}_{self.side}_" for digit in DIGITS)
        names = self.body.coordinates.names
        return np.array([v for v, name in enumerate(names) if name.startswith(starts)])

    @cached_property
    def followers(self) -> tuple[Rows, Rows]:
        """Columns of last joints of fingers and of those before, which equation 2.1 couples."""
        index = self.body.coordinates.index
        pairs = [
            [index[f"{finger}_{self.side}_{bone}.flexion"] for finger in FINGERS] for bone in (3, 2)
        ]
        return np.array(pairs[0]), np.array(pairs[1])

    @property
    def own_offsets(self) -> Floats:
        """The body's own offsets, (15, 3)."""
        return np.asarray(self.body.chain.offsets[self.nodes])

    def site(self, place: Place) -> Floats:
        """Where the body's own site near a place is in its bone's frame, (3,).

        A site that rides on several nodes is taken where it is while the hand is idle.
        """
        site = self.body.sites[place.site(self.side)]
        frames = self.body.chain.frames(self.body.coordinates.idle)
        node = self.body.bones[place.node(self.side)].node
        return np.asarray((site.point(frames) - frames.positions[node]) @ frames.rotations[node])

    def of(self, shape: HandShape) -> Rig:
        """Return the body with a person's bones, and with the markers as its only sites."""
        offsets = np.array(self.body.chain.offsets)
        offsets[self.nodes] = shape.offsets
        sites = {
            name: RigSite(
                name,
                place.node(self.side),
                self.body.bones[place.node(self.side)].node,
                position,
                np.array([0.0, 0.0, -1.0]),
            )
            for name, (place, position) in shape.markers.items()
        }
        chain = replace(self.body.chain, offsets=offsets)
        if self.coupled:
            chain = self._coupled(chain)
        return replace(self.body, chain=chain, sites=sites, coordinates=self.limits)

    @cached_property
    def limits(self) -> Coordinates:
        """The body's coordinates; where joints are coupled, within the limits of both."""
        c = self.body.coordinates
        if not self.coupled:
            return c
        last, before = self.followers
        lower, upper = np.array(c.lower), np.array(c.upper)
        lower[before] = np.maximum(lower[before], lower[last] / TIP_SHARE)
        upper[before] = np.minimum(upper[before], upper[last] / TIP_SHARE)
        idle = np.clip(c.idle, lower, upper)
        return replace(c, lower=lower, upper=upper, idle=idle)

    def _coupled(self, chain: Chain) -> Chain:
        """Return a chain whose last joints take two thirds of the coordinate before."""
        coordinate, scale = np.array(chain.dof_coordinate), np.array(chain.dof_scale)
        for last, before in zip(*self.followers, strict=True):
            turned = chain.dof_coordinate == last
            coordinate[turned], scale[turned] = before, TIP_SHARE * scale[turned]
        return replace(chain, dof_coordinate=coordinate, dof_scale=scale)

    def completed(self, q: Floats) -> Floats:
        """Return postures (T, V) inside the limits, with coupled joints where they are."""
        q = np.clip(q, self.limits.lower, self.limits.upper)
        if self.coupled:
            last, before = self.followers
            c = self.body.coordinates
            q[:, last] = np.clip(TIP_SHARE * q[:, before], c.lower[last], c.upper[last])
        return q

    def bones(self, rig: Rig, q: Floats) -> tuple[Floats, Floats]:
        """Return origins (T, 15, 3) and rotations (T, 15, 3, 3) of the bones in the palm."""
        frames = kinematics.frames(rig.chain, q)
        P, p = frames.rotations[:, self.palm], frames.positions[:, self.palm]
        origins = np.einsum("tba,tnb->tna", P, frames.positions[:, self.nodes] - p[:, None])
        return origins, np.swapaxes(P, 1, 2)[:, None] @ frames.rotations[:, self.nodes]

    def marker_positions(self, shape: HandShape, q: Floats) -> Floats:
        """Where a person's markers are in postures (T, V), (T, m, 3) in the palm."""
        origins, rotations = self.bones(self.of(shape), q)
        numbers, local = self.numbered(shape.markers)
        turned = (rotations[:, numbers] @ local[:, :, None])[..., 0]
        return np.asarray(origins[:, numbers] + turned)

    def numbered(self, markers: Mapping[str, tuple[Place, Floats]]) -> tuple[Rows, Floats]:
        """Return which of the 15 bones carries each marker, (m,), and where on it, (m, 3)."""
        numbers = [3 * DIGITS.index(place.digit) + place.bone - 1 for place, _ in markers.values()]
        return np.array(numbers), np.array([position for _, position in markers.values()])
