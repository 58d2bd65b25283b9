"""A clip as a sign's motion: its bytes, its timing, and the body that it moves."""

from __future__ import annotations

import io

from azee.clip.archive import write_clip
from azee.clip.clip import Clip
from azee.clip.resample import rate
from azee.signs.sign import Timing
from azee_rig.rig import Rig


def packed(clip: Clip, rig: Rig) -> bytes:
    """Return a clip as the bytes of its file (docs/formats.md); the same clip, the same bytes."""
    file = io.BytesIO()
    write_clip(clip, rig, file)
    return file.getvalue()


def timing_of(clip: Clip, attack_s: float | None = None, decay_s: float | None = None) -> Timing:
    """Return how long a clip lasts as a sign.

    Args: attack_s, decay_s: by default a second each, or half of a shorter sign.
    Raises: SignsError: bad-sign: they do not fit into it.
    """
    return Timing.of(clip.duration_s, len(clip.times), rate(clip), attack_s, decay_s)
