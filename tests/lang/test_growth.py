"""The work of a check grows with its text, counted in calls: clocks depend on the machine."""

from __future__ import annotations

import sys
from types import FrameType

import pytest
from evaluations import program


def _calls(text: str) -> int:
    """Count the calls, and the steps of generators, of checking a text."""
    checked = program(text)
    calls = 0

    def count(_: FrameType, event: str, __: object) -> None:
        nonlocal calls
        calls += event in ("call", "c_call")

    before = sys.getprofile()
    sys.setprofile(count)
    try:
        assert checked.check() == ()
    finally:
        sys.setprofile(before)
    return calls


@pytest.mark.parametrize("one", [" :bien", " (key .2 (place @I_TIP(s) @CH 'contact))"])
def test_a_check_of_twice_the_text_is_twice_the_work(one: str) -> None:
    program(":bien").check()  # the rules that ship are resolved once
    small, large = (_calls(f"seq (list{one * count})") for count in (40, 80))
    assert small > 1000
    assert large < 2.2 * small
