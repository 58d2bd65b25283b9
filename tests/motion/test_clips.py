"""Clips are cut, joined, retimed, mirrored and stored without loss."""

from __future__ import annotations

import io
import json
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from unittest import mock

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from azee.clip.archive import ClipFileError, read_clip, write_clip
from azee.clip.blend import joined
from azee.clip.clip import Clip, Label
from azee.clip.edit import cut, left_handed, retimed, shifted
from azee.clip.resample import at_rate, sampled
from azee.clips import save_clip
from azee.export.formats.gltf.document import Document
from azee_rig.load import load_rig
from azee_rig.recover import recover
from azee_rig.rig import Rig

Floats = NDArray[np.float64]
RIG = load_rig("signer")
C = RIG.coordinates


@st.composite
def clips(draw: st.DrawFn) -> Clip:
    """Clips of a few frames, evenly spaced or not, anywhere inside the limits."""
    count = draw(st.integers(2, 9))
    random = np.random.default_rng(draw(st.integers(0, 10**6)))
    gaps = random.uniform(0.02, 0.2, count) if draw(st.booleans()) else np.full(count, 1 / 30)
    times = draw(st.sampled_from([0.0, 2.5])) + np.cumsum(gaps)
    q = C.idle + random.uniform(0, 1, (count, 1)) * (
        random.uniform(C.lower, C.upper, (count, len(C))) - C.idle
    )
    labels = (
        Label(("été",), float(times[0]), float(times[-1])),
        Label(("été", "b"), float(times[1]), float(times[1])),
    )
    units = ("eyeBlinkLeft", "mh_nose-left-elevation", "jawOpen")
    return Clip(times, q, units, random.uniform(0, 1, (count, 3)), labels)


def same(a: Clip, b: Clip, tolerance: float = 1e-12) -> None:
    assert a.units == b.units
    for name in ("times", "coordinates", "unit_weights"):
        np.testing.assert_allclose(getattr(a, name), getattr(b, name), rtol=0, atol=tolerance)


@given(clips())
@settings(max_examples=25)
def test_sampled_at_its_own_times_a_clip_is_itself(clip: Clip) -> None:
    same(sampled(clip, clip.times, C), clip, 0.0)


@given(clips(), st.data())
@settings(max_examples=25)
def test_what_is_cut_at_a_frame_and_joined_is_as_before(clip: Clip, data: st.DataObject) -> None:
    first, middle, last = (float(clip.times[i]) for i in (0, len(clip.times) // 2, -1))
    parts = cut(clip, first, middle, C), cut(clip, middle, last, C)
    whole = joined([p for p in parts if len(p.times) > 1] or [clip], C)
    same(whole, shifted(clip, -first))
    at = data.draw(st.floats(first, last))
    for part in (cut(clip, first, at, C), cut(clip, at, last, C)):
        assert {x.path[0] for x in part.labels} <= {"été"}
        assert all(0 <= x.start_s <= x.end_s <= last - first + 1e-9 for x in part.labels)


@given(clips())
@settings(max_examples=25)
def test_a_mirror_image_of_a_mirror_image_is_the_clip(clip: Clip) -> None:
    other = left_handed(clip, C)
    assert other.units == ("eyeBlinkRight", "mh_nose-right-elevation", "jawOpen")
    assert other.labels == clip.labels
    same(left_handed(other, C), clip, 0.0)


def test_the_mirror_image_stands_where_a_mirror_shows_it() -> None:
    random = np.random.default_rng(3)
    q = random.uniform(C.lower, C.upper, (6, len(C)))
    clip = Clip(np.arange(6.0), q, (), np.zeros((6, 0)))
    names = RIG.skeleton.names
    swap = str.maketrans("LR", "RL")
    other = [names.index(n[:-1] + n[-1].translate(swap) if n[-2] == "." else n) for n in names]
    here, there = (
        RIG.joint_positions(RIG.pose(c.coordinates)) for c in (clip, left_handed(clip, C))
    )
    # The body itself is symmetric to about a millimetre.
    assert np.abs(here[:, other] * (-1, 1, 1) - there).max() < 3e-3


@given(clips(), st.floats(0.05, 20))
@settings(max_examples=25)
def test_another_speed_and_back(clip: Clip, seconds: float) -> None:
    slow = retimed(clip, seconds)
    assert slow.duration_s == pytest.approx(seconds)
    assert slow.labels[0].end_s == pytest.approx(slow.times[-1])
    same(retimed(slow, clip.duration_s), clip, 1e-9)


@given(clips(), st.floats(5, 120))
@settings(max_examples=25)
def test_any_rate_stays_inside_the_limits(clip: Clip, fps: float) -> None:
    other = at_rate(clip, fps, C)
    np.testing.assert_allclose(np.diff(other.times), 1 / fps, rtol=1e-6)
    assert clip.times[-1] - other.times[-1] < 1 / fps + 1e-6
    assert (other.coordinates >= C.lower).all()
    assert (other.coordinates <= C.upper).all()
    assert (other.unit_weights <= 1).all()


@given(clips())
@settings(max_examples=25)
def test_a_stored_clip_is_read_back_exactly(clip: Clip) -> None:
    file, again = io.BytesIO(), io.BytesIO()
    write_clip(clip, RIG, file)
    write_clip(clip, RIG, again)
    assert file.getvalue() == again.getvalue()
    with TemporaryDirectory() as folder:
        path = Path(folder) / "x.npz"
        path.write_bytes(file.getvalue())
        read = read_clip(path, RIG)
    same(read, clip, 0.0)
    assert read.labels == clip.labels


def test_what_is_no_clip_is_refused_in_one_sentence(tmp_path: Path) -> None:
    clip = Clip(np.arange(3.0), np.tile(C.idle, (3, 1)), (), np.zeros((3, 0)))
    path = tmp_path / "x.npz"
    with path.open("wb") as file:
        write_clip(clip, RIG, file)
    whole = path.read_bytes()
    hostile = io.BytesIO()
    np.savez(hostile, header=np.array([{"format": "azee-clip-npz"}], dtype=object))
    plain = io.BytesIO()
    np.savez(plain, times=np.arange(3.0))
    single = io.BytesIO()
    np.save(single, np.arange(3.0))
    broken = [whole[:n] for n in (0, 4, 100, len(whole) // 2, len(whole) - 10)]
    flipped = bytearray(whole)
    flipped[len(whole) // 3] ^= 0xFF
    for data in (
        *broken,
        bytes(flipped),
        b"HIERARCHY\n",
        hostile.getvalue(),
        plain.getvalue(),
        single.getvalue(),
    ):
        path.write_bytes(data)
        with pytest.raises(ClipFileError, match=r"`.*x\.npz`"):
            read_clip(path, RIG)


@pytest.mark.parametrize(
    "change",
    [
        {"labels": [[["a"], float("nan"), 1.0]]},
        {"labels": [[[], 0.0, 1.0]]},
        {"labels": [["a"]]},
        {"units": ["jawOpen", "no such unit"]},
        {"coordinates": ["arm_X.flexion"]},
        {"version": 9},
        {"times": np.zeros((3, 1))},
        {"times": np.array([0.0, 0.0, 1.0])},
        {"times": np.array([0.0, np.nan, 1.0])},
        {"times": np.array([0.0, 1.0, 2.0 + 1j])},
    ],
    ids=str,
)
def test_a_clip_that_makes_no_sense_is_refused(change: dict[str, Any], tmp_path: Path) -> None:
    path = tmp_path / "x.npz"
    with path.open("wb") as file:
        clip = Clip(np.arange(3.0), np.tile(C.idle, (3, 1)), ("jawOpen",), np.zeros((3, 1)))
        write_clip(clip, RIG, file)
    arrays = dict(np.load(path))
    header = json.loads(arrays["header"].tobytes())
    header |= {key: value for key, value in change.items() if not isinstance(value, np.ndarray)}
    arrays |= {key: value for key, value in change.items() if isinstance(value, np.ndarray)}
    arrays["header"] = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    np.savez(path, **arrays)
    with pytest.raises(ClipFileError, match=r"`.*x\.npz`"):
        read_clip(path, RIG)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e9])
@pytest.mark.parametrize("where", ["times", "coordinates", "unit_weights", "labels"])
def test_a_clip_holds_numbers_of_bodies_and_clocks_only(where: str, bad: float) -> None:
    arrays: dict[str, Floats] = {
        "times": np.arange(3.0),
        "coordinates": np.tile(C.idle, (3, 1)),
        "unit_weights": np.zeros((3, 1)),
    }
    labels: tuple[Label, ...] = ()
    if where == "labels":
        labels = (Label(("a",), 0.0, bad),)
    else:
        arrays[where][(-1,) * arrays[where].ndim] = bad
    with pytest.raises(ValueError, match=r"times|coordinates|weights of the face|labels"):
        Clip(arrays["times"], arrays["coordinates"], ("jawOpen",), arrays["unit_weights"], labels)


@pytest.mark.parametrize("step_s", [1e-8, 9e-6])
def test_frames_that_no_clock_tells_apart_make_no_clip(step_s: float) -> None:
    with pytest.raises(ValueError, match=r"frames follow each other every .* the least is 1e-05"):
        Clip(np.arange(4.0) * step_s, np.tile(C.idle, (4, 1)), (), np.zeros((4, 0)))
    with pytest.raises(ValueError, match="the least is"):
        retimed(Clip(np.arange(4.0), np.tile(C.idle, (4, 1)), (), np.zeros((4, 0))), 3 * step_s)


@pytest.mark.parametrize(
    ("name", "values", "said"),
    [
        ("times", 1e-8 * np.arange(3.0), "frames follow each other every 1e-08 s"),
        ("times", np.array([0.0, 2.0, 1.0]), "times do not increase"),
        ("coordinates", np.full((3, len(C)), np.nan), "holds numbers that are none"),
        ("unit_weights", np.full((3, 1), 1e30), "weights of the face are as large as 1e\\+30"),
    ],
)
def test_a_stored_clip_that_no_clip_could_be_says_why(
    name: str, values: Floats, said: str, tmp_path: Path
) -> None:
    path = tmp_path / "x.npz"
    with path.open("wb") as file:
        clip = Clip(np.arange(3.0), np.tile(C.idle, (3, 1)), ("jawOpen",), np.zeros((3, 1)))
        write_clip(clip, RIG, file)
    np.savez(path, **(dict(np.load(path)) | {name: values}))
    with pytest.raises(ClipFileError, match=said):
        read_clip(path, RIG)


def test_a_cut_takes_the_place_of_a_frame_a_rounding_error_away() -> None:
    clip = Clip(np.arange(5.0), np.tile(C.idle, (5, 1)), (), np.zeros((5, 0)))
    part = cut(clip, 1.0 - 1e-9, 3.0 + 1e-9, C)
    assert part.times == pytest.approx([0.0, 1.0, 2.0], abs=1e-8)
    assert len(cut(clip, 2.0, 2.0 + 1e-9, C).times) == 1


def test_no_writer_lets_through_what_is_no_number(tmp_path: Path) -> None:
    """A clip is checked when it is made; a body whose lengths are none is not."""
    offsets = np.array(RIG.skeleton.offsets)
    offsets[5, 1] = np.inf
    broken = replace(RIG, skeleton=replace(RIG.skeleton, offsets=offsets))
    clip = Clip(np.arange(3.0), np.tile(C.idle, (3, 1)), (), np.zeros((3, 0)))
    for suffix in (".bvh", ".json", ".glb"):
        path = tmp_path / f"x{suffix}"
        with pytest.raises(ValueError, match=r"numbers|JSON"), np.errstate(all="ignore"):
            save_clip(clip, broken, path)
        assert not path.exists()
    with pytest.raises(ValueError, match="glTF holds no infinite numbers"):
        Document("azee").accessor(np.array([1.0, np.nan], np.float32))


def test_coordinates_come_back_from_the_joints(signer: Rig) -> None:
    random = np.random.default_rng(1)
    reach = np.repeat([0.3, 0.9, 1.0], 8)[:, None]
    q = C.idle + reach * (random.uniform(C.lower, C.upper, (24, len(C))) - C.idle)
    found = recover(signer, signer.pose(q).rotations)
    assert found.error_rad.max() < 1e-8
    assert np.abs(found.coordinates - q).max() < 1e-7


def test_rotations_that_a_file_has_rounded_take_few_steps(signer: Rig) -> None:
    """What rounding took away no step brings back: six are needed, 23 were made."""
    q = np.array(C.idle)
    q[C.index["arm_R.flexion"]] += 0.01
    rounded = np.round(signer.pose(q[None]).rotations, 8)
    with mock.patch("azee_rig.recover.np.linalg.solve", wraps=np.linalg.solve) as solved:
        found = recover(signer, rounded)
    assert solved.call_count < 10
    assert np.abs(found.coordinates - q).max() < 1e-7
