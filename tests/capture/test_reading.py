"""Files of markers: what is in them, and one clear message where they are something else."""

from __future__ import annotations

import io
import warnings
from pathlib import Path

import c3d
import numpy as np
import pytest

from azee.capture.markers import Markers, MarkersError, named_like
from azee.capture.reading import read_markers

NAMES = ("thumb_tip", "index_tip")
POSITIONS = np.arange(18.0).reshape(3, 2, 3)


def trc(
    names: tuple[str, ...] = NAMES, positions: np.ndarray = POSITIONS, rate: float = 50.0,
    said: float | None = None, unit: str = "mm",
) -> str:  # fmt: skip
    """Write a TRC; what is NaN is left empty."""
    lines = [
        "PathFileType\t4\t(X/Y/Z)\thand.trc",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits",
        f"{said or rate}\t{rate}\t{len(positions)}\t{len(names)}\t{unit}",
        "Frame#\tTime\t" + "\t\t\t".join(names),
        "\t\t" + "\t".join(f"{a}{n + 1}" for n in range(len(names)) for a in "XYZ"),
        "",
    ]
    for t, frame in enumerate(positions):
        cells = ["" if np.isnan(x) else f"{x:.6f}" for x in frame.ravel()]
        lines.append("\t".join([str(t + 1), f"{t / rate:.5f}", *cells]))
    return "\n".join(lines) + "\n"


def c3d_bytes(positions: np.ndarray) -> bytes:
    """Write a C3D with the library; what is NaN has the residual −1."""
    writer = c3d.Writer(point_rate=50.0)
    writer.set_point_labels(list(NAMES))
    for frame in positions:
        points = np.zeros((len(frame), 5))
        points[:, :3] = np.nan_to_num(frame)
        points[:, 3] = np.where(np.isnan(frame[:, 0]), -1.0, 0.0)
        writer.add_frames([(points, np.zeros((0, 0)))])
    file = io.BytesIO()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of analog data, which there are none
        writer.write(file)
    return file.getvalue()


def with_a_gap() -> np.ndarray:
    positions = POSITIONS.copy()
    positions[1, 0] = np.nan
    return positions


def test_a_trc_has_the_markers_in_metres(tmp_path: Path) -> None:
    path = tmp_path / "hand.trc"
    path.write_text(trc(positions=with_a_gap()))
    found = read_markers(path)
    assert (found.names, found.rate_hz) == (NAMES, 50.0)
    np.testing.assert_allclose(found.positions, 0.001 * with_a_gap())
    assert found.source.startswith("hand.trc sha256:")
    np.testing.assert_allclose(read_markers(path, unit="m").positions, with_a_gap())


def test_a_c3d_has_the_markers_in_metres(tmp_path: Path) -> None:
    path = tmp_path / "hand.c3d"
    path.write_bytes(c3d_bytes(with_a_gap()))
    found = read_markers(path)
    assert (found.names, found.rate_hz) == (NAMES, 50.0)
    np.testing.assert_allclose(found.positions, 0.001 * with_a_gap(), atol=1e-6)


def test_an_archive_may_say_unit_and_rate(tmp_path: Path) -> None:
    path = tmp_path / "hand.npz"
    np.savez(path, markers=POSITIONS, names=NAMES, rate_hz=50.0, unit="cm")
    np.testing.assert_allclose(read_markers(path).positions, 0.01 * POSITIONS)
    assert read_markers(path, rate_hz=25.0).rate_hz == 25.0
    np.savez(path, markers=POSITIONS, names=NAMES)
    with pytest.raises(MarkersError, match="does not say its frames a second"):
        read_markers(path)


WRONG: dict[str, tuple[str, bytes, str]] = {
    "text": ("x.trc", b"hello", "it is no TRC"),
    "bytes": ("x.trc", b"\xff\xfe\x00\xd8", "it is not text"),
    "rate": ("x.trc", trc(said=60.0).encode(), "its times go at 50 a second"),
    "no rate": ("x.trc", trc(said=1e9).encode(), "its times go at 50"),
    "unit": ("x.trc", trc(unit="furlong").encode(), "`furlong` is no unit of length"),
    "count": ("x.trc", trc().replace("\t2\tmm", "\t3\tmm").encode(), "line 4 names 2 markers"),
    "number": (
        "x.trc",
        trc().replace("7.000000", "seven").encode(),
        "line 8: `seven` is no number",
    ),
    "columns": ("x.trc", trc().replace("5.000000", "5\t5").encode(), "line 7 has more columns"),
    "twice": ("x.trc", trc(names=("a", "a")).encode(), "two markers are called `a`"),
    "far": ("x.trc", trc(positions=1e9 * POSITIONS).encode(), "more than 1000 m away"),
    "no c3d": ("x.c3d", b"\x02\x50" + bytes(600), "no C3D"),
    "cut c3d": ("x.c3d", c3d_bytes(POSITIONS)[:700], "no C3D, or it is damaged"),
    "no archive": ("x.npz", b"PK\x03\x04", "no NumPy archive"),
    "suffix": ("x.fbx", b"Kaydara", "is none of .c3d .trc .npz"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_with_a_file_is_said_in_one_message(name: str, tmp_path: Path) -> None:
    file, data, message = WRONG[name]
    (tmp_path / file).write_bytes(data)
    with pytest.raises(MarkersError, match=message) as raised:
        read_markers(tmp_path / file)
    assert file in str(raised.value)


def test_a_clip_is_no_archive_of_markers(tmp_path: Path) -> None:
    np.savez(tmp_path / "clip.npz", coordinates=POSITIONS)
    with pytest.raises(MarkersError, match="an archive of them has `markers`, `names`"):
        read_markers(tmp_path / "clip.npz")


def test_names_that_differ_in_writing_only_are_the_same() -> None:
    markers = Markers(("Ann:Index-Tip", "Ann:Thumb Tip", "object"), np.zeros((2, 3, 3)), 50.0)
    assert named_like(markers, NAMES).names == ("index_tip", "thumb_tip", "object")
    both = Markers(("Index-Tip", "index_tip"), np.zeros((2, 2, 3)), 50.0)
    assert named_like(both, NAMES).names == both.names


def test_a_marker_that_is_not_there_is_named_with_those_that_are() -> None:
    with pytest.raises(MarkersError, match="no marker `ring_tip`; there are: thumb_tip, index_tip"):
        Markers(NAMES, POSITIONS, 50.0).only(["ring_tip"])
