"""Lets sites ride on the skin: near a joint no single frame follows what blended skin does.

A site is placed once, on the mesh in its own posture. What the skin does there in other postures
is then fitted, over postures anywhere inside the limits, by a sum of vectors that turn with
nodes of the chain: the site's own and the fewest others that bring it near enough.

    p + R · position + Σ_k R_k · vector_k  ≈  the blended skin's place

The sum is linear in position and vectors, so each choice of nodes is a small least-squares
problem; it is damped towards the rigid site, and exact in the mesh's own posture.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

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
"""A further node is taken only if it brings the worst posture nearer by so much."""
DAMPING = 1e-5
CARRIES = 0.005
"""Skin weight from which on a joint's nodes are tried."""
SEED, POSTURES = 2018, 160
TOWARDS_LIMITS = 0.6
"""Shape of the beta distribution that postures are drawn from: below 1, limits are likelier."""


def riding(rig: Rig, mesh: BodyMesh) -> dict[str, RigSite]:
    """Return a rig's sites, each with the shares of nodes that keep it on the skin.

    Args: rig: with sites that lie on the mesh in its own posture, fixed in their nodes' frames.
    """
    sites = list(rig.sites.values())
    fit = _Fit(rig, mesh, sites)
    return {site.name: fit.ridden(i, site) for i, site in enumerate(sites)}


def drawn_postures(coordinates: Coordinates) -> Floats:
    """Return postures (P, V): bind, idle, random ones that are often at limits, their mirrors."""
    random = np.random.default_rng(SEED)
    part = random.beta(TOWARDS_LIMITS, TOWARDS_LIMITS, (POSTURES, len(coordinates)))
    drawn = coordinates.lower + part * (coordinates.upper - coordinates.lower)
    return np.vstack([coordinates.bind, coordinates.idle, drawn, mirrored(coordinates, drawn)])


class _Fit:
    """Where the skin is under all sites in the drawn postures, and the frames of all nodes."""

    def __init__(self, rig: Rig, mesh: BodyMesh, sites: Sequence[RigSite]) -> None:
        self.rig, self.chain = rig, rig.chain
        postures = drawn_postures(rig.coordinates)
        self.frames = rig.chain.frames(postures)
        bind = Frames(self.frames.positions[0], self.frames.rotations[0])
        self.points = np.array([site.point(bind) for site in sites])
        patches = SkinPatches.under(self.points, mesh)
        self.weights = patches.weights()
        skins, turns = patches.posed(rig, postures)
        # What the site is off its triangle at bind, it stays off.
        turned = turns @ np.swapaxes(turns[:1], -1, -2)
        off = (self.points - skins[0])[:, :, None]
        self.skins = skins + (turned @ off)[..., 0]
        normals = np.array([site.outward(bind) for site in sites])
        self.normals = (turned @ normals[:, :, None])[..., 0]
        self.beside = _beside(rig.chain, rig)

    def ridden(self, i: int, site: RigSite) -> RigSite:
        """Return site i with the shares of further nodes that it needs, if any."""
        skins, nodes = self.skins[:, i], [site.node]
        vectors = [site.position]
        worst = self._worst(site.node, nodes, vectors, skins)
        tried = self._candidates(i, site.node)
        while worst > NEAR_M and len(nodes) <= MOST:
            found = []
            for node in tried:
                if node not in nodes:
                    fitted = self._fitted([*nodes, node], skins, site.position)
                    off = self._worst(site.node, [*nodes, node], fitted, skins)
                    found.append((off, node, fitted))
            if not found:
                break
            best = min(found, key=lambda f: f[0])
            if best[0] > GAIN * worst:
                break
            worst, vectors = best[0], best[2]
            nodes.append(best[1])
        if len(nodes) == 1:
            return site
        normals = self._solved(nodes, self.normals[:, i], site.normal)
        return replace(
            site,
            position=vectors[0],
            normal=normals[0],
            shares=tuple(map(SiteShare, nodes[1:], vectors[1:], normals[1:])),
        )

    def _candidates(self, i: int, own: int) -> list[int]:
        """Nodes of the joints that carry the skin there, and nodes beside them."""
        drive, turned = self.rig.drive, self.beside
        carrying = []
        for j in np.flatnonzero(self.weights[i] > CARRIES):
            driven = drive.helper_of[j] if drive.helper_of[j] >= 0 else j
            if drive.node[driven] >= 0:
                carrying.append(int(drive.node[driven]))
        known = set[int]().union(*(self._owned(node) for node in (own, *carrying)))
        near = [node for node, coordinates in turned.items() if coordinates <= known]
        return list(dict.fromkeys([*carrying, *near]))

    def _owned(self, node: int) -> set[int]:
        return _owned(self.chain, node)

    def _worst(
        self, own: int, nodes: Sequence[int], vectors: Sequence[Floats], skins: Floats
    ) -> float:
        place = self.frames.positions[:, own] + sum(
            self.frames.rotations[:, node] @ vector
            for node, vector in zip(nodes, vectors, strict=True)
        )
        return float(np.linalg.norm(place - skins, axis=1).max())

    def _fitted(self, nodes: Sequence[int], skins: Floats, rigid: Floats) -> list[Floats]:
        wanted = skins - self.frames.positions[:, nodes[0]]
        return self._solved(nodes, wanted, rigid)

    def _solved(self, nodes: Sequence[int], wanted: Floats, rigid: Floats) -> list[Floats]:
        """Vectors per node whose turned sum is nearest to what is wanted (P, 3), exact at bind."""
        rotations = self.frames.rotations[:, nodes]
        columns = rotations.transpose(0, 2, 1, 3).reshape(len(wanted) * 3, -1)
        prior = np.zeros(columns.shape[1])
        prior[:3] = rigid
        left = wanted.reshape(-1) - columns @ prior
        normal = columns.T @ columns / len(wanted) + DAMPING * np.eye(len(prior))
        vectors = (prior + np.linalg.solve(normal, columns.T @ left / len(wanted))).reshape(-1, 3)
        at_bind = wanted[0] - (rotations[0] @ vectors[:, :, None])[..., 0].sum(axis=0)
        vectors[0] += rotations[0, 0].T @ at_bind
        return list(vectors)


def _beside(chain: Chain, rig: Rig) -> Mapping[int, set[int]]:
    """Nodes that are no bone's, with the coordinates that turn them against their parents."""
    bones = {
        node for nodes in rig.bones.values() for node in range(nodes.origin_node, nodes.node + 1)
    }
    return {n: _owned(chain, n) for n in range(len(chain.names)) if n not in bones}


def _owned(chain: Chain, node: int) -> set[int]:
    run = slice(chain.dof_start[node], chain.dof_start[node + 1])
    return set(chain.dof_coordinate[run].tolist())
