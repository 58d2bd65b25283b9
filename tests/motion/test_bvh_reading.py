"""BVH files of many makers give their joints; damaged ones give one clear message."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from azee.clip.bvh import BvhError, parse_bvh, read_bvh
from azee.clip.clip import Clip
from azee.export.formats.bvh import write_bvh
from azee_rig.rig import Rig

FIGURE = """HIERARCHY
ROOT Hips
{
	OFFSET 0 90 0
	CHANNELS 6 Zrotation Xrotation Yrotation Xposition Yposition Zposition
	JOINT Bip01 Spine
	{
		OFFSET 0 130 0
		CHANNELS 1 Zrotation
		JOINT Hand
		{
			OFFSET 0 20 0
			CHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation
			End Site
			{
				OFFSET 0 10 0
			}
		}
	}
}
MOTION
Frames: 2
Frame Time: 0.04
0 0 0 5 90 0 0 0 20 0 0 0 0
0 0 0 5 90 0 90 0 20 0 0 0 90
"""


def test_a_figure_with_joints_of_one_and_of_six_channels() -> None:
    read = parse_bvh(FIGURE)
    assert read.skeleton.names == ("Hips", "Bip01 Spine", "Hand")
    assert read.skeleton.parents.tolist() == [-1, 0, 1]
    assert read.notes == ("lengths are taken for cm: the figure is 1.60 m",)
    np.testing.assert_allclose(read.times, [0, 0.04])
    places, turned = read.frames()
    np.testing.assert_allclose(places[0], [[0.05, 0.9, 0], [0.05, 2.2, 0], [0.05, 2.4, 0]])
    np.testing.assert_allclose(places[1, 2], [-0.15, 2.2, 0], atol=1e-12)
    tip = places[1, 2] + turned[1, 2] @ read.tips[2]
    np.testing.assert_allclose(tip, [-0.15, 2.1, 0], atol=1e-12)


@pytest.mark.parametrize(
    "written",
    [
        FIGURE.replace("\n", "\r\n"),
        FIGURE.replace("\n", "\r"),
        "\ufeff" + FIGURE.replace("\t", "  "),
        FIGURE.replace("\n{", " {"),
        FIGURE.replace("HIERARCHY", "hierarchy").replace("ROOT", "Root"),
        FIGURE.replace("0.04", "0,04").replace("5 90", "5,0 90"),
        " ".join(FIGURE.split("MOTION")[0].split()) + "\nMOTION" + FIGURE.split("MOTION")[1],
    ],
    ids=["CRLF", "CR", "BOM, blanks", "braces", "cases", "commas", "one line"],
)
def test_the_same_figure_in_the_hand_of_other_exporters(written: str, tmp_path: Path) -> None:
    path = tmp_path / "figure.bvh"
    path.write_bytes(written.encode("utf-16" if "\ufeff" in written else "utf-8"))
    read, plain = read_bvh(path), parse_bvh(FIGURE)
    assert read.skeleton.names == plain.skeleton.names
    np.testing.assert_array_equal(read.frames()[0], plain.frames()[0])
    np.testing.assert_array_equal(read.times, plain.times)


@pytest.mark.parametrize(
    ("change", "note"),
    [
        (("Frames: 2", "Frames: 7"), "says 7 frames and has 2: 2 are kept"),
        (("20 0 0 0 90", "20 0"), "the last frame has 10 of 13 values"),
        (("Frame Time: 0.04", "Frame Time: 0"), "30 frames a second"),
        (("5 90 0 0 0 20", "5 0.5 0 0 0 20"), "`Hips` are taken as added to its OFFSET"),
        (("OFFSET 0 130 0", "OFFSET 0 5 0"), "no usual unit makes a person"),
    ],
)
def test_what_had_to_be_guessed_is_said(change: tuple[str, str], note: str) -> None:
    assert change[0] in FIGURE
    text = FIGURE.replace(*change)
    if "0.5" in change[1]:
        text = text.replace("5 90 0 90", "5 0.5 0 90")
    assert any(note in said for said in parse_bvh(text).notes)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("MOTION", ""), "no line MOTION"),
        (("OFFSET 0 20 0", "OFFSET 0 twenty 0"), "line 12: `twenty` is not a number"),
        (("5 90 0 90", "5 up 0 90"), "line 25: `up` is not a number"),
        (("1 Zrotation", "1 Wrotation"), "line 9: `Wrotation` is not a channel"),
        (("End Site\n\t\t\t{", "End Site\n\t\t\t"), "line"),
        (("}\nMOTION", "MOTION"), "before all its braces are closed"),
        (("0 0 0 5 90", "nan 0 0 5 90"), "infinite or not a number"),
        (("HIERARCHY", "<html>"), "`<html>` is not part"),
    ],
)
def test_a_damaged_file_has_one_clear_message(change: tuple[str, str], said: str) -> None:
    assert change[0] in FIGURE
    with pytest.raises(BvhError, match=said.replace("`", ".")):
        parse_bvh(FIGURE.replace(*change))


@given(st.integers(0, len(FIGURE)), st.integers(0, 60), st.text(max_size=12))
def test_any_damage_is_read_or_refused(start: int, length: int, instead: str) -> None:
    try:
        read = parse_bvh(FIGURE[:start] + instead + FIGURE[start + length :])
    except BvhError:
        return
    assert np.isfinite(read.frames()[0]).all()


def test_what_we_write_we_read(signer: Rig, tmp_path: Path) -> None:
    c = signer.coordinates
    rows = np.linspace(c.idle, 0.5 * (c.idle + c.upper), 5)
    clip = Clip(np.arange(5) / 30, rows, (), np.zeros((5, 0)))
    write_bvh(clip, signer, tmp_path / "clip.bvh")
    read = read_bvh(tmp_path / "clip.bvh")
    places, _ = read.frames()
    ours = signer.joint_positions(signer.pose(rows))
    order = [
        read.skeleton.names.index(n.replace(".", "_").replace("-", "_"))
        for n in signer.skeleton.names
    ]
    np.testing.assert_allclose(places[:, order], ours, atol=1e-6)
