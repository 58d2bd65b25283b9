"""Hashes that are computed once."""

from __future__ import annotations

import copy
import os
import pickle
import subprocess
import sys
from dataclasses import dataclass, replace

import pytest

from azee_solver.constraint import Morph, Origin
from azee_solver.hashing import RemembersHash, hash_once

COUNTED: list[str] = []


class Text(str):
    """A text that counts how often it is hashed."""

    __slots__ = ()

    def __hash__(self) -> int:
        COUNTED.append(self)
        return super().__hash__()


@hash_once
@dataclass(frozen=True, slots=True)
class Named(RemembersHash):
    """What has a name."""

    name: str


def test_a_hash_is_computed_once_and_stays_with_its_object() -> None:
    COUNTED.clear()
    a = Named(Text("a"))
    assert hash(a) == hash(a) == hash(Named("a"))
    assert COUNTED == ["a"]
    assert len({a, copy.copy(a), replace(a)}) == 1
    assert hash(replace(a, name="b")) == hash(Named("b"))


def test_constraints_that_differ_in_their_origin_alone_have_one_hash() -> None:
    here, there = (Morph("jaw_open", None, 0.5, origin=Origin("a", n, 1)) for n in (1, 2))
    assert here == there
    assert hash(here) == hash(there)
    assert hash(here) != hash(replace(here, weight=0.25))


@pytest.mark.parametrize("seed", ["1", "2"])
def test_a_hash_does_not_go_to_another_process(seed: str) -> None:
    morph = Morph("jaw_open", None, 0.5)
    hash(morph)
    script = (
        "import pickle, sys; from azee_solver.constraint import Morph\n"
        "m = pickle.loads(sys.stdin.buffer.read())\n"
        "assert hash(m) == hash(Morph('jaw_open', None, 0.5))"
    )
    subprocess.run(
        [sys.executable, "-c", script],
        input=pickle.dumps(morph),
        env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": os.pathsep.join(sys.path)},
        check=True,
    )
