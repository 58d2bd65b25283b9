"""Sequences of signs: attack and decay of each, three blends, the viewer, texts (Gürel 2010)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.clip.blend import Blend, Concatenation
from azee.clip.clip import Clip
from azee.clip.facing import facing_viewer
from azee.clip.quintic import State, quintic
from azee.clip.resample import sampled
from azee.signs.sequence import PlayedSign, played
from azee.signs.wanted import TextMode, wanted
from azee_rig.load import load_rig

Floats = NDArray[np.float64]
C = load_rig("signer").coordinates


def sign(name: str, seconds: float, attack_s: float, decay_s: float, seed: int) -> PlayedSign:
    """A sign that rises from idle, moves about, and falls back."""
    random = np.random.default_rng(seed)
    t = np.arange(round(seconds * 30) + 1) / 30
    middle, reach = 0.7 * C.idle + 0.3 * (C.lower + C.upper) / 2, (C.upper - C.lower) / 12
    inside = np.clip(np.minimum(t / attack_s, (t[-1] - t) / decay_s), 0.0, 1.0)[:, None]
    about = middle + reach * np.sin(random.uniform(0, 6, len(C)) + 2.5 * t[:, None])
    q = C.idle + (about - C.idle) * inside**2 * (3 - 2 * inside)
    return PlayedSign(name, Clip(3.0 + t, q, (), np.zeros((len(t), 0))), attack_s, decay_s)


SIGNS = [sign(name, 3.0, 1.0, 1.0, n) for n, name in enumerate("abc")]


def test_signs_of_equal_attack_and_decay_are_the_printed_formula() -> None:
    """G7, G8: E′n = Σ(Di − a), total E′m + a."""
    whole = played(SIGNS, C, blend="linear", fps=30.0)
    printed = Concatenation(tuple(s.clip for s in SIGNS), C, 1.0, "linear")
    assert whole.clip.duration_s == pytest.approx(3 * 3.0 - 2 * 1.0)
    assert np.allclose(whole.clip.coordinates, printed.clip(whole.clip.times).coordinates)


def test_each_sign_has_an_attack_and_a_decay_of_its_own() -> None:
    """G7: what the longer of two neighbours has more is left out; bodies stay whole."""
    signs = [sign("a", 2.5, 0.5, 1.0, 1), sign("b", 2.0, 0.4, 0.3, 2), sign("c", 3.0, 0.9, 0.5, 3)]
    whole = played(signs, C, blend="smooth", fps=120.0)
    bodies = [s.clip.duration_s - s.attack_s - s.decay_s for s in signs]
    assert [b - a for a, b in whole.bodies_s] == pytest.approx(bodies)
    assert whole.bodies_s[1][0] - whole.bodies_s[0][1] == pytest.approx(0.4)
    assert whole.bodies_s[2][0] - whole.bodies_s[1][1] == pytest.approx(0.3)
    for one, (start, end) in zip(signs, whole.bodies_s, strict=True):
        times = np.linspace(start + 1e-6, end - 1e-6, 7)
        own = sampled(one.clip, 3.0 + one.attack_s + times - start, C).coordinates
        assert np.allclose(sampled(whole.clip, times, C).coordinates, own, atol=2e-4)


def test_the_current_sign_is_named_while_it_plays() -> None:
    whole = played(SIGNS, C, blend="direct", fps=30.0)
    assert [label.text for label in whole.clip.labels] == ["a", "b", "c"]
    assert [label.end_s for label in whole.clip.labels][:-1] == [
        label.start_s for label in whole.clip.labels
    ][1:]


def jumps(blend: Blend) -> Floats:
    """By how much speed changes at once where blends start and end, as a share of the largest."""
    parts = [s.part(1.0, 1.0, C) for s in SIGNS]
    whole = Concatenation(tuple(parts), C, (1.0, 1.0), blend)
    h = 1e-4
    dense = np.arange(0.0, whole.duration_s, 1 / 60)
    largest = np.abs(np.diff(whole.sample(dense), axis=0) * 60).max(axis=0)
    out = []
    for start in whole.starts_s[1:]:
        for t in (start, start + 1.0):
            q = whole.sample(np.array([t - 2 * h, t - h, t + h, t + 2 * h]))
            out.append(np.abs((q[3] - q[2]) - (q[1] - q[0])) / h / largest)
    return np.array(out)


def test_velocity_is_continuous_where_signs_are_joined() -> None:
    """G9: linear blending is C⁰ only; the others jump by less than 5 % of the largest speed."""
    assert jumps("direct").max() < 0.05
    assert jumps("smooth").max() < 0.05
    assert jumps("linear").max() > 0.05


def test_only_the_direct_way_does_not_fall_towards_idle() -> None:
    """How near all coordinates come to idle half-way between two signs."""
    near = {}
    for blend in ("linear", "smooth", "direct"):
        whole = played(SIGNS[:2], C, blend=blend, fps=30.0)
        middle = (whole.bodies_s[0][1] + whole.bodies_s[1][0]) / 2
        now, before, after = (
            sampled(whole.clip, [t], C).coordinates[0] - C.idle
            for t in (middle, whole.bodies_s[0][1], whole.bodies_s[1][0])
        )
        near[blend] = np.linalg.norm(now) / np.linalg.norm((before + after) / 2)
    assert near["direct"] > 0.9
    assert near["linear"] < 0.7 > near["smooth"]


def test_a_quintic_has_its_ends_and_no_noise_of_accelerations() -> None:
    random = np.random.default_rng(5)
    start, end = (State(*random.normal(size=(3, 4))) for _ in range(2))
    span, h = 0.8, 1e-4
    q = quintic(start, end, span, np.array([0.0, h, 2 * h, span - 2 * h, span - h, span]))
    assert np.allclose(q[[0, -1]], [start.values, end.values])
    assert np.allclose((q[1] - q[0]) / h, start.velocity, atol=1e-3)
    assert np.allclose((q[-1] - q[-2]) / h, end.velocity, atol=1e-3)
    assert np.allclose((q[2] - 2 * q[1] + q[0]) / h**2, start.acceleration, atol=0.05)
    still = State.at_rest(np.zeros(1))
    pulled = replace(still, acceleration=np.array([1e4]))
    assert 0.09 < quintic(pulled, still, span, np.linspace(0, span, 99)).max() <= 0.1001


def test_trunk_and_head_are_turned_to_the_viewer() -> None:
    """G10, §5.1.2: the mean turn in what the sign means goes, movement about it stays."""
    clip = SIGNS[0].clip
    q = np.array(clip.coordinates)
    turned = [C.index[name] for name in ("back_1.axial", "head.axial")]
    q[:, turned] = C.idle[turned] + 0.1
    q[40, turned] += 0.02
    askew = replace(clip, coordinates=np.clip(q, C.lower, C.upper))
    straight, by_rad = facing_viewer(askew, C, 4.0, 5.0)
    assert by_rad >= 0.1
    inside = (clip.times >= 4.0) & (clip.times <= 5.0)
    mean = straight.coordinates[inside].mean(axis=0) - C.idle
    assert np.abs(mean[turned]).max() < 1e-9
    assert straight.coordinates[40, turned[0]] - straight.coordinates[41, turned[0]] > 0.019
    arms = [v for v, name in enumerate(C.names) if "arm" in name]
    assert np.array_equal(straight.coordinates[:, arms], askew.coordinates[:, arms])


@pytest.mark.parametrize(
    ("text", "mode", "first"),
    [
        ("lj a", "thesis", ["l", "j", "space", "a"]),
        ("GIS", "thesis", ["G", "I", "S"]),
        ("IĞne", "turkish", ["ı", "ğ", "n", "e"]),
        ("İi", "turkish", ["i", "i"]),
        ("Merhaba, dünya!", "words", ["Merhaba", "dünya"]),
    ],
)
def test_a_text_asks_for_signs(text: str, mode: TextMode, first: list[str]) -> None:
    """G13: a sign a character, space too; capitals for Turkish letters; or a sign a word."""
    assert [one.names[0] for one in wanted(text, mode)] == first


def test_what_the_thesis_types_means_turkish_letters() -> None:
    assert wanted("G", "thesis")[0].names == ("G", "ğ", "Ğ")
    assert wanted("A", "thesis")[0].names == ()  # small letters only
    assert "MERHABA" in wanted("merhaba", "words")[0].names
    assert "IŞIK" in wanted("ışık", "words")[0].names
