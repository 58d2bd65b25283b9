"""The surface of an imported body, with its parts classified for AZee's sites."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.surface import Mask, Surface

ROLES = {
    "tongue": ("tongue",),
    "teeth": ("teeth", "tooth", "gum", "innermouth", "inner_mouth", "mouthinside"),
    "lashes": ("lash",),
    "hair": ("hair",),
    "brows": ("brow",),
}
"""Parts of a body other than skin, by words in the names of materials."""


@dataclass(frozen=True, eq=False)
class ForeignSurface(Surface):
    """A surface whose parts have the names of the source.

    eyes: vertices of the eyeballs, (N,).
    """

    eyes: NDArray[np.bool_]

    @cached_property
    def roles(self) -> NDArray[np.str_]:
        """Class of each triangle for the rules of the sites, (F,)."""
        roles = np.full(len(self.mesh.triangles), "skin", dtype="<U8")
        for part in self.mesh.parts:
            name = part.name.lower()
            for role, words in ROLES.items():
                if any(word in name for word in words):
                    roles[part.start : part.stop] = role
        roles[self.eyes[self.mesh.triangles].all(axis=1)] = "eyes"
        return roles

    def on_parts(self, *names: str) -> Mask:
        """Return triangles of some parts of the signer, (F,): clothes count as skin here."""
        return np.isin(self.roles, names)
