"""A recording of a hand with all its markers, and a model of its first part."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from azee.capture.hand import Hand
from azee.capture.markers import Markers
from azee.capture.model import CaptureModel
from azee.capture.places import root_markers
from azee.capture.reading import read_markers
from azee.capture.training import Poses, poses_of, train
from azee_rig.rig import Rig

FILE = Path(__file__).with_name("optical_markers.npz")
LEARNT = 840
CHOSEN = ("thumb_tip", "index_tip", "middle_tip", "ring_tip", "little_tip", "ring_middle")


@pytest.fixture(scope="session")
def recorded() -> Markers:
    """One minute, 20 frames a second, 13 markers; the thumb's tip is missing now and then."""
    return read_markers(FILE)


@pytest.fixture(scope="session")
def poses(recorded: Markers) -> Poses:
    """Its first 42 s in the frame of the root."""
    return poses_of([recorded.frames(slice(0, LEARNT))], root_markers(recorded.names))


@pytest.fixture(scope="session")
def held_out(recorded: Markers) -> Markers:
    """Its last 18 s."""
    return recorded.frames(slice(LEARNT, None))


@pytest.fixture(scope="session")
def model(poses: Poses, signer: Rig) -> CaptureModel:
    """A model of the first part, for six markers."""
    return train(poses, CHOSEN, Hand(signer, "R"))


def away(made: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """How far markers are off, metres."""
    return np.asarray(np.linalg.norm(made - truth, axis=-1))
