"""The shipped libraries are where they are said to be."""

from __future__ import annotations

from azee_grammar.library import shipped, shipped_names


def test_core_and_lsf_ship() -> None:
    assert {"core", "lsf"} <= set(shipped_names())
    for name in shipped_names():
        assert list((shipped() / name).glob("*.azee"))
