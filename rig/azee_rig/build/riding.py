"""Lets sites ride on the skin: near a joint no single frame follows what blended skin does.

A site is placed once, on the mesh in its own posture. What the skin does there in other postures
is then fitted, over postures anywhere inside the limits, by a sum of vectors that turn with
nodes of the chain: the site's own and the fewest others that bring it near enough.

    p + R · position + Σ_k R_k · vector_k  ≈  the blended skin's place

The sum is linear in position and vectors, so each choice of nodes is a small least-squares
problem. It is damped towards the rigid site and exact in the mesh's own posture. To lie on the
skin matters more than to lie on the same spot of it: misses along the skin count for less. The
problem is solved again a few times with more weight on the postures that miss most, for it is the
worst that counts (Lawson's algorithm, for the least maximum).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from azee_rig.chain import Chain, Frames
from azee_rig.coordinates import Coordinates
from azee_rig.mesh import BodyMesh
from azee_rig.mirror import mirrored
from azee_rig.patches import SkinPatches
from azee_rig.rig import Rig, RigSite, SiteShare

Floats = NDArray[np.float64]

NEAR_M = 0.003
"""No further node is taken once no posture is farther off."""
MOST = 3
"""Further nodes of a site, at most."""
GAIN = 0.85
"""One more node is taken only if it brings the worst posture nearer by so much."""
MANY, FEW = 9, 4
"""Of more nodes than so many, only the few that help most alone are tried together."""
ALONG = 0.3
"""What a miss along the skin counts against one away from it."""
DAMPING = 1e-4
ROUNDS = 4
CARRIES = 0.005
"""Skin weight from which on a joint's nodes are tried."""
SEED, POSTURES = 2018, 120
TOWARDS_LIMITS = 0.6
"""Shape of the beta distribution that postures are drawn from: below 1, limits are likelier."""
PAIRED = "arm_L.", "arm_R."
"""The coordinates of a shoulder: their limits are tried in every combination."""


def riding(rig: Rig, mesh: BodyMesh) -> dict[str, RigSite]:
    """Return a rig's sites, each with the shares of nodes that keep it on the skin.

    Args: rig: with sites that lie on the mesh in its own posture, fixed in their nodes' frames.
    """
    sites = list(rig.sites.values())
    fit = _Fit(rig, mesh, sites)
    return {site.name: fit.ridden(i, site) for i, site in enumerate(sites)}


def drawn_postures(coordinates: Coordinates) -> Floats:
    """Return postures (P, V) to fit over, the first of them bind.

    Random ones that are often at limits, with their mirror images; and shoulders at the corners
    of their range, where skin is hardest to follow.
    """
    random = np.random.default_rng(SEED)
    part = random.beta(TOWARDS_LIMITS, TOWARDS_LIMITS, (POSTURES, len(coordinates)))
    drawn = coordinates.lower + part * (coordinates.upper - coordinates.lower)
    corners = []
    for parts in product((0.0, 0.5, 1.0), repeat=3):
        q = np.array(coordinates.idle)
        for shoulder in PAIRED:
            own = [i for i, name in enumerate(coordinates.names) if name.startswith(shoulder)]
            low, high = coordinates.lower[own], coordinates.upper[own]
            q[own] = low + parts[: len(own)] * (high - low)
        corners.append(q)
    return np.vstack(
        [coordinates.bind, coordinates.idle, drawn, mirrored(coordinates, drawn), corners]
    )


@dataclass(frozen=True, eq=False, slots=True)
class _Found:
    """Vectors (n, 3) for n nodes, the site's own first, and the worst miss of all postures.

    columns: which of the nodes that were tried.
    """

    columns: tuple[int, ...]
    vectors: Floats
    worst: float


class _Fit:
    """Where the skin is under all sites in the drawn postures, and the frames of all nodes."""

    def __init__(self, rig: Rig, mesh: BodyMesh, sites: Sequence[RigSite]) -> None:
        self.rig, self.chain = rig, rig.chain
        postures = drawn_postures(rig.coordinates)
        self.frames = rig.chain.frames(postures)
        bind = Frames(self.frames.positions[0], self.frames.rotations[0])
        points = np.array([site.point(bind) for site in sites])
        patches = SkinPatches.under(points, mesh)
        self.weights = patches.weights()
        skins, self.patches = patches.posed(rig, postures)
        # What the site is off its triangle at bind, it stays off.
        turned = self.patches @ np.swapaxes(self.patches[:1], -1, -2)
        self.skins = skins + (turned @ (points - skins[0])[:, :, None])[..., 0]
        normals = np.array([site.outward(bind) for site in sites])
        self.normals = (turned @ normals[:, :, None])[..., 0]
        self.beside = _beside(rig)

    def ridden(self, i: int, site: RigSite) -> RigSite:
        """Return site i with the shares of further nodes that it needs, if any."""
        if site.node < 0:
            return site
        wanted = self.skins[:, i] - self.frames.positions[:, site.node]
        others = [node for node in self._candidates(i, site.node) if node != site.node]
        nodes = (site.node, *others)
        turns = self.frames.rotations[:, nodes]
        skin = _Sum(turns, wanted, self.patches[:, i] * (ALONG, ALONG, 1.0))
        best = _Found((0,), site.position[None], skin.rigid(site.position))
        tried = list(range(1, len(nodes)))
        for count in range(1, MOST + 1):
            if best.worst <= NEAR_M or count > len(tried):
                break
            found = [skin.fitted((0, *some), site.position) for some in combinations(tried, count)]
            least = min(found, key=lambda one: one.worst)
            if least.worst < GAIN * best.worst:
                best = least
            if count == 1 and len(found) > MANY:
                nearest = sorted(found, key=lambda one: one.worst)[:FEW]
                tried = sorted(one.columns[1] for one in nearest)
        if len(best.columns) == 1:
            return site
        alike = np.broadcast_to(np.eye(3), (len(turns), 3, 3))
        normals = _Sum(turns, self.normals[:, i], alike).fitted(best.columns, site.normal).vectors
        return replace(
            site,
            position=best.vectors[0],
            normal=normals[0],
            shares=tuple(
                SiteShare(nodes[column], vector, normal)
                for column, vector, normal in zip(
                    best.columns[1:], best.vectors[1:], normals[1:], strict=True
                )
            ),
        )

    def _candidates(self, i: int, own: int) -> list[int]:
        """Nodes of the joints that carry the skin there, and nodes beside them."""
        drive = self.rig.drive
        carrying = []
        for j in np.flatnonzero(self.weights[i] > CARRIES):
            driven = drive.helper_of[j] if drive.helper_of[j] >= 0 else j
            if drive.node[driven] >= 0:
                carrying.append(int(drive.node[driven]))
        known = set[int]().union(*(_turning(self.chain, node) for node in (own, *carrying)))
        near = [node for node, coordinates in self.beside.items() if coordinates <= known]
        return list(dict.fromkeys([*carrying, *near]))


class _Sum:
    """Turned vectors whose sum is to follow a point over the drawn postures.

    Args: turns: (P, n, 3, 3) rotations of the nodes that may carry it, its own first. wanted:
    (P, 3) where it is, from its own node. senses: (P, 3, 3) columns along which misses are
    measured, as long as they count.
    """

    def __init__(self, turns: Floats, wanted: Floats, senses: Floats) -> None:
        self.turns, self.wanted = turns, wanted
        postures, count = turns.shape[:2]
        by_node = np.einsum("pxa,pnxb->npab", senses, turns)
        self.columns = by_node.reshape(count, 3 * postures, 3)
        self.aim = np.einsum("pxa,px->pa", senses, wanted).ravel()

    def rigid(self, position: Floats) -> float:
        """Return the worst miss if its own node alone carries it."""
        return float(self._missed(self.columns[0], position).max())

    def fitted(self, columns: tuple[int, ...], rigid: Floats) -> _Found:
        """Fit one vector per node, so that their turned sum is what is wanted.

        Args: columns: places of the nodes in `turns`. rigid: (3,) what the first alone would take.
        """
        system = np.hstack([self.columns[column] for column in columns])
        start = np.zeros(system.shape[1])
        start[:3] = rigid
        left = self.aim - system @ start
        at_bind = self.turns[0, columns]
        weights = np.ones(len(self.wanted))
        found: _Found | None = None
        for _ in range(ROUNDS):
            weighted = system * np.repeat(weights / weights.sum(), 3)[:, None]
            normal = weighted.T @ system + DAMPING * np.eye(len(start))
            vectors = (start + np.linalg.solve(normal, weighted.T @ left)).reshape(-1, 3)
            off_at_bind = self.wanted[0] - (at_bind @ vectors[:, :, None])[..., 0].sum(axis=0)
            vectors[0] += at_bind[0].T @ off_at_bind
            off = self._missed(system, vectors.ravel())
            if found is None or off.max() < found.worst:
                found = _Found(columns, vectors, float(off.max()))
            weights *= off / max(off.max(), 1e-12) + 0.01
        assert found is not None
        return found

    def _missed(self, system: Floats, vectors: Floats) -> Floats:
        """How far off the sum is in each posture, (P,)."""
        off = (system @ vectors - self.aim).reshape(-1, 3)
        return np.asarray(np.sqrt(np.einsum("pa,pa->p", off, off)))


def _beside(rig: Rig) -> Mapping[int, set[int]]:
    """Nodes that are no bone's, with the coordinates that turn them against their parents."""
    bones = {
        node for nodes in rig.bones.values() for node in range(nodes.origin_node, nodes.node + 1)
    }
    others = set(range(len(rig.chain.names))) - bones
    return {node: _turning(rig.chain, node) for node in sorted(others)}


def _turning(chain: Chain, node: int) -> set[int]:
    """Coordinates that turn a node against its parent."""
    run = slice(chain.dof_start[node], chain.dof_start[node + 1])
    return set(chain.dof_coordinate[run].tolist())
