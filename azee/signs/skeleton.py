"""What a skeleton is, so that motion is never played on another by mistake."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING

from azee.signs.sign import digest_of

if TYPE_CHECKING:
    from azee_rig.rig import Rig


@dataclass(frozen=True, slots=True)
class StoredSkeleton:
    """A skeleton of a database: joints in order, names of the coordinates in order."""

    name: str
    digest: str
    joints: tuple[str, ...]
    coordinates: tuple[str, ...]

    @classmethod
    def of(cls, rig: Rig) -> StoredSkeleton:
        """Return that of a body.

        The digest is of joints, parents, offsets to a micrometre and names of coordinates. Limits
        and the skin do not count: the same motion plays on a body that only differs in these.
        """
        bones = rig.skeleton
        content = {
            "joints": list(bones.names),
            "parents": bones.parents.tolist(),
            "offsets_um": (bones.offsets * 1e6).round().astype(int).tolist(),
            "coordinates": list(rig.coordinates.names),
        }
        text = json.dumps(content, ensure_ascii=True, separators=(",", ":"))
        digest = digest_of(text.encode())
        return cls(rig.name, digest, tuple(bones.names), tuple(rig.coordinates.names))
