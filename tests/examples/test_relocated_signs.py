"""Signs that may be made elsewhere: every body that ships reaches them at five places."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import pytest

from azee.compilation import perform
from azee.lang.library import shipped_library
from azee.lang.program import evaluate_expression, load
from azee.score.score import Key, Score, leaves
from azee_grammar.library import shipped_names
from azee_grammar.source import Source
from azee_rig.load import load_rig, shipped_rigs
from azee_rig.rig import Rig
from azee_solver.constraint import Place
from azee_solver.geometry import Side, SitePoint

OFFSETS = {
    "middle": "vec(0, 0, 0)",
    "left": "scale(^left, .2)",
    "right": "scale(^right, .2)",
    "above": "scale(^up, .1)",
    "far": "scale(^fwd, .1)",
}
"""Of the reference signer, from the middle of the signing space."""
FEW = 25
"""There are more relocatable signs than this."""


def _parts(node: Any) -> Iterator[Any]:
    """Yield a constraint and all that it is made of."""
    yield node
    if is_dataclass(node):
        for field in fields(node):
            yield from _parts(getattr(node, field.name))
    elif isinstance(node, tuple):
        for each in node:
            yield from _parts(each)


def _places(score: Score) -> Iterator[Place]:
    for leaf in leaves(score):
        if isinstance(leaf.score, Key):
            yield from (c for c in leaf.score.constraints if isinstance(c, Place))


def _on_the_body(place: Place, rig: Rig) -> bool:
    """Whether a place is on trunk or head; a hand may be the place of the other hand."""
    points = (p for p in _parts(place.point) if isinstance(p, SitePoint))
    bones = (rig.sites[p.site.key(Side.RIGHT)].bone for p in points)
    return any(not bone.endswith(("_L", "_R")) or bone.startswith("eye") for bone in bones)


def _signs() -> Iterator[tuple[str, str]]:
    """Yield signs by name, each with a text in which `{}` is an offset from the usual place.

    They take `'loc`, or all that a rule of `lsf` places, it places in space. Names that only
    forward are left out.
    """
    rig, program = load_rig(), load(Source("<none>", ""))
    for library in shipped_names():
        for rule in shipped_library(library).namespace.rules.values():
            parameters = dict(rule.parameters)
            if any(parameters.values()) or (rule.entry("source") or "").endswith("forwards"):
                continue
            value = program.value(f":{rule.name}")
            if not isinstance(value.content, Score):
                continue
            places = [*_places(value.content)]
            if "loc" in parameters:
                yield rule.name, f":{rule.name}('loc = vtranslate(^Mssp, {{}}))"
            elif library == "lsf" and places and not any(_on_the_body(p, rig) for p in places):
                yield rule.name, f"relocate :{rule.name} ({{}})"


SIGNS = dict(_signs())


def test_there_are_such_signs() -> None:
    assert len(SIGNS) > FEW


@pytest.mark.slow
@pytest.mark.parametrize("body", shipped_rigs())
@pytest.mark.parametrize("name", SIGNS)
def test_nothing_is_missed_wherever_the_sign_is_made(name: str, body: str) -> None:
    missed = {}
    for place, offset in OFFSETS.items():
        score = evaluate_expression(SIGNS[name].format(offset)).score
        report = perform(score, load_rig(body), fps=30, life=False).report
        if found := [c.subject for c in report.constraints if c.missed]:
            missed[place] = found
    assert missed == {}
