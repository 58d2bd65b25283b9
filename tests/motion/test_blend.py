"""Signs joined as in Gürel 2010, §4.1.3, and more smoothly."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.clip.blend import Blend, Concatenation, common_rate, joined, repositioned
from azee.clip.clip import Clip, Label
from azee.clip.resample import TooManyFramesError, sampled
from azee_rig.load import load_rig

Floats = NDArray[np.float64]
C = load_rig("signer").coordinates
ATTACK_S = 0.5


def signs() -> list[Clip]:
    """Four signs of different lengths, smooth, well inside the limits, not starting at 0."""
    random = np.random.default_rng(11)
    out = []
    for n, frames in enumerate((40, 61, 33, 47)):
        t = np.arange(frames) / 30
        middle, reach = (C.lower + C.upper) / 2, (C.upper - C.lower) / 5
        phase, speed = random.uniform(0, 6, len(C)), random.uniform(1, 4, len(C))
        q = middle + reach * np.sin(phase + speed * t[:, None])
        weights = 0.5 + 0.3 * np.sin(t[:, None] * (1 + n) + [0.0])
        labels = (Label((f"sign {n}",), 7.0 + t[5], 7.0 + t[-5]),)
        out.append(Clip(7.0 + t, q, ("jawOpen" if n % 2 else "cheekPuff",), weights, labels))
    return out


def printed(
    S: Sequence[Callable[[float], Floats]], D: Sequence[float], a: float, t: float
) -> Floats:
    """T′(t) line by line as it is printed; S counts from 1 there, from 0 here."""
    m = len(S)
    E = [0.0]
    for n in range(1, m + 1):
        E.append(sum(D[i] - a for i in range(n)))
    if t < E[1]:
        return S[0](t)
    for n in range(1, m):
        if E[n] <= t < E[n] + a:
            fade_out = (E[n] + a - t) / a * S[n - 1](t - E[n - 1])
            return np.asarray(fade_out + (t - E[n]) / a * S[n](t - E[n]))
        if E[n] + a <= t < E[n + 1]:
            return np.asarray(S[n](t - E[n]))
    return np.asarray(S[m - 1](t - E[m - 1]))


def test_linear_is_the_printed_formula() -> None:
    clips = signs()
    whole = Concatenation(tuple(clips), C, ATTACK_S, "linear")
    units = whole.units

    def sign(clip: Clip) -> Callable[[float], Floats]:
        def at(t: float) -> Floats:
            one = sampled(clip, [clip.times[0] + t], C)
            weights = [
                one.unit_weights[0, clip.units.index(u)] if u in clip.units else 0.0 for u in units
            ]
            return np.concatenate([one.coordinates[0], np.array(weights, dtype=np.float64)])

        return at

    functions, durations = [sign(c) for c in clips], [c.duration_s for c in clips]
    assert whole.duration_s == pytest.approx(sum(durations) - 3 * ATTACK_S, abs=1e-12)
    times = np.linspace(0.0, whole.duration_s, 301)
    want = np.array([printed(functions, durations, ATTACK_S, t) for t in times])
    assert np.abs(whole.sample(times) - want).max() < 1e-13


def second_derivative_jumps(blend: Blend) -> tuple[float, float]:
    """Return the largest jumps of velocity and acceleration at the ends of all blends.

    rad/s and rad/s²: one-sided finite differences, left and right of each end.
    """
    whole = Concatenation(tuple(signs()), C, ATTACK_S, blend)
    ends = [e for start in whole.starts_s[1:] for e in (start, start + ATTACK_S)]
    h = 1e-4
    velocity = acceleration = 0.0
    for end in ends:
        x = whole.sample(end + h * np.arange(-3, 4))[:, : len(C)]
        velocity = max(velocity, np.abs((x[4] - x[3]) - (x[3] - x[2])).max() / h)
        right = (2 * x[3] - 5 * x[4] + 4 * x[5] - x[6]) / h**2
        left = (2 * x[3] - 5 * x[2] + 4 * x[1] - x[0]) / h**2
        acceleration = max(acceleration, np.abs(right - left).max())
    return velocity, acceleration


def test_smooth_has_no_jump_of_speed_nor_of_acceleration_and_linear_has() -> None:
    velocity, acceleration = second_derivative_jumps("smooth")
    assert velocity < 0.01
    assert acceleration < 0.01
    velocity, acceleration = second_derivative_jumps("linear")
    assert velocity > 1.0
    assert acceleration > 10.0


def test_labels_move_with_their_signs() -> None:
    clips = signs()
    whole = joined(clips, C, overlap_s=ATTACK_S, fps=30)
    assert [x.path for x in whole.labels] == [("sign 0",), ("sign 1",), ("sign 2",), ("sign 3",)]
    starts = Concatenation(tuple(clips), C, ATTACK_S).starts_s
    assert [x.start_s for x in whole.labels] == pytest.approx([s + 5 / 30 for s in starts])


@pytest.mark.parametrize(
    ("overlap", "words"), [(0.6, "clip 3 lasts"), (-1.0, "overlap"), (np.nan, "overlap")]
)
def test_what_cannot_be_joined(overlap: float, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        joined(signs(), C, overlap_s=overlap)


def still(times: Floats) -> Clip:
    return Clip(times, np.tile(C.idle, (len(times), 1)), (), np.zeros((len(times), 0)))


def test_a_rate_is_common_where_all_clips_have_it() -> None:
    """Stills have none; one clip that is unevenly spaced takes it from all."""
    thirty, slower = still(np.arange(9) / 30), still(5.0 + np.arange(4) / 25)
    photo, uneven = still(np.array([2.0])), still(np.array([0.0, 0.1, 0.3]))
    assert common_rate([thirty, thirty]) == pytest.approx(30)
    assert common_rate([photo, slower, photo]) == pytest.approx(25)
    for clips in ([thirty, slower], [slower, thirty], [thirty, thirty, slower]):
        assert common_rate(clips) is None
    for clips in ([thirty, uneven], [uneven, thirty], [uneven], [photo], []):
        assert common_rate(clips) is None


def test_rates_a_thousandth_apart_are_one_rate() -> None:
    """As those of clips of the same camera are, whose times were rounded."""
    thirty = still(np.array([0.0, 1 / 30]))
    near, apart = (still(np.array([0.0, 1 / (30 + off)])) for off in (0.95e-3, 1.05e-3))
    assert common_rate([thirty, near]) == pytest.approx(30)
    assert common_rate([thirty, apart]) is common_rate([apart, thirty]) is None


def test_more_frames_than_anybody_wants_are_refused_with_their_number() -> None:
    long = still(np.array([0.0, 9000.0]))
    with pytest.raises(TooManyFramesError, match=r"18000 s at 30 frames a second are 540,001"):
        joined([long, long], C, fps=30)


def test_frames_of_two_clips_a_rounding_error_apart_are_one() -> None:
    one = still(np.array([0.0, 0.4, 1.0]))
    other = still(np.array([0.0, 0.4 + 3e-7, 1.0]))
    whole = joined([one, other], C, overlap_s=1.0)
    assert whole.times == pytest.approx([0.0, 0.4, 1.0], abs=1e-6)
    assert len(whole.times) == 3


def test_repositioning_zeroes_the_roots_six_parameters_alone() -> None:
    motion = np.random.default_rng(0).normal(size=(5, 12))
    assert not repositioned(motion)[:, :6].any()
    assert (repositioned(motion)[:, 6:] == motion[:, 6:]).all()
    assert motion[:, :6].all()
