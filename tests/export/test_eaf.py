"""Scores as ELAN files: valid, read by pympi, with every block at its time."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree import ElementTree

import pympi
import pytest
from any_scores import SCORES
from eaf_rules import check
from hypothesis import given, settings
from laws import examples

from azee.cli.main import run
from azee.export.formats.eaf import write_eaf
from azee.export.formats.eaf_tiers import Note, score_tiers, track_tiers
from azee.export.track_rows import Bar, Row
from azee.score.interval import Interval
from azee.score.score import Block, Call, Group, Key, Score

Annotations = dict[str, list[tuple[int, int, str]]]


def key(duration: str, rule: str = "") -> Key:
    return Key(Fraction(duration), calls=(Call(rule),) if rule else ())


def group(duration: str, *blocks: tuple[str, str, str, Score], rule: str = "") -> Group:
    return Group(
        Fraction(duration),
        calls=(Call(rule),) if rule else (),
        blocks=tuple(
            Block(name, Interval(Fraction(start), Fraction(end)), score)
            for name, start, end, score in blocks
        ),
    )


@pytest.fixture
def score() -> Group:
    shake = group("0.4", ("R", "0", "0.2", key("0.2")), ("L", "0.2", "0.4", key("0.2")))
    return group(
        "3",
        ("X", "0", "1", key("1", "été")),
        ("instant", "1", "1", key("0")),
        ("last", "3", "3", key("0")),
        ("shake", "0.9995", "1.3995", shake),
        ("Y\x01<&>", "2", "3", key("1", "wardrobe")),
        rule="not-but",
    )


def read(path: Path) -> Annotations:
    """What pympi, which is not ours, finds."""
    file = pympi.Elan.Eaf(str(path))
    return {tier: sorted(file.get_annotation_data_for_tier(tier)) for tier in file.get_tier_names()}


def test_every_block_is_an_annotation_at_its_time_inside_its_parent(
    score: Group, tmp_path: Path
) -> None:
    write_eaf(score, tmp_path / "a.eaf", lead_s=0.5)
    check(ElementTree.parse(tmp_path / "a.eaf").getroot())
    assert read(tmp_path / "a.eaf") == {
        "score": [(500, 3500, "not-but")],
        "rule not-but": [(500, 3500, "not-but")],
        "rule été": [(500, 1500, "été")],
        "rule wardrobe": [(2500, 3500, "wardrobe")],
        "blocks 1": [
            (500, 1500, "X · été"),
            (1500, 1900, "shake"),
            (2500, 3500, "Y<&> · wardrobe"),
        ],
        "blocks 2": [(1500, 1501, "instant"), (3499, 3500, "last")],
        "blocks 1.1": [(1500, 1700, "R"), (1700, 1900, "L")],
    }


def test_tracks_are_tiers_by_part_of_the_body(score: Group, tmp_path: Path) -> None:
    def bar(name: str, start: float, end: float) -> Bar:
        return Bar(("Z", name), start, end, (), ("head.axial",))

    rows = (
        Row("head", ((bar("a", 0, 1), bar("b", 1, 2)), (bar("c", 0.5, 0.5),))),
        Row("right arm", ((bar("d", 0, 3),),)),
    )
    write_eaf(score, tmp_path / "a.eaf", rows)
    check(ElementTree.parse(tmp_path / "a.eaf").getroot())
    found = read(tmp_path / "a.eaf")
    assert found["track head"] == [(0, 1000, "Z › a"), (1000, 2000, "Z › b")]
    assert found["track head 2"] == [(500, 501, "Z › c")]
    assert found["track right arm"] == [(0, 3000, "Z › d")]
    write_eaf(score, tmp_path / "late.eaf", rows, lead_s=0.5)  # as in a film of the whole clip
    late = read(tmp_path / "late.eaf")
    assert late["track head"] == [(500, 1500, "Z › a"), (1500, 2500, "Z › b")]
    assert late["track head 2"] == [(1000, 1001, "Z › c")]
    assert late["track right arm"] == [(500, 3500, "Z › d")]


def test_where_nothing_leads_in_the_tiers_begin_with_the_score(score: Group) -> None:
    assert score_tiers(score).notes == [Note("not-but", 0, 3000)]
    bar = Bar(("Z", "a"), 0.0, 1.0, (), ("head.axial",))
    (tier,) = track_tiers([Row("head", ((bar,),))])
    assert tier.notes == [Note("Z › a", 0, 1000)]


def test_what_ends_as_another_begins_is_on_its_tier(score: Group, tmp_path: Path) -> None:
    def bar(name: str, start: float, end: float) -> Bar:
        return Bar((name,), start, end, (), ())

    row = Row("head", ((bar("late", 1, 2),), (bar("early", 0, 1),), (bar("both", 0.999, 1.001),)))
    write_eaf(score, tmp_path / "a.eaf", (row,))
    found = read(tmp_path / "a.eaf")
    assert found["track head"] == [(0, 1000, "early"), (1000, 2000, "late")]
    assert found["track head 2"] == [(999, 1001, "both")]


@given(SCORES)
@settings(max_examples=examples(0.4))
def test_whatever_the_score_the_file_is_valid_and_no_block_is_lost(score: Score) -> None:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "a.eaf"
        write_eaf(score, path)
        root = ElementTree.parse(path).getroot()
    check(root)

    def blocks(score: Score) -> int:
        inner = score.blocks if isinstance(score, Group) else ()
        return 1 + sum(blocks(block.score) for block in inner)

    assert len(root.findall(".//ALIGNABLE_ANNOTATION")) == blocks(score)


def test_the_same_score_gives_the_same_bytes_and_the_date_it_is_told(
    score: Group, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    for name in ("a", "b"):
        write_eaf(score, tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()
    for seconds, date in {"86400": "1970-01-02T00:00:00+00:00", "no": "1970-01-01"}.items():
        monkeypatch.setenv("SOURCE_DATE_EPOCH", seconds)
        write_eaf(score, tmp_path / "c")
        assert ElementTree.parse(tmp_path / "c").getroot().get("DATE", "").startswith(date)


def test_a_film_on_another_drive_has_no_relative_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No path leads from one drive of Windows to another."""

    def fails(*_: object) -> str:
        raise ValueError("path is on mount 'D:', start on mount 'C:'")

    monkeypatch.setattr("os.path.relpath", fails)
    score = Key(Fraction(1))
    write_eaf(score, tmp_path / "a.eaf", media=tmp_path / "film.mp4")
    root = ElementTree.parse(tmp_path / "a.eaf").getroot()
    check(root)
    media = root.find("HEADER/MEDIA_DESCRIPTOR")
    assert media is not None
    film = (tmp_path / "film.mp4").resolve().as_uri()
    assert media.attrib == {"MEDIA_URL": film, "MIME_TYPE": "video/mp4"}


def test_commands_write_it_with_the_video_beside_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("films").mkdir()
    text = ["-e", "key 1 (look ^fwd)"]
    assert run(["score", *text, "-o", "a.eaf", "--media", "films/été 1.mp4"]) == 0
    assert run(["compile", *text, "--quiet", "-o", "films/b.eaf", "--media", "b.webm"]) == 0
    roots = [ElementTree.parse(path).getroot() for path in ("a.eaf", "films/b.eaf")]
    for root in roots:
        check(root)
    media = [root.find("HEADER/MEDIA_DESCRIPTOR") for root in roots]
    assert [m is not None and m.get("RELATIVE_MEDIA_URL") for m in media] == [
        "./films/%C3%A9t%C3%A9%201.mp4",
        "../b.webm",
    ]
    assert [m is not None and m.get("MIME_TYPE") for m in media] == ["video/mp4", "video/webm"]
    assert [m is not None and m.get("MEDIA_URL", "").startswith("file:///") for m in media] == [
        True,
        True,
    ]
    assert "track eyes" in read(Path("films/b.eaf"))
    # The film begins before the score does: the signer moves into her first posture.
    assert read(Path("films/b.eaf"))["score"][0][0] > 0
