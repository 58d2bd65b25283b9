"""No text hangs or fills the memory: each ends in its diagnostic after a bounded number of steps.

How long that takes and how much memory: `python benchmarks/language_growth.py`.
"""

from __future__ import annotations

import pytest
from evaluations import program
from hostile_texts import HOSTILE, Hostile, nested, sequence

from azee.lang.fault import fault, together
from azee.lang.machine import DEFAULT_LIMITS, HEAVY, Machine
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.source import Source, Span

OVERSHOT = 2_000
"""By how many steps the last expression may pass the limit before it is noticed."""


def spent(text: str, monkeypatch: pytest.MonkeyPatch) -> tuple[int, tuple[Diagnostic, ...]]:
    """Steps of checking a text, and its diagnostics."""
    machines: list[Machine] = []
    start = Machine.__init__

    def counted(machine: Machine, *arguments: object, **named: object) -> None:
        start(machine, *arguments, **named)  # type: ignore[arg-type]
        machines.append(machine)

    monkeypatch.setattr(Machine, "__init__", counted)
    diagnostics = program(text).check()
    return sum(machine.steps for machine in machines), diagnostics


@pytest.mark.long
@pytest.mark.parametrize(
    "hostile",
    [pytest.param(h, marks=pytest.mark.slow) if h.is_slow else h for h in HOSTILE],
    ids=lambda hostile: hostile.name,
)
def test_a_hostile_text_ends_in_its_diagnostic(
    hostile: Hostile, monkeypatch: pytest.MonkeyPatch
) -> None:
    steps, diagnostics = spent(hostile.text, monkeypatch)
    assert tuple(d.code for d in diagnostics) == hostile.codes
    assert steps <= DEFAULT_LIMITS.steps + OVERSHOT
    for diagnostic in diagnostics:
        assert len(diagnostic.message) < 500


@pytest.mark.parametrize("text", [sequence, nested], ids=["sequence", "nested"])
def test_steps_grow_linearly(text: object, monkeypatch: pytest.MonkeyPatch) -> None:
    assert callable(text)
    counts = []
    for size in (20, 40, 60):
        steps, diagnostics = spent(text(size), monkeypatch)
        assert diagnostics == ()
        counts.append(steps)
    assert counts[2] - counts[1] == counts[1] - counts[0] > 0


def test_each_block_of_a_sync_is_paid_for_as_heavy(monkeypatch: pytest.MonkeyPatch) -> None:
    counts = []
    for size in (1, 2, 3, 20):
        blocks = "".join(f"    'B{n} blank(1)\n" + (f"    'start 'B{n - 1}:end\n" if n else "")
                         for n in range(size))  # fmt: skip
        steps, diagnostics = spent(f"sync\n{blocks}", monkeypatch)
        assert diagnostics == ()
        counts.append(steps)
    assert counts[2] - counts[1] == counts[1] - counts[0]
    assert counts[3] - counts[2] == 17 * (counts[1] - counts[0])
    assert counts[1] - counts[0] >= HEAVY


@pytest.mark.long
def test_a_hundred_levels_and_a_thousand_applications_are_within_the_limits() -> None:
    assert program(nested(100)).check() == ()
    assert len(program(sequence(1000)).utterances) == 1


def test_a_mistake_that_is_met_again_and_again_is_carried_once() -> None:
    """Each of the rules doubles how often the one at the bottom is met."""
    span = Span(Source("a", "blank"), 0, 5)
    first = fault("division-by-zero", "by zero", span)
    for _ in range(60):
        first = together((first.through("`:f`", span), first.through("`:g`", span)))
    assert len(first.diagnostics) == 1
    other = fault("division-by-zero", "by zero", Span(span.source, 0, 1))
    assert len(together((first, other)).diagnostics) == 2


@pytest.mark.long
def test_a_long_circle_is_told_briefly() -> None:
    (circle,) = (h for h in HOSTILE if h.codes == ("cyclic-sync",))
    (problem,) = program(circle.text).check()
    assert "`B0:start` needs `B1:end`" in problem.message
    assert "needs 3,989 more, of which the last needs" in problem.message
    assert problem.message.endswith("`B0:start`")
