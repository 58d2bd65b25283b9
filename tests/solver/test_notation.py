"""Constraints read as AZee writes them."""

from __future__ import annotations

import math

import pytest

from azee_solver import constraint as c
from azee_solver import geometry as g
from azee_solver.notation import (
    constraint_text,
    operator_text,
    problem_text,
    subject_text,
    target_text,
)

STRONG, WEAK = g.Side.STRONG, g.Side.WEAK
PALM, INDEX = g.Bone("palm", STRONG), g.Bone("index", STRONG, 2)
TIP, CHIN = g.Site("I_TIP", STRONG), g.Site("CH")
UP, AT_CHIN = g.Vec(0, 1, 0), g.SitePoint(CHIN)

READ_AS = {
    c.Place(TIP, AT_CHIN, distance_m=0.02, contact=True): "place @I_TIP(s) @CH 'dist 0.02 'contact",
    c.Place(TIP, g.NamedPoint(g.SigningSpace.RSSP)): "place @I_TIP(s) ^Rssp",
    c.Place(CHIN, g.FreePoint(0, -0.1, 0.3)): "place @CH point(0, -0.1, 0.3)",
    c.Place(CHIN, g.VTranslate(g.JointPoint(INDEX), g.Scale(UP, 0.1))): (
        "place @CH vtranslate(joint(!index(s, 2)), scale(^up, 0.1))"
    ),
    c.Place(CHIN, g.Between(AT_CHIN, g.WorldPoint(0, 1, 0), 0.5)): (
        "place @CH between(@CH, world-point(0, 1, 0), 0.5)"
    ),
    c.Place(CHIN, g.Moving(g.Arc(UP), AT_CHIN, AT_CHIN)): "place @CH moving(arc(^up), @CH, @CH)",
    c.Orient(c.BoneAxis.NRM, PALM, c.Relation.ALONG, g.Opp(g.Out(WEAK))): (
        "orient 'nrm !palm(s) 'along in(w)"
    ),
    c.Orient(c.BoneAxis.DIR, PALM, c.Relation.ACROSS, g.Vec(1, 2, -0.5)): (
        "orient 'dir !palm(s) 'across vec(1, 2, -0.5)"
    ),
    c.Look(g.Unit(g.VSum((UP, g.Vec(0, 0, 1))))): "look unit(vsum(^up, ^fwd))",
    c.Look(g.Cross(g.Dir(PALM), g.Nrm(PALM))): "look cross(dir(!palm(s)), nrm(!palm(s)))",
    c.Look(g.VDiff(UP, g.Opp(UP))): "look vdiff(^up, oppvect(^up))",
    c.Look(g.Rotated(UP, g.Out(STRONG), math.radians(30))): "look rotated(^up, out(s), 30)",
    c.LookAt(AT_CHIN): "lookat @CH",
    c.Look(g.Towards(AT_CHIN, g.SitePoint(TIP))): "look towards(@CH, @I_TIP(s))",
    c.Morph("index_bend", STRONG, -0.5): "morph 'index_bend s -0.5",
    c.Morph("smile", None, 1): "morph 'smile 1",
    c.Trill(PALM, UP, 5, math.radians(8)): "trill !palm(s) ^up 'freq 5 'amp 8",
    c.Rotate(g.Bone("head"), g.Vec(-1, 0, 0), math.radians(10)): "rotate !head ^right 10",
    c.Transpath(TIP, g.Straight()): "transpath @I_TIP(s) straight",
    c.Transpath(TIP, g.Circle(UP, 0.05, 2)): "transpath @I_TIP(s) circle(^up, 0.05, 2)",
    c.Transpath(TIP, g.Through((AT_CHIN, AT_CHIN))): "transpath @I_TIP(s) through(@CH, @CH)",
}


@pytest.mark.parametrize("constraint", READ_AS, ids=READ_AS.get)
def test_constraints_read_as_azee(constraint: c.Constraint) -> None:
    assert constraint_text(constraint) == READ_AS[constraint]


@pytest.mark.parametrize(
    ("constraint", "subject", "target"),
    [
        (c.Place(TIP, AT_CHIN, contact=True), "place @I_TIP(s)", "@CH 'contact"),
        (
            c.Orient(c.BoneAxis.DIR, PALM, c.Relation.ALONG, UP),
            "orient 'dir !palm(s)",
            "'along ^up",
        ),
        (c.LookAt(AT_CHIN), "lookat", "@CH"),
        (c.Morph("index_bend", WEAK, 1), "morph 'index_bend w", "1"),
    ],
)
def test_a_constraint_has_a_subject_and_a_target(
    constraint: c.Constraint, subject: str, target: str
) -> None:
    assert (subject_text(constraint), target_text(constraint)) == (subject, target)
    assert constraint_text(constraint) == f"{subject} {target}"
    assert operator_text(constraint) == type(constraint).__name__.lower()


def test_a_problem_is_named_by_its_placement_then_by_what_it_turns() -> None:
    asked: list[c.Constraint] = [
        c.Orient(c.BoneAxis.DIR, PALM, c.Relation.ALONG, UP),
        c.Place(TIP, AT_CHIN),
        c.Orient(c.BoneAxis.NRM, PALM, c.Relation.ALONG, g.Out(STRONG)),
    ]
    name = "place @I_TIP(s) @CH, orient 'dir !palm(s), orient 'nrm !palm(s)"
    assert problem_text(asked) == name


def test_a_problem_at_a_measured_point_is_named_without_its_coordinates() -> None:
    assert problem_text([c.Place(TIP, g.WorldPoint(0.1, 1.2, 0.3))]) == "place @I_TIP(s)"
