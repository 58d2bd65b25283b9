"""The body that plays evaluated scores; it stays loaded from one answer to the next."""

from __future__ import annotations

import threading
import time
from fractions import Fraction
from typing import TYPE_CHECKING

from azee.compilation import Hand
from azee.lang.values import (
    BoneValue,
    BooleanValue,
    ConstraintsValue,
    ListValue,
    NumberValue,
    OperatorValue,
    PathValue,
    PointValue,
    ScoreValue,
    SideValue,
    SiteValue,
    SymbolValue,
    TextValue,
    Value,
    VectorValue,
)
from azee.repl.refusal import Refusal
from azee.score.score import Key, Score
from azee_grammar.diagnostic import AZeeError

if TYPE_CHECKING:
    from azee.compilation import Compilation
    from azee_rig.rig import Rig

SHOWN_S = Fraction(1)
"""How long a set of constraints is held to be shown."""


class Performer:
    """Solves scores, each once, and loads body and solver in the background.

    precise: whether constraints are met at any price of comfort.
    """

    def __init__(self, rig_name: str, hand: Hand, *, precise: bool = False) -> None:
        self.rig_name = rig_name
        self.hand: Hand = hand
        self.precise = precise
        self._rig: Rig | None = None
        self._made: tuple[Score, Compilation] | None = None
        self._warming: threading.Thread | None = None
        self.took_s = 0.0
        """Duration of the last solution, from score to clip."""

    @property
    def rig(self) -> Rig:
        """The body. Raises: Refusal: there is no body of that name, or it cannot be read."""
        if self._rig is None:
            self._rig = _body(self.rig_name)
        return self._rig

    def change(self, rig_name: str | None = None, hand: Hand | None = None) -> None:
        """Take another body or another dominant hand.

        Raises: Refusal: there is no such body; then the body stays the same.
        """
        if rig_name is not None:
            self._rig = _body(rig_name)
            self.rig_name = rig_name
        if hand is not None:
            self.hand = hand
        self._made = None

    def perform(self, score: Score) -> Compilation:
        """Solve a score, unless it was solved last.

        Raises: AZeeError: the body lacks what the score names. Refusal: there is no body.
        """
        from azee.compilation import perform

        if self._made is None or self._made[0] is not score:
            if self._warming is not None:
                self._warming.join()
            began = time.perf_counter()
            self._made = score, perform(score, self.rig, dominant=self.hand, precise=self.precise)
            self.took_s = time.perf_counter() - began
        return self._made[1]

    def warm_up(self) -> None:
        """Load the body, the solver and its kernels in the background."""
        self._warming = threading.Thread(target=self._warm, daemon=True, name="warm-up")
        self._warming.start()

    def ready(self, patience_s: float = 0.0) -> bool:
        """Return whether everything is loaded, after waiting for a while at most."""
        if self._warming is not None:
            self._warming.join(patience_s)
        return self._warming is None or not self._warming.is_alive()

    def _warm(self) -> None:
        from azee.compilation import perform
        from azee.lang.program import evaluate_expression

        try:
            perform(evaluate_expression(WARMING).score, _body(self.rig_name))
        except (AZeeError, Refusal):
            return  # reported when the body is needed


def _body(name: str) -> Rig:
    from azee_rig.load import RigError, load_rig

    try:
        return load_rig(name)
    except RigError as error:
        raise Refusal(str(error)) from error


WARMING = ":info-about(:cinéma, :bien)"
"""An expression that uses all kernels: contacts, paths, collisions, the face."""


def playable(value: Value) -> Score | None:
    """Return the score that shows a value: the score itself, or constraints held for a while."""
    match value:
        case ScoreValue(content=score):
            return score
        case ConstraintsValue(content=constraints):
            return Key(SHOWN_S, constraints=constraints)
        case (
            NumberValue()
            | SymbolValue()
            | TextValue()
            | SideValue()
            | BooleanValue()
            | BoneValue()
            | SiteValue()
            | VectorValue()
            | PointValue()
            | PathValue()
            | ListValue()
            | OperatorValue()
        ):
            return None


def required(value: Value) -> Score:
    """Return the score that shows a value. Raises: Refusal: the value cannot be shown."""
    score = playable(value)
    if score is None:
        raise Refusal(
            f"the last result is {value.kind.value}, and a body plays scores and constraints"
        )
    return score
