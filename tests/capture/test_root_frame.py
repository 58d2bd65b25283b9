"""Markers in the root's frame do not hang on where the hand is in the room."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from azee.capture.markers import Markers, MarkersError
from azee.capture.root_frame import into_root, rigid, root_shape

ROOT = ("hand_top", "hand_left", "hand_right")


def some(recorded: Markers) -> Markers:
    return recorded.frames(slice(0, 60))


def test_a_hand_that_is_carried_through_the_room_has_the_same_poses(recorded: Markers) -> None:
    still = some(recorded)
    turns = Rotation.from_rotvec(np.linspace(0.0, 3.0, 60)[:, None] * [0.2, 0.9, -0.4]).as_matrix()
    at = np.einsum("tab,tmb->tma", turns, still.positions) + np.linspace(0, 2, 60)[:, None, None]
    carried = replace(still, positions=at)
    shape = root_shape(still, ROOT)
    first, second = into_root(still, shape), into_root(carried, shape)
    np.testing.assert_allclose(second.positions, first.positions, atol=1e-12)
    back = np.einsum("tab,tmb->tma", second.rotations, second.positions) + second.origins[:, None]
    np.testing.assert_allclose(back, at, atol=1e-12)


def test_the_rotation_is_a_rotation_though_three_markers_lie_in_a_plane() -> None:
    shape = np.array([[0.0, 0, 0], [0.05, 0, 0], [0, 0.03, 0]])
    R = Rotation.from_euler("xyz", [0.3, -1.0, 2.0]).as_matrix()
    found, shift = rigid(shape, (shape @ R.T + [1.0, 2.0, 3.0])[None])
    np.testing.assert_allclose(found[0], R, atol=1e-12)
    np.testing.assert_allclose(shift[0], [1.0, 2.0, 3.0], atol=1e-12)


def test_swapped_markers_of_the_root_are_put_right(recorded: Markers) -> None:
    still = some(recorded)
    shape = root_shape(still, ROOT)
    at = np.array(still.positions)
    a, b = (still.names.index(name) for name in ROOT[:2])
    at[20:23, [a, b]] = at[20:23, [b, a]]
    found = into_root(replace(still, positions=at), shape)
    np.testing.assert_allclose(found.positions, into_root(still, shape).positions, atol=1e-12)


def test_a_root_that_is_not_seen_is_interpolated_and_told(recorded: Markers) -> None:
    still = some(recorded)
    shape = root_shape(still, ROOT)
    at = np.array(still.positions)
    at[30:34, still.names.index(ROOT[0])] = np.nan
    found = into_root(replace(still, positions=at), shape)
    assert np.flatnonzero(~found.measured).tolist() == [30, 31, 32, 33]
    off = found.positions - into_root(still, shape).positions
    assert np.nanmax(np.abs(off[:, still.names.index("index_tip")])) < 0.02


def test_too_few_markers_or_markers_on_a_line_are_no_root(recorded: Markers) -> None:
    with pytest.raises(MarkersError, match="needs 3 markers, not 2"):
        root_shape(recorded, ROOT[:2])
    line = Markers(("a", "b", "c"), np.linspace(0, 1, 3)[None, :, None] * np.ones((4, 3, 3)), 50.0)
    with pytest.raises(MarkersError, match="lie on one line"):
        root_shape(line, ("a", "b", "c"))
