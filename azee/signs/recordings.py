"""The signs of a database as recordings that a score can play."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache

from azee.clip.clip import Clip
from azee.clip.edit import shifted
from azee.clip.retarget import retarget
from azee.clip.retarget_source import measure_clip
from azee.score.recorded_motion import RecordingError
from azee.score.score import Recorded
from azee.signs.database import SignDatabase
from azee.signs.fault import SignsError
from azee.signs.sign import Sign
from azee.signs.skeleton import StoredSkeleton
from azee_rig.load import load_rig, shipped_rigs
from azee_rig.rig import Rig


@dataclass(frozen=True, slots=True)
class StoredMotion:
    """The movement of a sign of a database, which is opened when the movement is played.

    place: of the database. digest: of what is played.
    """

    name: str
    digest: str
    place: str = field(compare=False)
    sign: Sign = field(compare=False, repr=False)

    def clip(self, rig: Rig) -> Clip:
        """Return it on a body, frames counted from 0; carried over if it is of another body.

        Raises: RecordingError: it cannot be read, or its body does not ship.
        """
        return _clip(self, rig)


@lru_cache(maxsize=256)
def _clip(motion: StoredMotion, rig: Rig) -> Clip:
    """Read a movement once for a body; the digest says whether it is still the same."""
    sign = motion.sign
    own = StoredSkeleton.of(rig).digest == sign.skeleton_digest
    if not own and sign.skeleton not in shipped_rigs():
        raise RecordingError(
            "other-skeleton",
            f"`{motion.name}` moves the body `{sign.skeleton}`, which does not ship",
            "add the file of the sign again with --rig",
        )
    body = rig if own else load_rig(sign.skeleton)
    try:
        with SignDatabase.open(motion.place) as database:
            clip = database.clip(sign, body)
    except SignsError as error:
        raise RecordingError(error.code, error.message, error.remedy) from error
    if not own:
        clip = retarget(measure_clip(clip, body), rig).clip
    return shifted(clip, -float(clip.times[0]))


@dataclass(frozen=True, slots=True)
class SignRecordings:
    """The signs of a database, by name. place: a file or a URL."""

    place: str

    def find(self, name: str, language: str | None, variant: str | None) -> Recorded:
        """Return the one sign that is meant, as a score of its own length.

        Raises: RecordingError: unknown-sign, sign-database.
        """
        try:
            with SignDatabase.open(self.place) as database:
                sign = database.one(name, language=language, variant=variant)
        except SignsError as error:
            raise RecordingError(error.code, error.message, error.remedy) from error
        return recorded(sign, self.place)


def recorded(sign: Sign, place: str) -> Recorded:
    """Return a sign of a database as a score of its own length."""
    timing = sign.facts.timing
    digest = f"{sign.digest}, turned to the viewer" if sign.facts.repositioned else sign.digest
    motion = StoredMotion(str(sign.identity), digest, place, sign)
    duration, attack, decay = (
        Fraction(seconds).limit_denominator(10**6)
        for seconds in (timing.duration_s, timing.attack_s, timing.decay_s)
    )
    return Recorded(duration, motion=motion, attack_s=attack, decay_s=min(decay, duration - attack))
