from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from azee.motion.tasks.flatten import Keyframe, flatten
from azee.score.interval import Interval
from azee.score.score import Arrangement, Blank, Block, Call, Group, Hold, Key, Score, leaves
from azee_solver.constraint import Look, Morph, Place, Transpath, Trill
from azee_solver.geometry import (
    Bone,
    FreePoint,
    Moving,
    NamedPoint,
    Side,
    SigningSpace,
    Site,
    Straight,
    Vec,
)

F = Fraction
UP, FORWARD = Look(Vec(0, 1, 0)), Look(Vec(0, 0, 1))
SMILE = Morph("AU12", None, 0.5)
TIP = Place(Site("I_TIP", Side.STRONG), NamedPoint(SigningSpace.MSSP))


def key(seconds: str, *constraints: Look | Morph | Place | Transpath | Trill) -> Key:
    return Key(F(seconds), constraints=constraints)


def block(name: str, start: str, score: Score) -> Block:
    return Block(name, Interval(F(start), F(start) + score.duration), score)


def sync(*blocks: Block, calls: tuple[Call, ...] = ()) -> Group:
    return Group(
        max(b.interval_in_parent.end for b in blocks),
        arrangement=Arrangement.SYNC,
        blocks=blocks,
        calls=calls,
    )


def test_the_papers_figure_2() -> None:
    """A block that lasts is copied into the keyframes of a block inside it."""
    timeline = flatten(sync(block("T", "0", key("1", TIP)), block("R", ".25", key(".5", UP))))
    assert [k.time for k in timeline.keyframes] == [0, F(1, 4), F(3, 4), 1]
    assert [[r.path[-1] for r in k.requirements] for k in timeline.keyframes] == [
        ["T"],
        ["T", "R"],
        ["T", "R"],
        ["T"],
    ]


def test_both_sides_of_a_boundary_are_kept_apart() -> None:
    timeline = flatten(sync(block("A", "0", key("1", UP)), block("B", "1", key("1", FORWARD))))
    middle = timeline.keyframes[1]
    assert [r.path for r in middle.closing] == [("A",)]
    assert [r.path for r in middle.opening] == [("B",)]


def test_a_block_of_no_length_gives_one_keyframe() -> None:
    timeline = flatten(sync(block("A", ".5", key("0", UP)), block("B", "0", key("1", SMILE))))
    assert [k.time for k in timeline.keyframes] == [0, F(1, 2), 1]
    assert [r.constraint for r in timeline.keyframes[1].opening] == [UP, SMILE]
    assert not timeline.keyframes[1].closing


def test_times_are_exact_thirds() -> None:
    third = sync(block("A", "1/3", key("1/3", UP)))
    timeline = flatten(sync(block("X", "1/7", third)))
    assert [k.time for k in timeline.keyframes] == [F(10, 21), F(17, 21)]


def test_a_hold_keeps_what_lasted_until_the_end_of_its_sibling() -> None:
    topic = sync(block("EARLY", "0", key(".5", UP)), block("LATE", "0", key("1", TIP, SMILE)))
    timeline = flatten(
        sync(
            block("TOPIC", "1", topic),
            block("HOLD", "2", Hold(F(1, 4), block="TOPIC", channels=("hands", "face"))),
        )
    )
    held = [r for r in timeline.requirements if r.path == ("HOLD",)]
    assert [r.constraint for r in held] == [TIP, SMILE]
    assert {r.interval for r in held} == {Interval(F(2), F(9, 4))}
    assert {r.held_channels for r in held} == {(("hands", "face"),)}


def test_a_hold_inside_a_nested_group_finds_its_sibling_there() -> None:
    inner = sync(block("A", ".5", key("1", TIP)), block("H", "1.5", Hold(F(1, 10), block="A")))
    timeline = flatten(sync(block("A", "0", key("9", UP)), block("IN", "3", inner)))
    held = [r for r in timeline.requirements if r.held_channels]
    assert [(r.path, r.constraint) for r in held] == [(("IN", "H"), TIP)]
    assert held[0].interval == Interval(F("4.5"), F("4.6"))


def test_a_hold_of_a_hold_keeps_the_channels_of_both() -> None:
    timeline = flatten(
        sync(
            block("A", "0", key("1", TIP)),
            block("B", "1", Hold(F(1), block="A", channels=("hands", "face"))),
            block("C", "2", Hold(F(1), block="B", channels=("face", "eyes"))),
        )
    )
    last = timeline.requirements[-1]
    assert last.path == ("C",)
    assert last.constraint == TIP
    assert last.held_channels == (("hands", "face"), ("face", "eyes"))


def test_a_hold_leaves_movements_out_and_keeps_a_moving_point_at_its_end() -> None:
    moving = Moving(Straight(), FreePoint(0, 0, 0), FreePoint(0, 1, 0))
    place = Place(Site("I_TIP", Side.STRONG), moving)
    trill = Trill(Bone("palm", Side.STRONG), Vec(0, 1, 0), 4.0, 0.1)
    path = Transpath(Site("I_TIP", Side.STRONG), Straight())
    timeline = flatten(
        sync(block("A", "0", key("1", place, trill, path)), block("H", "1", Hold(F(1), block="A")))
    )
    held = [r for r in timeline.requirements if r.held_channels]
    assert [r.constraint for r in held] == [place]
    assert held[0].motion == Interval(F(0), F(1))


def test_holds_that_hold_each_other_are_an_error() -> None:
    score = sync(block("A", "0", Hold(F(1), block="B")), block("B", "0", Hold(F(1), block="A")))
    with pytest.raises(ValueError, match="circle"):
        flatten(score)


def test_a_hold_of_nothing_is_an_error() -> None:
    with pytest.raises(ValueError, match="no block 'B'"):
        flatten(sync(block("A", "0", Hold(F(1), block="B"))))
    with pytest.raises(ValueError, match="stands alone"):
        flatten(Hold(F(1), block="B"))


def test_a_requirement_names_the_innermost_rule() -> None:
    sign = sync(block("K", "0", key("1", UP)), calls=(Call("nicht-sondern"), Call("not-but")))
    outer = sync(block("SIG", "0", sign), block("X", "0", key("1", SMILE)), calls=(Call("info"),))
    timeline = flatten(outer)
    assert [r.rule for r in timeline.requirements] == ["not-but", "info"]


times = st.fractions(min_value=0, max_value=3, max_denominator=12)


def _group(parts: list[tuple[Fraction, Score]]) -> Group:
    earliest = min(start for start, _ in parts)
    blocks = tuple(
        Block(f"B{i}", Interval(start - earliest, start - earliest + score.duration), score)
        for i, (start, score) in enumerate(parts)
    )
    return Group(max(b.interval_in_parent.end for b in blocks), blocks=blocks)


scores: st.SearchStrategy[Score] = st.recursive(
    st.one_of(
        st.builds(
            lambda d, cs: Key(d, constraints=tuple(cs)),
            times,
            st.lists(st.sampled_from((UP, SMILE, TIP)), max_size=3),
        ),
        st.builds(Blank, times),
    ),
    lambda inner: st.lists(st.tuples(times, inner), min_size=1, max_size=4).map(_group),
    max_leaves=12,
)


@given(scores)
def test_flattening_keeps_every_constraint_and_every_time(score: Score) -> None:
    timeline = flatten(score)
    expected = [
        (leaf.path, constraint, leaf.interval)
        for leaf in leaves(score)
        if isinstance(leaf.score, Key)
        for constraint in leaf.score.constraints
    ]
    assert [(r.path, r.constraint, r.interval) for r in timeline.requirements] == expected
    instants = {k.time: k for k in timeline.keyframes}
    assert [*instants] == sorted(instants)
    for r in timeline.requirements:
        assert {r.interval.start, r.interval.end} <= set(instants)
        for time, keyframe in instants.items():
            assert (r in keyframe.requirements) == (r.interval.start <= time <= r.interval.end)


@given(scores)
def test_closing_and_opening_share_a_keyframe_out(score: Score) -> None:
    def names(keyframe: Keyframe) -> list[int]:
        return sorted(r.rank for r in keyframe.closing + keyframe.opening)

    assert flatten(score).keyframes
    for keyframe in flatten(score).keyframes:
        assert names(keyframe) == [r.rank for r in keyframe.requirements]
        assert all(r.interval.end == keyframe.time for r in keyframe.closing)
