"""Constraints on the posture, and sets of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

from azee.lang.conflict import orient_conflict
from azee.lang.machine import Machine
from azee.lang.morphs import SOFT_DEG, morphs, unknown_morph
from azee.lang.native import Group, Native, Occurrence, Operand, Option
from azee.lang.values import (
    ConstraintsValue,
    Kind,
    ListValue,
    Value,
)
from azee_solver.constraint import (
    BoneAxis,
    Constraint,
    Look,
    LookAt,
    Manner,
    Orient,
    Place,
    Relation,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.geometry import (
    Between,
    Bone,
    Path,
    Point,
    Side,
    Site,
    SitePoint,
    Swing,
    Vector,
    VTranslate,
    Was,
)

TRILL_HZ = 5.0
TRILL_DEG = 12.0
"""What a trill does unless its text says otherwise; ours, nothing is published."""

Constraints = tuple[Constraint, ...]


def _place(
    at: Occurrence, site: Site, point: Point, *, dist: float, contact: bool, within: float
) -> Constraints:
    if within < 0:
        raise at.fault("number-range", "`'within` is a length: 0 or more metres", "bound")
    if contact and isinstance(point, Between):
        point = replace(point, on_skin=True)
    return (Place(site, point, dist, contact, within, origin=at.origin),)


def _orient(
    at: Occurrence, axis: str, bone: Bone, relation: str, vector: Vector, *, within: float
) -> Constraints:
    most = 90 if Relation(relation) is Relation.ACROSS else 180
    if not 0 <= within < most:
        message = f"`'within` is an angle between 0 and {most} degrees"
        raise at.fault("number-range", message, "bound", help="all directions are less than that")
    bound = math.radians(within)
    return (Orient(BoneAxis(axis), bone, Relation(relation), vector, bound, origin=at.origin),)


def _turning(at: Occurrence, axis: str, bone: Bone) -> Constraints:
    way = Swing(None, None)
    return (Orient(BoneAxis(axis), bone, Relation.ALONG, way, origin=at.origin),)


FROM = "from"


def _shift(
    at: Occurrence, site: Site, vector: Vector, *, contact: bool, within: float, **more: str | None
) -> Constraints:
    block = more[FROM]
    if block is None:
        message = "`shift` wants the block from whose end it counts"
        raise at.fault("missing-value", message, help="write `'from 'BLOCK`")
    point = VTranslate(Was(block, SitePoint(site)), vector)
    return _place(at, site, point, dist=0.0, contact=contact, within=within)


def _look(at: Occurrence, vector: Vector) -> Constraints:
    return (Look(vector, origin=at.origin),)


def _lookat(at: Occurrence, point: Point) -> Constraints:
    return (LookAt(point, origin=at.origin),)


def _rotate(at: Occurrence, bone: Bone, axis: Vector, angle_deg: float) -> Constraints:
    return (Rotate(bone, axis, math.radians(angle_deg), origin=at.origin),)


def manner_of(word: str | None) -> Manner | None:
    """Return the manner of a movement by its word."""
    return None if word is None else Manner(word)


def _transpath(at: Occurrence, site: Site, path: Path, *, manner: str | None) -> Constraints:
    return (Transpath(site, path, manner_of(manner), origin=at.origin),)


def _trill(
    at: Occurrence,
    bone: Bone,
    axis: Vector,
    side: Side | None = None,
    *,
    freq: float | None,
    cycles: float | None,
    amp: float,
    back: float | None,
    phase: float,
) -> Constraints:
    if side is not None and bone.side is not side:
        message = "the side of a trill is that of its bone"
        raise at.fault("bad-side", message, "side", help="leave it out: the bone has one")
    if freq is not None and freq <= 0:
        raise at.fault("number-range", "the frequency of a trill is greater than 0", "frequency")
    if cycles is not None and cycles <= 0:
        raise at.fault("number-range", "a trill has more than 0 cycles", "cycles")
    if cycles is not None and freq is not None:
        message = "a trill has either `'freq` or `'cycles`"
        help_ = "`'cycles` counts them while the block lasts: leave one out"
        raise at.fault("number-range", message, "cycles", help=help_)
    return (
        Trill(
            bone,
            axis,
            TRILL_HZ if freq is None else freq,
            math.radians(amp),
            None if back is None else math.radians(back),
            math.radians(phase % 360),
            cycles,
            origin=at.origin,
        ),
    )


def _cstr(at: Occurrence, machine: Machine, values: tuple[Value, ...]) -> Constraints:
    flat: list[Constraint] = []
    for i, value in enumerate(values):
        flat += _flattened(at, machine, value, i)
    conflict = orient_conflict(flat)
    if conflict is not None:
        message, where = conflict
        number = next(i for i, v in enumerate(values) if _contains(v, flat[where]))
        raise at.fault("orient-conflict", message, "constraint", number)
    return tuple(flat)


def _flattened(at: Occurrence, machine: Machine, value: Value, number: int) -> Iterable[Constraint]:
    if isinstance(value, ConstraintsValue):
        machine.spend(len(value.content), at.span)
        return value.content
    if isinstance(value, ListValue):
        machine.spend(len(value.content), at.span)
        return [c for item in value.content for c in _flattened(at, machine, item, number)]
    message = f"`cstr` wants constraints, not {value.kind.value}"
    raise at.fault("wrong-type", message, "constraint", number, label=f"this is {value.kind.value}")


def _contains(value: Value, constraint: Constraint) -> bool:
    if isinstance(value, ListValue):
        return any(_contains(item, constraint) for item in value.content)
    return isinstance(value, ConstraintsValue) and any(c is constraint for c in value.content)


def _native(
    name: str,
    meaning: str,
    operands: tuple[Operand, ...],
    function: Callable[..., Any],
    example: str,
    *,
    options: tuple[Option, ...] = (),
    uses_machine: bool = False,
    only_name_published: bool = False,
) -> Native:
    return Native(
        name,
        Group.CONSTRAINTS,
        meaning,
        operands,
        options,
        result=Kind.CONSTRAINTS,
        published=not only_name_published,
        only_name_published=only_name_published,
        example=example,
        function=function,
        uses_machine=uses_machine,
    )


MANNER = Option(
    "manner",
    "how the movement takes its time",
    Operand("manner", "a word", (Kind.SYMBOL,), words=tuple(m.value for m in Manner)),
)


def _within(meaning: str) -> Option:
    return Option("within", meaning, Operand("bound", "the greatest miss", (Kind.NUMBER,)), 0.0)


_SITE = Operand("site", "such as `@I_TIP(s)`", (Kind.SITE,))
_POINT = Operand("point", "a point", (Kind.POINT,))
_BONE = Operand("bone", "such as `!palm(s)`", (Kind.BONE,))
_VECTOR = Operand("vector", "a vector", (Kind.VECTOR,))
_AXIS = Operand("axis", "a vector", (Kind.VECTOR,))

OPERATORS = (
    _native(
        "place",
        "The site lies at the point. `'dist` is metres along the outward normal of a target site, "
        "in any direction from another point; `'contact` lets the surfaces touch, at a point "
        "between sites those about each of them. Between two sites of trunk, neck and head, the "
        "skin that is nearest is touched.",
        (_SITE, _POINT),
        _place,
        "place @I_TIP(s) @CH 'dist .02",
        options=(
            Option(
                "dist", "metres from the point", Operand("distance", "metres", (Kind.NUMBER,)), 0.0
            ),
            Option("contact", "the surfaces may touch here"),
            _within("metres from where the site should be, anywhere inside which it is met"),
        ),
    ),
    _native(
        "orient",
        "An axis of a bone is parallel to a vector, in the same sense (`'along`), or square to it "
        "(`'across`). One set holds at most one `'dir` and one `'nrm` of a bone.",
        (
            Operand("axis", "its direction or normal", (Kind.SYMBOL,), words=("dir", "nrm")),
            _BONE,
            Operand("relation", "parallel or square", (Kind.SYMBOL,), words=("along", "across")),
            _VECTOR,
        ),
        _orient,
        "orient 'nrm !palm(s) 'along ^down 'within 25",
        options=(_within("degrees off, anywhere inside which it is met"),),
    ),
    _native(
        "turning",
        "An axis of a bone is on its way, by the shorter arc: from the direction in which it is "
        "oriented before to the one after.",
        (
            Operand("axis", "its direction or normal", (Kind.SYMBOL,), words=("dir", "nrm")),
            _BONE,
        ),
        _turning,
        "turning 'nrm !palm(s)",
    ),
    _native(
        "shift",
        "The site lies where it was when a block ended, moved by a vector in metres of the "
        "reference signer.",
        (_SITE, _VECTOR),
        _shift,
        "shift @WR(s) (scale ^up .1) 'from 'P1",
        options=(
            Option(
                FROM,
                "the block from whose end it counts",
                Operand("block", "the block's name", (Kind.SYMBOL,)),
            ),
            Option("contact", "the surfaces may touch here"),
            _within("metres from where the site should be, anywhere inside which it is met"),
        ),
    ),
    _native(
        "look",
        "The gaze goes along a vector: eyes first, then head, then neck.",
        (_VECTOR,),
        _look,
        "look ^fwd",
    ),
    _native(
        "lookat",
        "The gaze goes to a point: eyes first, then head, then neck.",
        (_POINT,),
        _lookat,
        "lookat @PA(w)",
    ),
    _native(
        "morph",
        "Shapes of the face and presets of the hands: a name, a side where it takes one, a weight, "
        "and again. Negative weights are legal. With `'soft` behind its weight, joints of a hand "
        f"yield to contacts, each by {SOFT_DEG:g} degrees or as many as follow.",
        (
            Operand(
                "item",
                "`'NAME [SIDE] WEIGHT ['soft [DEGREES]]`",
                (Kind.SYMBOL, Kind.SIDE, Kind.NUMBER),
                rest=True,
                least=2,
                raw=True,
                vocabulary=unknown_morph,
            ),
        ),
        morphs,
        "morph 'AU12 .5 'index_bend s 1",
    ),
    _native(
        "trill",
        "A small rapid oscillation of a bone about an axis while the block lasts.",
        (
            _BONE,
            _AXIS,
            Operand("side", "the bone's side once more", (Kind.SIDE,), optional=True),
        ),
        _trill,
        "trill !palm(s) ^up 'freq 6",
        options=(
            Option(
                "freq",
                f"oscillations per second, {TRILL_HZ:g} unless said",
                Operand("frequency", "Hz", (Kind.NUMBER,)),
            ),
            Option(
                "cycles",
                "oscillations while the block lasts, instead of a frequency",
                Operand("cycles", "how many", (Kind.NUMBER,)),
            ),
            Option(
                "amp",
                f"degrees to either side, {TRILL_DEG:g} unless said",
                Operand("amplitude", "degrees", (Kind.NUMBER,)),
                TRILL_DEG,
            ),
            Option(
                "back",
                "degrees against the axis, where it goes farther to one side; 0 for one side alone",
                Operand("amplitude", "degrees", (Kind.NUMBER,)),
            ),
            Option(
                "phase",
                "degrees of a cycle at its start: 90 at one end, 180 on the way back",
                Operand("phase", "degrees", (Kind.NUMBER,)),
                0.0,
            ),
        ),
    ),
    _native(
        "rotate",
        "A bone is turned from neutral about an axis in its parent bone's frame, right-handed, "
        "by degrees.",
        (_BONE, _AXIS, Operand("angle", "degrees", (Kind.NUMBER,))),
        _rotate,
        "rotate !head ^right 10",
        only_name_published=True,
    ),
    _native(
        "transpath",
        "A controlled movement of a site along a path, between the blocks that place it before "
        "and after.",
        (_SITE, Operand("path", "a path", (Kind.PATH,))),
        _transpath,
        "transpath @I_TIP(s) (arc ^up)",
        options=(MANNER,),
    ),
    _native(
        "cstr",
        "The set of all that is given; sets and lists are flattened.",
        (
            Operand(
                "constraint",
                "constraints, sets or lists of them",
                (Kind.CONSTRAINTS, Kind.LIST),
                rest=True,
                raw=True,
            ),
        ),
        _cstr,
        "cstr (look ^fwd) (morph 'AU12 .5)",
        uses_machine=True,
    ),
)
