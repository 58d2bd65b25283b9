"""The report of an import: what was found, what is missing, what works."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from azee_rig.importing.bone_map import DIGITS, SIDES

SIDE_NAMES = {"L": "left", "R": "right"}


@dataclass(frozen=True, eq=False)
class ImportReport:
    """Findings of an import.

    family: how the bones-map was found: VRM, names, shape or given. joints: of the file, kept: of
    the rig. notes: what was put right. doubts: what looks wrong in the bones-map. without: AZee
    bones without joints. eyes: `joints`, `balls` found in the mesh, or "". morphs: facial morphs
    that the face shows; unexpressed: the others, with reasons; partly: shown with parts missing.
    lost_sites: sites that could not be placed.
    """

    name: str
    family: str
    joints: int
    kept: int
    vertices: int
    notes: tuple[str, ...]
    doubts: tuple[str, ...]
    without: tuple[str, ...]
    eyes: str
    morphs: int
    unexpressed: Mapping[str, str]
    partly: tuple[str, ...]
    lost_sites: tuple[str, ...]

    def missing(self, folder: Path) -> Iterator[str]:
        """Yield the missing parts and what still works, a line each. folder: of the rig."""
        for side in SIDES:
            gone = [d for d in DIGITS if all(f"{d}_{side}_{k}" in self.without for k in (1, 2, 3))]
            if len(gone) == len(DIGITS):
                yield (
                    f"no fingers on the {SIDE_NAMES[side]} hand: what places or bends them is "
                    "left out; palm, wrist and arm work"
                )
            elif gone:
                yield f"no {', '.join(gone)} on the {SIDE_NAMES[side]} hand: left out likewise"
        merged = [b for b in self.without if b in ("back_1", "neck")]
        if merged:
            yield (
                f"no joints of their own: {', '.join(merged)}; what they would turn turns with "
                "the next bone"
            )
        if "clav_L" in self.without or "clav_R" in self.without:
            yield "no clavicles: shoulders cannot be raised; arms work"
        if self.eyes == "balls":
            yield "no eye joints: the eyeballs found in the head were given some"
        elif not self.eyes:
            yield "no eyes that could turn: looks are worked out, but not seen"
        if not self.morphs:
            yield "no face morphs: mimics are left out; hands, head and trunk work"
        elif self.unexpressed:
            yield (
                f"{self.morphs} facial morphs are shown, {len(self.unexpressed)} are not "
                f"(`azee rig morphs --rig {folder}` lists them)"
            )
        fingers = ("T_", "I_", "M_", "R_", "L_")
        lost = [s for s in self.lost_sites if not (s.startswith(fingers) and self._fingerless)]
        if lost:
            yield f"sites that could not be placed: {', '.join(lost)}"

    @property
    def _fingerless(self) -> bool:
        return any(f"{d}_{s}_3" in self.without for d in DIGITS for s in SIDES)

    def as_json(self) -> dict[str, Any]:
        """Return it as JSON data."""
        return {
            "name": self.name,
            "map": self.family,
            "joints": {"file": self.joints, "kept": self.kept},
            "vertices": self.vertices,
            "notes": list(self.notes),
            "doubts": list(self.doubts),
            "without_joints": list(self.without),
            "eyes": self.eyes or None,
            "face_morphs": {
                "shown": self.morphs,
                "partly": list(self.partly),
                "not_shown": dict(self.unexpressed),
            },
            "lost_sites": list(self.lost_sites),
            "missing": list(self.missing(Path(self.name))),
        }
