"""Scores drawn: every block once per picture, inside its parent, and as well-formed XML."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from xml.etree import ElementTree

import pytest
from any_scores import INTERVALS, SCORES
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from azee.cli.main import run
from azee.export.pictures.score_drawing import score_drawing
from azee.export.pictures.score_png import score_image
from azee.export.pictures.score_svg import draw
from azee.export.pictures.shapes import Rect, Told
from azee.export.score_layout import Box, boundaries, flattened, lanes, nested
from azee.export.track_rows import track_rows
from azee.motion.tasks.tracks import Track
from azee.score.interval import Interval
from azee.score.score import Arrangement, Blank, Block, Call, Group, Hold, Key, Score, leaves
from azee_solver.constraint import BoneAxis, Orient, Place, Relation
from azee_solver.geometry import Bone, Side, Site, SitePoint, Vec

NAMESPACE = {"svg": "http://www.w3.org/2000/svg"}
UP, STRONG, WEAK = Vec(0, 1, 0), Side.STRONG, Side.WEAK
TOUCH = Place(Site("EL", STRONG), SitePoint(Site("PA", WEAK)), contact=True)
RAISED = Orient(BoneAxis.DIR, Bone("f_arm", STRONG), Relation.ALONG, UP)


def key(duration: str, *, rule: str = "") -> Key:
    calls = (Call(rule),) if rule else ()
    return Key(Fraction(duration), calls=calls, constraints=(TOUCH, RAISED))


def group(duration: str, *blocks: tuple[str, str, str, Score], rule: str = "") -> Group:
    return Group(
        Fraction(duration),
        calls=(Call(rule),) if rule else (),
        arrangement=Arrangement.SYNC,
        blocks=tuple(
            Block(name, Interval(Fraction(start), Fraction(end)), score)
            for name, start, end, score in blocks
        ),
    )


@pytest.fixture
def not_but() -> Group:
    shake = group(".4", ("R", "0", ".2", key(".2")), ("L", ".2", ".4", key(".2")))
    return group(
        "3",
        ("X", "0", "1", key("1", rule="tree")),
        ("manual", "1", "2", Hold(Fraction(1), block="X")),
        ("headshake", "1.2", "1.6", shake),
        ("gap", "1.6", "2", Blank(Fraction("0.4"))),
        ("Y", "2", "3", key("1", rule="wardrobe")),
        rule="not-but",
    )


def _texts(svg: str) -> list[str]:
    return [t.text or "" for t in ElementTree.fromstring(svg).iterfind(".//svg:text", NAMESPACE)]


def test_every_block_is_named_and_every_constraint_can_be_read(not_but: Group) -> None:
    svg = draw(not_but)
    texts = _texts(svg)
    for name in ("not-but", "X · tree", "Y · wardrobe", "manual", "headshake", "0 s", "3 s"):
        assert name in texts
    tooltips = [
        t.text or ""
        for t in ElementTree.fromstring(svg).iterfind(".//*[svg:title]/svg:title", NAMESPACE)
    ]
    assert any("place @EL(s) @PA(w) 'contact" in tip for tip in tooltips)
    assert any("hold 'X: hands" in tip for tip in tooltips)


def test_keyframes_are_numbered_at_all_boundaries(not_but: Group) -> None:
    times = boundaries(not_but)
    assert times == tuple(map(Fraction, ("0", "1", "1.2", "1.4", "1.6", "2", "3")))
    numbers = [
        element.text
        for element in ElementTree.fromstring(draw(not_but)).iterfind(
            ".//svg:text[@class='number']", NAMESPACE
        )
    ]
    assert numbers == [str(n) for n in range(len(times))]


def test_what_a_user_names_cannot_break_the_picture() -> None:
    svg = draw(group("1", ("<b>&\x01\"'", "0", "1", key("1", rule="]]>")), rule="a<b"))
    assert "<b>&\"' · ]]>" in _texts(svg)


def test_an_instant_is_drawn_and_named() -> None:
    assert "tree" in _texts(draw(key("0", rule="tree")))


def test_a_long_name_is_shortened_to_its_box() -> None:
    long = group("9", ("a" * 300, "0", "1", key("1")), ("b", "1", "9", key("8")))
    assert any(text.endswith("…") and len(text) < 100 for text in _texts(draw(long)))


@pytest.mark.long
@given(SCORES)
def test_boxes_stand_inside_their_parents_and_apart_from_each_other(score: Score) -> None:
    whole = nested(score)
    assert sum(1 for box in whole.all() if not box.inner) == len(list(leaves(score)))
    _check(whole)
    _check_apart(flattened(score))
    ElementTree.fromstring(draw(score))


def _check(box: Box) -> None:
    for inner in box.inner:
        assert box.interval.start <= inner.interval.start
        assert inner.interval.end <= box.interval.end
        assert box.top < inner.top
        assert inner.top + inner.height < box.top + box.height
        _check(inner)
    _check_apart(box.inner)


def _check_apart(boxes: tuple[Box, ...]) -> None:
    for i, a in enumerate(boxes):
        for b in boxes[:i]:
            in_height = a.top < b.top + b.height and b.top < a.top + a.height
            in_time = a.interval.start < b.interval.end and b.interval.start < a.interval.end
            assert not (in_height and in_time)


@given(st.lists(INTERVALS, max_size=12))
def test_lanes_hold_every_interval_once(intervals: list[Interval]) -> None:
    rows = lanes(intervals)
    assert sorted(i for row in rows for i in row) == list(range(len(intervals)))


def test_lanes_are_as_few_as_they_can_be() -> None:
    in_turn = [Interval(Fraction(n), Fraction(n + 1)) for n in range(5)]
    assert lanes(in_turn) == [[0, 1, 2, 3, 4]]
    assert lanes([*in_turn, Interval(Fraction(0), Fraction(5))]) == [[0, 1, 2, 3, 4], [5]]


def test_the_same_score_gives_the_same_bytes(not_but: Group) -> None:
    assert draw(not_but) == draw(not_but)


def _track(path: str, coordinates: str, keys: list[float], start: float, end: float) -> Track:
    return Track(tuple(path.split("/")), tuple(coordinates.split()), tuple(keys), start, end)


@pytest.fixture
def tracks() -> list[Track]:
    return [
        _track("X", "back_1.flexion arm_R.flexion index_R_1.flexion", [0.0, 0.5, 1.0], 0.0, 1.0),
        _track("headshake/R", "head.axial", [1.2, 1.4], 1.2, 1.4),
        _track("Y", "arm_R.flexion f_arm_R.flexion", [2.0, 3.0], 0.9, 3.0),
    ]


def test_tracks_are_rows_by_part_of_the_body_with_a_mark_at_each_key(
    not_but: Group, tracks: list[Track]
) -> None:
    rows = track_rows(tracks)
    assert [row.name for row in rows] == ["trunk", "head", "right arm", "right fingers"]
    assert [[bar.name for bar in lane] for lane in rows[2].lanes] == [["X"], ["Y"]], "they overlap"
    document = ElementTree.fromstring(draw(not_but, rows))
    marks = document.findall(".//svg:line[@class='mark']", NAMESPACE)
    assert len(marks) == 3 * 3 + 2 + 2
    bars = document.findall(".//svg:rect[@class='track']", NAMESPACE)
    ticks = {t.text: float(t.get("x", "")) for t in document.iterfind(".//svg:text", NAMESPACE)}
    per_second = (ticks["3 s"] - ticks["0 s"]) / 3
    spans = {
        (
            round((float(bar.get("x", "")) - ticks["0 s"]) / per_second, 1),
            round(float(bar.get("width", "")) / per_second, 1),
        )
        for bar in bars
    }
    assert {(0.0, 1.0), (1.2, 0.2), (0.9, 2.1)} <= spans
    assert "Tracks" not in _texts(draw(not_but))


def test_the_png_shows_what_the_svg_shows(not_but: Group, tracks: list[Track]) -> None:
    rows = track_rows(tracks)
    drawing = score_drawing(not_but, rows)
    image = score_image(not_but, rows).convert("RGB")
    assert image.size == (round(2 * drawing.width), round(2 * drawing.height))
    assert image.tobytes() == score_image(not_but, rows).convert("RGB").tobytes()
    (shake,) = (
        shape
        for told in drawing.shapes
        if isinstance(told, Told) and told.tip.startswith("head: headshake › R")
        for shape in told.shapes
        if isinstance(shape, Rect)
    )
    middle = int(2 * shake.x + shake.width), int(2 * shake.y + shake.height)
    assert image.getpixel(middle) == (0xD9, 0xE5, 0xF2)
    assert image.getpixel((2, 2)) == (255, 255, 255)


def test_the_command_draws_tracks_when_it_is_asked_to(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text = ["-e", "key 1 (look ^fwd)"]
    assert run(["score", *text, "-o", "a.svg", "-o", "a.png"]) == 0
    assert run(["score", *text, "-o", "b.svg", "--tracks"]) == 0
    assert run(["score", *text, "-o", "flat.svg", "--tracks", "--mode", "flat"]) == 0
    assert Path("flat.svg").read_bytes() != Path("b.svg").read_bytes()
    assert run(["score", *text, "--tracks"]) == 2
    with Image.open("a.png") as picture:
        assert picture.width > 500
    assert "Tracks" not in _texts(Path("a.svg").read_text(encoding="utf-8"))
    assert {"Tracks", "eyes"} <= set(_texts(Path("b.svg").read_text(encoding="utf-8")))
