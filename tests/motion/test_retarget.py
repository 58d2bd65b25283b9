"""Motion on another body: hands where they were, palms as they were turned, no jumps."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from itertools import pairwise, product
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from carried_over import hands_seen, posed, stick_figure, turn_deg
from formats import schema

from azee.cli.main import run
from azee.clip import retarget as retargeting
from azee.clip.bvh import parse_bvh, read_bvh
from azee.clip.clip import Clip
from azee.clip.retarget import Retargeted, as_it_was, retarget, smoothed
from azee.clip.retarget_source import RetargetError, measure_clip, measure_recording
from azee.clips import open_clip
from azee.export.formats.bvh import write_bvh
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_rig.rotation import about_axis

FRAMES = 40


@pytest.fixture(scope="module")
def clip(signer: Rig) -> Clip:
    """Hands that meet before the body and part again, the head turned, fists that open."""
    c = signer.coordinates
    rest, met = np.array(c.idle), np.array(c.idle)
    for side in "LR":
        for name, degrees in (("arm_{}.flexion", 35), ("arm_{}.rotation", 50),
                              ("f_arm_{}.flexion", 95), ("f_arm_{}.pronation", 60),
                              ("palm_{}.flexion", 20), ("index_{}_1.flexion", 70),
                              ("middle_{}_2.flexion", 90)):  # fmt: skip
            met[c.index[name.format(side)]] = np.radians(degrees)
    met[c.index["head.axial"]] = met[c.index["neck.axial"]] = np.radians(15)
    met[c.index["back_1.flexion"]] = np.radians(8)
    share = 0.5 - 0.5 * np.cos(np.linspace(0, 2 * np.pi, FRAMES))
    q = rest + share[:, None] * (met - rest)
    return Clip(np.arange(FRAMES) / 30, q, (), np.zeros((FRAMES, 0)))


@pytest.mark.parametrize("body", ["child", "game"])
def test_hands_stay_where_they_were_on_another_body(signer: Rig, clip: Clip, body: str) -> None:
    other = load_rig(body)
    made = retarget(measure_clip(clip, signer), other)
    places, palms = hands_seen(signer, clip.coordinates)
    there, turned = hands_seen(other, made.clip.coordinates)
    assert np.linalg.norm(there - places, axis=-1).max() < 0.03
    assert turn_deg(turned, palms).max() < 5
    assert np.degrees(np.abs(np.diff(made.clip.coordinates, axis=0)).max()) < 12


def test_a_bvh_under_our_own_names_comes_back(signer: Rig, clip: Clip, tmp_path: Path) -> None:
    """Through nothing but names and places of joints, as any BVH is read."""
    write_bvh(clip, signer, tmp_path / "clip.bvh")
    made = retarget(measure_recording(read_bvh(tmp_path / "clip.bvh")), signer)
    places, palms = hands_seen(signer, clip.coordinates)
    there, turned = hands_seen(signer, made.clip.coordinates)
    assert np.linalg.norm(there - places, axis=-1).max() < 0.03
    assert turn_deg(turned, palms).max() < 5
    c = signer.coordinates
    for name in ("index_L_1.flexion", "middle_R_2.flexion", "head.axial"):
        off = made.clip.coordinates[:, c.index[name]] - clip.coordinates[:, c.index[name]]
        assert np.degrees(np.abs(off).max()) < 8, name


@pytest.mark.long
def test_the_command_tells_what_was_kept(
    signer: Rig, clip: Clip, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_bvh(clip, signer, tmp_path / "clip.bvh")
    out = tmp_path / "child.npz"
    assert run(["retarget", str(tmp_path / "clip.bvh"), "-o", str(out), "--rig", "child"]) == 0
    assert f"hands are where they were in all {FRAMES} frames" in capsys.readouterr().err
    assert out.exists()
    (tmp_path / "bad.bvh").write_text("HIERARCHY\nROOT a\n", encoding="utf-8")
    assert run(["retarget", str(tmp_path / "bad.bvh"), "-o", str(out)]) == 1
    assert "error[not-a-clip]" in capsys.readouterr().err


@pytest.mark.long
def test_a_clip_command_carries_another_skeletons_motion_over(
    signer: Rig, clip: Clip, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = load_rig("game")
    write_bvh(retarget(measure_clip(clip, signer), other).clip, other, tmp_path / "theirs.bvh")
    assert (
        run(["clip", "convert", str(tmp_path / "theirs.bvh"), "-o", str(tmp_path / "x.npz")]) == 0
    )
    said = capsys.readouterr().err
    assert f"carried over to `signer`: hands are where they were in all {FRAMES} frames" in said


def still(signer: Rig, frames: int = 3) -> Clip:
    q = np.tile(signer.coordinates.idle, (frames, 1))
    return Clip(np.arange(frames) / 30, q, (), np.zeros((frames, 0)))


@pytest.mark.parametrize(
    ("share", "palm_deg", "tip_mm", "hands", "tips"),
    [
        (0.029, 4.9, 2.9, "in all 3 frames", "within 3 mm"),
        (0.029, 5.0, 3.0, "in all 3 frames", "within 3 mm"),
        (0.031, 4.9, 2.9, "in 2 of 3 frames; .* to 3 % of its arm's length and 5° off", "within"),
        (0.029, 5.1, 2.9, "in 2 of 3 frames", "within 3 mm"),
        (0.2, 20.0, 3.1, "up to 20 % of its arm's length and 20° off", "up to: index 3 mm"),
    ],
)  # fmt: skip
def test_what_is_kept_is_within_3_percent_5_degrees_and_3_mm(
    signer: Rig, share: float, palm_deg: float, tip_mm: float, hands: str, tips: str
) -> None:
    off = np.zeros((3, 2))
    off[1, 0] = 1.0
    made = Retargeted(
        still(signer),
        off * share * signer.landmarks.arm_m,
        off * np.radians(palm_deg),
        {"index_L": off[:, 0] * tip_mm / 1e3},
    )
    assert re.search(f"{hands}.*{tips}", made.kept(signer), re.DOTALL)


def test_of_each_digit_the_worse_of_both_hands_is_told(signer: Rig) -> None:
    one = np.array([0.0, 1e-3, 0.0])
    tips = {"thumb_L": 2 * one, "index_L": 4 * one, "thumb_R": one, "index_R": 6 * one}
    made = replace(as_it_was(still(signer)), tip_m=tips)
    assert made.kept(signer).endswith("off in the palm by up to: thumb 2 mm, index 6 mm")
    assert replace(made, tip_m={}).kept(signer).endswith("; no finger is carried over")


def test_the_report_tells_the_mean_and_the_most_that_each_part_is_off(signer: Rig) -> None:
    off = np.array([[0.01, 0.0], [0.02, 0.4], [0.06, 0.2]])
    made = Retargeted(still(signer), off, off[:, ::-1], {"index_L": off[:, 0]})
    assert made.report(signer) == {
        "rig": "signer",
        "frames": 3,
        "arm_m": signer.landmarks.arm_m,
        "hands": {
            "L": {
                "wrist_m": {"mean": pytest.approx(0.03), "max": 0.06},
                "palm_rad": {"mean": pytest.approx(0.2), "max": 0.4},
            },
            "R": {
                "wrist_m": {"mean": pytest.approx(0.2), "max": 0.4},
                "palm_rad": {"mean": pytest.approx(0.03), "max": 0.06},
            },
        },
        "digits": {"index_L": {"tip_m": {"mean": pytest.approx(0.03), "max": 0.06}}},
    }


def test_a_clip_is_as_it_was_if_neither_hands_nor_fingers_are_off(signer: Rig) -> None:
    made = as_it_was(still(signer))
    assert made.is_as_it_was
    assert made.kept(signer).startswith("hands are where they were in all 3 frames")
    off = np.array([[0.0, 0.0], [0.0, 1e-4], [0.0, 0.0]])
    tips = {**made.tip_m, "ring_L": off[:, 1]}
    for change in (
        replace(made, wrist_m=off), replace(made, palm_rad=off), replace(made, tip_m=tips)
    ):  # fmt: skip
        assert not change.is_as_it_was


def test_between_ways_the_cheapest_of_all_paths_is_taken(signer: Rig, clip: Clip) -> None:
    """Of two ways over five frames; the cost is that of errors and of haste between frames."""
    frames = 5
    part = Clip(clip.times[:frames], clip.coordinates[10 : 10 + frames], (), np.zeros((frames, 0)))
    arms = retargeting._Arms(signer, measure_clip(part, signer), part.coordinates)
    wish = part.coordinates
    one, other = wish.copy(), wish.copy()
    columns = arms.columns.ravel()
    one[:, columns] += np.radians([[0.1], [0.2], [2.0], [2.5], [2.5]])
    other[:, columns] += np.radians([[2.5], [2.2], [1.6], [0.2], [0.1]])
    found = arms.steadiest([one, other], wish)
    ways = np.stack([one, other])
    cost = np.stack([arms._residual(way, wish)[0] for way in ways])
    for s, own in enumerate(arms.columns):
        best, path = min(
            (
                sum(cost[w, t, s] for t, w in enumerate(path))
                + sum(
                    (((ways[b][t + 1, own] - ways[a][t, own]) / retargeting.HASTE_RAD) ** 2).sum()
                    for t, (a, b) in enumerate(pairwise(path))
                ),
                path,
            )
            for path in product((0, 1), repeat=frames)
        )
        assert np.isfinite(best)
        assert len(set(path)) == 2  # it changes between the ways
        np.testing.assert_array_equal(found[:, own], ways[path, np.arange(frames)][:, own])


@pytest.mark.parametrize(("lean_deg", "straight"), [(19.0, True), (21.0, False)])
def test_a_figure_that_leans_a_little_stands_straight(lean_deg: float, straight: bool) -> None:
    head = f"OFFSET 0 60 {60 * np.tan(np.radians(lean_deg)):.6f}"
    upright, leaning = (
        measure_recording(parse_bvh(stick_figure(2, ("OFFSET 0 60 0", offset))))
        for offset in ("OFFSET 0 60 0", head)
    )
    off = np.abs(leaning.palms - upright.palms).max()
    assert (off < 1e-6) == straight


def test_hands_without_fingers_are_told() -> None:
    found = measure_recording(parse_bvh(stick_figure(2)))
    *_, bare, left_out = found.notes
    assert bare.startswith("no fingers (")
    assert left_out == "where the body goes and how its legs move is left out"
    assert isinstance(found.notes, tuple)


def test_digits_that_a_body_lacks_are_not_measured(signer: Rig, clip: Clip) -> None:
    lacking = {f"index_R_{k}" for k in (1, 2, 3)}
    bones = {name: bone for name, bone in signer.bones.items() if name not in lacking}
    names = tuple(name.replace("index_R", "bump_R") for name in signer.coordinates.names)
    body = replace(signer, bones=bones, coordinates=replace(signer.coordinates, names=names))
    found = {digit.name for digit in measure_clip(clip, body).digits}
    whole = {digit.name for digit in measure_clip(clip, signer).digits}
    assert len(whole) == 10
    assert whole - found == {"index_R"}


def test_a_figure_of_any_size_makes_the_same_movement(signer: Rig) -> None:
    """Told in millimetres, hers is an arm of five centimetres."""
    text = stick_figure(4)
    large, small = (measure_recording(parse_bvh(text, unit)) for unit in ("cm", "mm"))
    assert small.arm_m == pytest.approx(large.arm_m / 10)
    assert small.arm_m < 0.1
    made = [retarget(source, signer).clip.coordinates for source in (large, small)]
    np.testing.assert_allclose(made[1], made[0], atol=1e-4)


@pytest.mark.long
@pytest.mark.parametrize("frames", [1, 2, 3, 4, 8, 9])
def test_any_number_of_frames_can_be_retargeted(
    signer: Rig, frames: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "few.bvh"
    path.write_text(stick_figure(frames), encoding="ascii")
    assert run(["retarget", str(path), "-o", str(tmp_path / "few.npz")]) == 0
    assert run(["clip", "convert", str(path), "-o", str(tmp_path / "same.bvh")]) == 0
    assert f"s, {frames} frames" in capsys.readouterr().err
    assert len(read_bvh(tmp_path / "same.bvh").times) == frames


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("28 0 0", "0 0 0"), "the upper arm L has no length"),
        (("-25 0 0", "0 1e-320 0"), "the forearm R has no length"),
        (("15 45 0", "0 45 0"), "the line of the shoulders has no length"),
        (("0 60 0", "0 0 0"), "the way from the hips to the head has no length"),
    ],
)
def test_a_body_that_tells_no_directions_is_refused(change: tuple[str, str], said: str) -> None:
    text = stick_figure(3, change)
    if change[0] == "15 45 0":
        text = text.replace("-0 45", "0 45")
    with pytest.raises(RetargetError, match=said):
        measure_recording(parse_bvh(text))


def test_shoulders_on_top_of_each_other_are_refused() -> None:
    text = stick_figure(3, ("OFFSET -15 45 0", "OFFSET 15 20 0"))
    with pytest.raises(RetargetError, match="one shoulder stands above the other"):
        measure_recording(parse_bvh(text))


def test_arms_without_length_are_refused_in_words(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, out = tmp_path / "short.bvh", tmp_path / "x.npz"
    path.write_text(stick_figure(3, ("28 0 0", "0 0 0")), encoding="ascii")
    for command in (["retarget"], ["clip", "convert"]):
        assert run([*command, str(path), "-o", str(out)]) == 1
        assert "error[not-a-clip]" in capsys.readouterr().err
    assert not out.exists()


def test_smoothing_is_a_matter_of_time_not_of_frames() -> None:
    """A clip of a millisecond a frame is smoothed over the same time as one of a thirtieth."""
    rng = np.random.default_rng(2)
    for step in (0.001, 1 / 30):
        times = np.linspace(0.0, 900 * step, 901)
        wave = np.sin(2 * np.pi * times / 0.3)[:, None]
        inner = (times > 0.3) & (times < times[-1] - 0.3)
        assert np.abs(smoothed(wave, times)[inner]).max() < 0.25
    uneven = rng.uniform(0.01, 0.08, 50).cumsum()
    assert smoothed(uneven[:, None], uneven)[0, 0] == uneven[0]
    assert smoothed(np.ones((50, 1)), uneven) == pytest.approx(np.ones((50, 1)))


@pytest.mark.parametrize(
    ("name", "data", "kind"),
    [
        ("walk.fbx", b"Kaydara FBX Binary  \x00\x1a\x00", "FBX"),
        ("walk.bvh", b"Kaydara FBX Binary  \x00\x1a\x00", "FBX"),
        ("text.fbx", b"; FBX 7.3.0 project file\n", "FBX"),
        ("walk.c3d", b"\x02P", "C3D"),
        ("clip.json", b"{}", "JSON"),
    ],
)
def test_what_is_no_bvh_is_named_with_a_remedy(
    name: str, data: bytes, kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / name).write_bytes(data)
    for command in (["retarget"], ["clip", "convert"]):
        assert run([*command, str(tmp_path / name), "-o", str(tmp_path / "x.npz")]) == 1
        said = capsys.readouterr().err
        assert f"`{tmp_path / name}` is {kind}; motion is read from BVH and glTF of any" in said
        assert "Blender does" in said


@pytest.mark.long
def test_bvh_is_known_whatever_its_suffix(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, text in (("a.txt", stick_figure(2)), ("b", "\ufeff\n" + stick_figure(2))):
        (tmp_path / name).write_bytes(text.encode("utf-16" if name == "b" else "ascii"))
        assert run(["retarget", str(tmp_path / name), "-o", str(tmp_path / "x.npz")]) == 0
    (tmp_path / "c.txt").write_text("nothing of the kind", encoding="ascii")
    capsys.readouterr()
    assert run(["retarget", str(tmp_path / "c.txt"), "-o", str(tmp_path / "x.npz")]) == 1
    assert "is not a clip that azee wrote" in capsys.readouterr().err
    assert run(["retarget", str(tmp_path / "none.bvh"), "-o", str(tmp_path / "x.npz")]) == 1
    assert "there is no file" in capsys.readouterr().err


@pytest.mark.slow
def test_the_report_keeps_to_its_schema(signer: Rig, clip: Clip, tmp_path: Path) -> None:
    write_bvh(clip, signer, tmp_path / "clip.bvh")
    text = (tmp_path / "clip.bvh").read_text(encoding="ascii").replace("JOINT finger", "JOINT f")
    (tmp_path / "theirs.bvh").write_text(text, encoding="ascii")
    for name, digits in (("clip", 10), ("theirs", 0)):
        arguments = ["--report", str(tmp_path / "r.json"), "-o", str(tmp_path / "x.npz")]
        assert run(["retarget", str(tmp_path / f"{name}.bvh"), *arguments, "--rig", "child"]) == 0
        report = json.loads((tmp_path / "r.json").read_text(encoding="utf-8"))
        jsonschema.validate(report, schema("retarget"))
        assert report.keys() == schema("retarget")["properties"].keys()
        assert len(report["digits"]) == digits
        assert report["frames"] == FRAMES
        assert report["hands"]["L"]["wrist_m"]["max"] < 0.03 * report["arm_m"]


@pytest.mark.slow
def test_bvh_of_another_body_that_ships_is_that_bodys_clip(
    signer: Rig, clip: Clip, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Exactly: eyes and shoulders too, which no skeleton of others tells."""
    c = signer.coordinates
    q = np.array(clip.coordinates)
    q[:, c.index["eye_L.yaw"]] = q[:, c.index["eye_R.yaw"]] = 0.2
    write_bvh(Clip(clip.times, q, (), np.zeros((FRAMES, 0))), signer, tmp_path / "clip.bvh")
    out = tmp_path / "x.npz"
    assert run(["retarget", str(tmp_path / "clip.bvh"), "--rig", "child", "-o", str(out)]) == 0
    assert "no usual unit" not in capsys.readouterr().err
    made = open_clip(out)
    assert made.rig.name == "child"
    moved = made.clip.coordinates[:, made.rig.coordinates.index["eye_L.yaw"]]
    assert moved == pytest.approx(0.2, abs=1e-6)


@pytest.mark.long
def test_no_joint_goes_from_limit_to_limit_in_a_frame(signer: Rig) -> None:
    """Palms that turn once round, which no forearm does: it must go back, and takes its time."""
    still = posed(signer, 60, {
        "arm_{}.flexion": 35, "f_arm_{}.flexion": 95, "f_arm_{}.pronation": 60
    })  # fmt: skip
    source = measure_clip(still, signer)
    turn = about_axis(1, np.linspace(0, 2 * np.pi, 60))
    made = retarget(replace(source, palms=source.palms @ turn[:, None]), signer)
    q = made.clip.coordinates
    columns = [signer.coordinates.index[f"f_arm_{side}.pronation"] for side in "LR"]
    assert np.degrees(np.ptp(q[:, columns], axis=0)).min() > 150
    assert np.degrees(np.abs(np.diff(q, axis=0)).max()) < 60


def test_elbows_of_the_same_body_are_where_they_were(signer: Rig) -> None:
    """Wrist and palm leave the arm free to turn about the line from shoulder to wrist."""
    source = measure_clip(posed(signer, 2, {
        "arm_{}.flexion": 30, "arm_{}.abduction": 70, "arm_{}.rotation": 80,
        "f_arm_{}.flexion": 110, "f_arm_{}.pronation": 60,
    }), signer)  # fmt: skip
    made = measure_clip(retarget(source, signer).clip, signer)
    assert np.linalg.norm(made.elbows - source.elbows, axis=-1).max() < 0.004
    assert np.linalg.norm(made.wrists - source.wrists, axis=-1).max() < 0.001


def test_frames_are_solved_a_chunk_at_a_time(
    signer: Rig, clip: Clip, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each frame is solved for itself: those beside it do not matter."""
    source = measure_clip(clip, signer)
    whole = retarget(source, load_rig("child"))
    monkeypatch.setattr(retargeting, "CHUNK", 7)
    parts = retarget(source, load_rig("child"))
    np.testing.assert_allclose(parts.clip.coordinates, whole.clip.coordinates, atol=1e-9)
