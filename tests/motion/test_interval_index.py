from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from azee.motion.tasks.interval_index import IntervalIndex
from azee.score.interval import Interval

times = st.integers(0, 12).map(lambda n: Fraction(n, 4))
intervals = st.tuples(times, times).map(lambda ab: Interval(min(ab), max(ab)))
probes = st.tuples(st.integers(-1, 26), st.integers(0, 9)).map(
    lambda ab: Interval(Fraction(ab[0], 8), Fraction(ab[0] + ab[1], 8))
)


@given(st.lists(intervals, max_size=8), probes)
def test_an_index_answers_as_asking_every_item_would(
    known: list[Interval], probe: Interval
) -> None:
    index = IntervalIndex((span, i) for i, span in enumerate(known))
    time = probe.start
    assert index.at(time) == [i for i, s in enumerate(known) if s.start <= time <= s.end]
    assert index.covering(probe) == [
        i for i, s in enumerate(known) if s.start <= probe.start and probe.end <= s.end
    ]
    assert index.overlapping(probe) == [
        i for i, s in enumerate(known) if s.start <= probe.end and probe.start <= s.end
    ]
