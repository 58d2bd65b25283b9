"""Recorded signs: the score of a sign that a database keeps."""

from __future__ import annotations

from dataclasses import replace

from azee.lang.fault import fault
from azee.lang.machine import Machine
from azee.lang.native import Group, Native, Occurrence, Operand, Option
from azee.lang.operators.scores import duration_of
from azee.lang.values import Kind
from azee.score.recorded_motion import RecordingError
from azee.score.score import Call, Score

NAME = "recorded"
_WORDS = (Kind.SYMBOL, Kind.TEXT)
_SECONDS = (Kind.NUMBER,)


def _recorded(
    at: Occurrence,
    machine: Machine,
    name: str,
    *,
    language: str | None,
    variant: str | None,
    attack: float | None,
    decay: float | None,
) -> Score:
    if machine.recordings is None:
        message = "no database is named in which the recorded sign could be"
        help_ = "name one with --db, or in the environment variable AZEE_DB"
        raise at.fault("no-recordings", message, "name", help=help_)
    try:
        found = machine.recordings.find(name, language, variant)
    except RecordingError as error:
        span = at.span_of("name")
        raise fault(error.code, error.message, span, help=error.remedy) from None
    if attack is not None:
        found = replace(found, attack_s=duration_of(at, attack, "attack"))
    if decay is not None:
        found = replace(found, decay_s=duration_of(at, decay, "decay"))
    if found.attack_s + found.decay_s > found.duration:
        message = f"attack and decay do not fit into the {float(found.duration):.3g} s of `{name}`"
        raise at.fault("bad-sign", message, "attack" if decay is None else "decay")
    return replace(found, calls=(Call(NAME, at.origin, recorded=found.motion.name),))


OPERATORS = (
    Native(
        NAME,
        Group.SCORES,
        "A recorded sign of the database that `--db` or `AZEE_DB` names. It lasts as long as the "
        "recording; where it is stretched, its attack and decay keep their lengths. "
        "[Recorded signs](../recorded-signs.md) says how a body plays it.",
        (Operand("name", "the sign's name", _WORDS),),
        (
            Option("language", "whose sign it is", Operand("language", "a language", _WORDS)),
            Option("variant", "which of several", Operand("variant", "a variant", _WORDS)),
            Option(
                "attack",
                "seconds into the sign; by default the database's",
                Operand("attack", "seconds", _SECONDS),
            ),
            Option(
                "decay",
                "seconds out of the sign; by default the database's",
                Operand("decay", "seconds", _SECONDS),
            ),
        ),
        result=Kind.SCORE,
        example="recorded 'BONJOUR",
        function=_recorded,
        uses_machine=True,
    ),
)
