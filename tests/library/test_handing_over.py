"""Compilations can be pickled, copied and passed between processes."""

from __future__ import annotations

import copy
import multiprocessing
import pickle
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import azee
from azee import AZeeError, Compilation
from azee_rig.load import load_rig
from azee_rig.rig import Rig

TEXT = """\
key .2
    cstr
        place @I_TIP(s) point(.1, .1, .4)
        morph 'smile 1
"""
TOUCHING = ":arbre\n"
"""One arm lies on the other: the report lists a penetration."""


@pytest.fixture(scope="module")
def made() -> Compilation:
    """A compilation."""
    return azee.compile(TEXT)


def pickled(thing: Compilation) -> Compilation:
    """The thing after a way through a pickle."""
    back = pickle.loads(pickle.dumps(thing))
    assert isinstance(back, Compilation)
    return back


def assert_alike(one: Compilation, other: Compilation) -> None:
    """Fail unless two compilations have equal scores, clips and reports."""
    assert one.score == other.score
    for name in ("times", "coordinates", "unit_weights"):
        mine, theirs = getattr(one.clip, name), getattr(other.clip, name)
        np.testing.assert_array_equal(mine, theirs)
        assert not theirs.flags.writeable
    assert (one.clip.units, one.clip.labels) == (other.clip.units, other.clip.labels)
    assert one.animation.key_times == other.animation.key_times
    assert one.animation.tracks == other.animation.tracks
    assert timeless(one) == timeless(other)


def timeless(made: Compilation) -> dict[str, object]:
    """A report without what differs from run to run."""
    report = made.report.as_json()
    return {key: value for key, value in report.items() if key not in ("solve_s", "explain_s")}


@pytest.mark.long
@pytest.mark.parametrize("copied", [pickled, copy.deepcopy, copy.copy])
def test_what_is_copied_equals(
    made: Compilation, copied: Callable[[Compilation], Compilation]
) -> None:
    other = copied(made)
    assert other is not made
    assert_alike(made, other)
    assert_alike(made, copied(made))  # now that the report was read


@pytest.mark.long
def test_a_report_pickles_alone(made: Compilation) -> None:
    assert pickle.loads(pickle.dumps(made.report)).as_json() == made.report.as_json()


def test_bodies_are_shared_by_what_is_unpickled(made: Compilation) -> None:
    assert pickled(made).rig is made.rig
    other = replace(made.rig, name="another")
    assert pickled(replace(made, rig=other)).rig.name == "another"


@pytest.mark.long
def test_a_pickle_is_read_where_its_body_was_not_loaded(
    tmp_path: Path, signer: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The rig of the first pickle is shared by the second."""
    for name in ("rig.json", "mesh.npz"):
        (tmp_path / name).write_bytes((signer.folder / name).read_bytes())
    made = azee.compile(TEXT, load_rig(tmp_path))
    data = pickle.dumps(made)
    monkeypatch.setattr("azee_rig.rig._SHARED", {})
    first, second = pickle.loads(data), pickle.loads(data)
    assert first.rig is second.rig is not made.rig
    assert_alike(made, first)
    for compilation, name in ((made, "made.glb"), (first, "first.glb")):
        compilation.save(tmp_path / name)
    assert (tmp_path / "made.glb").read_bytes() == (tmp_path / "first.glb").read_bytes()


def test_a_shipped_body_is_looked_for_where_it_ships(
    signer: Rig, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The package of the process that reads a pickle may be in another folder."""
    data = pickle.dumps(signer)
    monkeypatch.setattr("azee_rig.rig.SHIPPED", tmp_path)
    assert pickle.loads(data).folder == tmp_path / "signer"


def test_an_error_keeps_its_diagnostics() -> None:
    with pytest.raises(AZeeError) as caught:
        azee.compile("key 1 (place @CHX ^Mssp)\nkey 1 (look ^nowhere)\n")
    error = pickle.loads(pickle.dumps(caught.value))
    assert str(error) == str(caught.value)
    assert error.diagnostics == caught.value.diagnostics


@pytest.mark.slow
def test_processes_hand_over_what_they_compiled_and_what_is_wrong() -> None:
    texts = (TEXT, TOUCHING, "key .3 (place @I_TIP(w) @FH)\n")
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        for made, text in zip(pool.map(azee.compile, texts), texts, strict=True):
            assert_alike(azee.compile(text), made)
            assert bool(made.report.clip_penetration) == (text == TOUCHING)
        with pytest.raises(AZeeError, match="unknown-rule: there is no rule `:nobody`"):
            pool.map(azee.compile, [":nobody\n"])
