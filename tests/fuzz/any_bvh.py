"""What must hold of any bytes that are read as BVH; the fuzzer looks for a breach."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from azee.clip.bvh import decoded, parse_bvh
from azee.clip.bvh_hierarchy import BvhError
from azee.clip.digits import DIGITS, SIDES
from azee.clip.retarget import retarget
from azee.clip.retarget_source import RetargetError, measure_recording
from azee_rig.load import load_rig
from azee_rig.rig import Rig

LONGEST_MESSAGE = 250
FEW_FRAMES = 3
"""Recordings of more are measured and not carried over, so that no file takes long."""


def examine(data: bytes) -> None:
    """Read, measure and retarget; raises where anything but a message to the user comes."""
    try:
        recording = parse_bvh(decoded(data))
    except BvhError as error:
        _is_one_line(str(error))
        return
    assert len(set(recording.notes)) == len(recording.notes), "a note twice"
    assert len(set(recording.skeleton.names)) == len(recording.skeleton.names), "a name twice"
    places, turned = recording.frames()
    assert np.isfinite(places).all(), "places that are none"
    squares = np.swapaxes(turned, -1, -2) @ turned
    assert np.abs(squares - np.eye(3)).max() < 1e-6, "turns that are none"
    try:
        source = measure_recording(recording)
    except RetargetError as error:
        _is_one_line(str(error))
        return
    assert len(set(source.notes)) == len(source.notes), "a note twice"
    if len(source.times) > FEW_FRAMES:
        return
    body = _signer()
    made = retarget(source, body)
    c, q = body.coordinates, made.clip.coordinates
    assert ((q >= c.lower - 1e-9) & (q <= c.upper + 1e-9)).all(), "beyond the limits"
    assert set(made.tip_m) <= {f"{digit}_{side}" for digit in DIGITS for side in SIDES}
    assert all(np.isfinite(off).all() for off in made.tip_m.values())
    made.kept(body)


def _is_one_line(message: str) -> None:
    """Whatever the file holds, a user reads one sentence."""
    assert message.isprintable(), f"{message!r} has signs that are not printed"
    assert len(message) < LONGEST_MESSAGE, f"{message!r} is long"


@lru_cache(maxsize=1)
def _signer() -> Rig:
    return load_rig("signer")
