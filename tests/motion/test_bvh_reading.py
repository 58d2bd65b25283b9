"""BVH files of many makers give their joints; damaged ones give one clear message."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from bvh_figure import FIGURE
from hypothesis import given
from hypothesis import strategies as st

from azee.clip.bvh import parse_bvh, read_bvh
from azee.clip.bvh_hierarchy import LONGEST_SHOWN, BvhError
from azee.clip.bvh_motion import read_motion
from azee.clip.clip import Clip
from azee.export.formats.bvh import write_bvh
from azee_rig.rig import Rig


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
        (("0 20 0 0 0 0\n", "0 .5 0 0 0 0\n"), "2 joints, such as `Hips`, are taken as added"),
        (("OFFSET 0 130 0", "OFFSET 0 5 0"), "no usual unit makes a person"),
    ],
)
def test_what_had_to_be_guessed_is_said(change: tuple[str, str], note: str) -> None:
    assert change[0] in FIGURE
    text = FIGURE.replace(*change)
    if ".5" in change[1]:
        text = text.replace("0 20 0 0 0 90", "0 .5 0 0 0 90")
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
        (("0 0 0 5 90", "nan 0 0 5 90"), "line 24: `nan` is infinite or not a number"),
        (("0 0 0 5 90", "0 0 -1e300 5 90"), "line 24: `-1e300` is too large"),
        (("OFFSET 0 20 0", "OFFSET 0 2e200 0"), "line 12: `2e200` is too large"),
        (("OFFSET 0 20 0", "OFFSET 0 -inf 0"), "line 12: `-inf` is infinite"),
        (("HIERARCHY", "CHANNELS 3 Xrotation"), "line 1: CHANNELS outside of all joints"),
        (("OFFSET 0 10 0", "CHANNELS 1 Xrotation"), "line 16: CHANNELS outside of all joints"),
        (("HIERARCHY", "OFFSET 0 0 0"), "line 1: an OFFSET outside of all joints"),
        (("OFFSET 0 10 0", "JOINT a { }"), "line 16: a joint below an end site"),
        (("HIERARCHY", "End Site { OFFSET 0 0 0 }"), "line 1: an end site outside of all joints"),
        (("End Site", "End Site { End Site"), "line 14: an end site outside of all joints"),
        (("1 Zrotation", "1e9 Zrotation"), "line 9: `1e9` is no number of channels"),
        (("1 Zrotation", "-1 Zrotation"), "line 9: `-1` is no number of channels"),
        (("1 Zrotation", "1 Zrotation CHANNELS 1 Xrotation"), "line 9: a second CHANNELS"),
        (("6 Xposition Y", "6 Yposition Y"), "line 13: a joint has one position twice"),
        (("Spine\n\t{", "Spine\n\t"), "line 8: `OFFSET` where `{` should stand"),
        (("HIERARCHY", "<html>"), "line 1: `<html>` is not part"),
    ],
)
def test_a_damaged_file_has_one_clear_message(change: tuple[str, str], said: str) -> None:
    assert change[0] in FIGURE
    with pytest.raises(BvhError, match=said.replace("`", ".")):
        parse_bvh(FIGURE.replace(*change))


@pytest.mark.parametrize("above", [0, 1, 3])
def test_lines_are_counted_from_the_top_of_the_file(above: int) -> None:
    for wrong, line in (("OFFSET 0 20 0", 12), ("5 90 0 90", 25)):
        text = "\n" * above + FIGURE.replace(wrong, wrong.replace("0", "up"))
        with pytest.raises(BvhError, match=f"line {line + above}: .9?up. is "):
            parse_bvh(text)


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


def six_channel_figure(offset: str, hips: str, spine: str) -> str:
    """BVH of a figure below a root of its own, hips and spine with six channels each."""
    six = "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"
    three = "CHANNELS 3 Zrotation Xrotation Yrotation"
    return (
        f"HIERARCHY ROOT joint_Root {{ OFFSET 0 0 0 {six} JOINT Hips {{ OFFSET {offset} {six} "
        f"JOINT LeftLeg {{ OFFSET 9 -4 0 {three} End Site {{ OFFSET 0 -90 0 }} }} "
        f"JOINT Spine {{ OFFSET 0 25 0 {six} "
        f"JOINT Head {{ OFFSET 0 40 0 {three} End Site {{ OFFSET 0 20 0 }} }} }} }} }}\n"
        f"MOTION\nFrames: 1\nFrame Time: 0.04\n"
        f"0 0 0 0 0 0 {hips} 0 0 0 0 0 0 {spine} 0 0 0 0 0 0\n"
    )


@pytest.mark.parametrize(
    ("offset", "hips", "spine", "places", "notes"),
    [
        ("1 94 -452", "-1 93 -9", "0 25 0", [[-1, 93, -9], [-1, 118, -9]], 1),
        ("1 94 -452", "-1 93 -9", "0 1 0", [[0, 187, -461], [0, 213, -461]], 2),
        ("1 94 -452", "0 2 1", "0 0 0", [[1, 96, -451], [1, 121, -451]], 2),
        ("1 94 -452", "0 2 1", "0 24 0", [[0, 2, 1], [0, 26, 1]], 1),
    ],
)
def test_one_file_has_one_meaning_of_positions(
    offset: str, hips: str, spine: str, places: list[list[float]], notes: int
) -> None:
    """What carries the figure goes far from its OFFSET: joints that slide little tell."""
    read = parse_bvh(six_channel_figure(offset, hips, spine))
    np.testing.assert_allclose(read.frames()[0][0, [1, 3]], np.array(places) / 100, atol=1e-12)
    assert len(read.notes) == notes
    # The unit comes of the figure, not of how far from the origin it stands.
    assert read.notes[-1].startswith("lengths are taken for cm: the figure is 1.")


def test_a_tip_belongs_to_the_joint_that_its_end_site_stands_in() -> None:
    read = parse_bvh(six_channel_figure("0 94 0", "0 94 0", "0 25 0"), "cm")
    tips = {read.skeleton.names[joint]: tip.tolist() for joint, tip in read.tips.items()}
    assert tips == {"LeftLeg": pytest.approx([0, -0.9, 0]), "Head": pytest.approx([0, 0.2, 0])}


@pytest.mark.parametrize(
    ("hips", "added"), [("-1 93 -9", False), ("0 0 0", True), ("3 9 -20", True)]
)
def test_where_only_carriers_slide_zero_alone_is_added(hips: str, added: bool) -> None:
    text = six_channel_figure("1 94 -452", hips, "").replace(
        "0 25 0 CHANNELS 6 Xposition Yposition Zposition", "0 25 0 CHANNELS 3"
    )
    read = parse_bvh(text)
    assert any("added" in note for note in read.notes) == added


@pytest.mark.parametrize("length", [1, LONGEST_SHOWN, LONGEST_SHOWN + 1, 400])
def test_a_message_quotes_no_long_word(length: int) -> None:
    word = "x" * length
    with pytest.raises(BvhError) as refused:
        parse_bvh(FIGURE.replace("OFFSET 0 20 0", f"OFFSET 0 {word} 0"))
    quoted = word if length <= LONGEST_SHOWN else word[:LONGEST_SHOWN] + "…"
    assert f"`{quoted}` is not a number" in str(refused.value)


def test_a_message_quotes_forty_characters() -> None:
    for word, quoted in (("x" * 40, "x" * 40), ("x" * 41, "x" * 40 + "…")):
        with pytest.raises(BvhError, match=f"`{quoted}` is not a number"):
            parse_bvh(FIGURE.replace("OFFSET 0 20 0", f"OFFSET 0 {word} 0"))


@pytest.mark.parametrize("sign", ["", "-"])
def test_no_number_is_larger_than_a_thousand_millions(sign: str) -> None:
    large = FIGURE.replace("0 0 0 5 90", f"0 0 {sign}1e9 5 90")
    large = large.replace("OFFSET 0 10 0", f"OFFSET 0 {sign}1e9 0")
    assert parse_bvh(large, "mm").tips[2][1] == pytest.approx(float(f"{sign}1e6"))
    for place in ("0 0 0 5 90", "OFFSET 0 10 0"):
        text = FIGURE.replace(place, place.replace(" 0", f" {sign}1.0001e9", 1))
        assert text != FIGURE
        with pytest.raises(BvhError, match=f"`{sign}1.0001e9` is too large"):
            parse_bvh(text)


def test_a_joint_has_up_to_nine_channels() -> None:
    """Three of place, three of turn and three of scale."""
    nine = " ".join(f"{axis}{kind}" for kind in ("position", "rotation", "scale") for axis in "XYZ")
    head, motion = FIGURE.split("MOTION")
    rows = motion.replace("\n0 0 0 5 90 0", "\n5 90 0 0 0 0 1 1 1")
    for written, refused in ((f"9 {nine}", False), (f"10 {nine} Xscale", True)):
        channels = "6 Zrotation Xrotation Yrotation Xposition Yposition Zposition"
        text = f"{head.replace(channels, written)}MOTION{rows}"
        if refused:
            with pytest.raises(BvhError, match="line 5: `10` is no number of channels"):
                parse_bvh(text)
        else:
            np.testing.assert_array_equal(
                parse_bvh(text).frames()[0], parse_bvh(FIGURE).frames()[0]
            )


def test_a_joint_without_an_offset_stands_where_its_parent_does() -> None:
    text = FIGURE.replace("\t\tOFFSET 0 130 0\n", "")
    assert parse_bvh(text, "cm").skeleton.offsets[1].tolist() == [0.0, 0.0, 0.0]


def test_the_figure_of_the_thesis_is_read_as_it_is_printed() -> None:
    """Gürel 2010, figure B.1: one brace too many, and its first frame lacks a value."""
    three = "CHANNELS 3 Zrotation Xrotation Yrotation"
    arm = (
        "JOINT {0}Arm {{ OFFSET {1}5.00 2.00 1.00 {2} JOINT {0}Hand {{ OFFSET 0.00 -8.00 0.00 {2} "
        "End Site {{ OFFSET 0.00 -6.00 0.00 }} }} }} "
    )
    second = "0 0 0 0 5 0 -5 0 5 45 0 0 -90 0 0 0 -15 0 0 -135 0"
    text = (
        "HIERARCHY ROOT Hips { OFFSET 0 0 0 CHANNELS 6 Xposition Yposition Zposition Zrotation "
        f"Xrotation Yrotation JOINT Chest {{ OFFSET 0 8 0 {three} {arm.format('Left', '', three)}}}"
        f" {arm.format('Right', '-', three)}}} }}\nMOTION\nFrames: 2\nFrame Time: 0.05\n"
        + " ".join(["0.00"] * 20) + "\n" + second + "\n"
    )  # fmt: skip
    read = parse_bvh(text, "cm")
    brace, short = read.notes
    assert brace == "line 1: a `}` without its `{` is left out"
    assert short.startswith("line 5: a frame has 20 of 21 values: those that lack are taken from")
    np.testing.assert_allclose(read.rotations[0], np.tile([1.0, 0, 0, 0], (6, 1)), atol=1e-12)
    turned = {name: read.rotations[1, j] for j, name in enumerate(read.skeleton.names)}
    half = np.radians(45) / 2
    np.testing.assert_allclose(turned["LeftArm"], [np.cos(half), 0, 0, np.sin(half)], atol=1e-12)


@pytest.mark.parametrize(
    ("rows", "values", "notes"),
    [
        (["1 2 3", "4 5", "7 8 9"], [[1, 2, 3], [4, 5, 3], [7, 8, 9]], ["2 of 3 values: those"]),
        (["1 2 3", "4 5 6 0", "7 8 9"], [[1, 2, 3], [4, 5, 6], [7, 8, 9]], ["4 of 3 values: what"]),
        (["1 2 3", "4 5 6", "7"], [[1, 2, 3], [4, 5, 6]], ["the last frame has 1 of 3"]),
        (["1 2", "3 4", "5 6"], [[1, 2, 3], [4, 5, 6]], []),
        (["1 2 3 4 5 6", "7 8 9"], [[1, 2, 3], [4, 5, 6], [7, 8, 9]], []),
        (["1 2 3", "4", "5 6", "7 8", "9"], [[1, 2, 3], [4, 5, 6], [7, 8, 9]], []),
        (
            ["9", "1 2 3", "", "4 5", "4 5 6", "7 8 9", "0 0 0"],
            [[9, 2, 3], [1, 2, 3], [4, 5, 3], [4, 5, 6], [7, 8, 9], [0, 0, 0]],
            ["line 2: a frame has 1 of 3 values, as 1 further frames"],
        ),
    ],
)
def test_no_line_lends_another_its_values(
    rows: list[str], values: list[list[float]], notes: list[str]
) -> None:
    said: list[str] = []
    head = f"Frame Time: 0.04 Frames: {len(values)}\n"
    _, found = read_motion(head + "\n".join(rows), 0, 3, said)
    assert found.tolist() == values
    assert len(said) == len(notes)
    assert all(part in note for part, note in zip(notes, said, strict=True))


def test_joints_of_one_name_are_told_apart() -> None:
    text = FIGURE.replace("JOINT Hand", "JOINT Hips")
    read = parse_bvh(text)
    assert read.skeleton.names == ("Hips", "Bip01 Spine", "Hips_2")
    assert "2 joints are called `Hips`" in read.notes[0]
    text = text.replace("ROOT Hips", "ROOT Hips_2").replace("Bip01 Spine", "Hips")
    assert parse_bvh(text).skeleton.names == ("Hips_2", "Hips", "Hips_3")


@pytest.mark.parametrize(
    ("names", "told_apart", "said"),
    [
        ("a b a", "a b a_2", "2 joints are called `a`: they"),
        ("a b a b", "a b a_2 b_2", "2 joints are called `a` and 1 further names: they"),
        ("c b a b a b c", "c b a b_2 a_2 b_3 c_2", "called `c` and 2 further names: they"),
        ("a_2 a a a", "a_2 a a_3 a_4", "3 joints are called `a`: they"),
    ],
)
def test_a_note_tells_how_many_names_stand_twice(names: str, told_apart: str, said: str) -> None:
    joints = " } ".join(f"ROOT {n} {{ OFFSET 0 1 0 CHANNELS 1 Xrotation" for n in names.split())
    rows = " ".join("0" for _ in names.split())
    read = parse_bvh(f"HIERARCHY {joints} }}\nMOTION\nFrames: 1\nFrame Time: 1\n{rows}\n", "m")
    assert " ".join(read.skeleton.names) == told_apart
    assert said in read.notes[0]


def test_channels_of_scale_are_told_if_one_joint_has_them() -> None:
    first, rest = FIGURE.split("MOTION")
    assert first.count("CHANNELS") > 1
    scaling = first.replace("CHANNELS 6", "CHANNELS 7 Xscale", 1)
    assert scaling != first
    lines = rest.strip("\n").split("\n")
    rows = [f"1.0 {row}" for row in lines if row[:1] in "-0123456789"]
    text = scaling + "MOTION\n" + "\n".join([x for x in lines if x[:1].isalpha()] + rows) + "\n"
    told = "its channels of scale are left out"
    assert told in parse_bvh(text).notes
    assert told not in parse_bvh(FIGURE).notes
