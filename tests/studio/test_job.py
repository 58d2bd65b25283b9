"""A page may ask for what there is, and for nothing else."""

from __future__ import annotations

from typing import Any

import pytest

from azee.studio.folder import LARGEST_TEXT, RefusedError
from azee.studio.job import Job, read_job

ASKED: dict[str, Any] = {"number": 3, "file": "a.azee", "text": ":arbre\n"}


def test_options_have_defaults_and_unknown_fields_are_left_out() -> None:
    assert read_job(ASKED | {"kind": "compile", "path": "x"}, ("signer",)) == Job(
        3, "a.azee", ":arbre\n"
    )


@pytest.mark.parametrize(
    "wrong",
    [
        *({"number": "3"}, {"number": True}, {"number": -1}, {"number": 2**60}, {"file": None}),
        *({"text": 3}, {"text": "x" * (LARGEST_TEXT + 1)}, {"rig": "../signer"}, {"rig": []}),
        *({"dominant": "both"}, {"rest": 1}, {"tempo": 0}, {"tempo": float("nan")}, {"fps": 1e9}),
        *({"life": 1}, {"precise": None}, {"expression": 5}, {"tempo": True}),
    ],
    ids=str,
)
def test_wrong_values_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(RefusedError) as refused:
        read_job(ASKED | wrong, ("signer", "child"))
    assert refused.value.status == 400


@pytest.mark.parametrize("name", sorted(ASKED))
def test_what_a_job_needs_must_be_there(name: str) -> None:
    with pytest.raises(RefusedError, match=name):
        read_job({k: v for k, v in ASKED.items() if k != name}, ("signer",))
