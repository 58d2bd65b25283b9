"""Recorded signs in the report of a movement."""

from __future__ import annotations

from dataclasses import dataclass

from azee.motion.tasks.recordings import RecordedBlock


@dataclass(frozen=True, slots=True)
class PlayedRecording:
    """A recorded sign as it was played.

    start_s, end_s: of its block; body_s: from when to when the movement is the recording's. speed:
    of its body, 1 as recorded. limbs: what it moves. Times are the score's.
    """

    path: tuple[str, ...]
    name: str
    start_s: float
    end_s: float
    body_s: tuple[float, float]
    speed: float
    limbs: tuple[str, ...]

    def as_json(self) -> dict[str, object]:
        """Return it as the report's JSON has it."""
        return {
            "path": [*self.path],
            "name": self.name,
            "start_s": self.start_s,
            "end_s": self.end_s,
            "body_s": [*self.body_s],
            "speed": self.speed,
            "limbs": [*self.limbs],
        }


def as_played(block: RecordedBlock) -> PlayedRecording:
    """Return what a report says of a recording."""
    lasts_s, recorded_s = block.end_s - block.start_s, block.last_s - block.first_s
    return PlayedRecording(
        block.path,
        block.name,
        float(block.interval.start),
        float(block.interval.end),
        (block.start_s, block.end_s),
        recorded_s / lasts_s if lasts_s else 1.0,
        tuple(sorted(block.limbs)),
    )
