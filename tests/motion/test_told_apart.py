"""A question, a negation and a shift of role can be told apart by head and brows alone."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.compilation import perform
from azee.lang.program import evaluate_expression
from azee_rig.rig import Rig

Floats = NDArray[np.float64]
PLAIN = ":bien"
RULES: Mapping[str, str] = {
    "negation": ":negation(:bien)",
    "yes-no": ":yes-no-question(:bien)",
    "wh": ":wh-question(:bien)",
    "role": ":turn-taking(^Sssp, ^Wssp, :bien)",
}
FPS = 30


@pytest.fixture(scope="module")
def heads(signer: Rig) -> dict[str, dict[str, Floats]]:
    """By rule the turn of the head and its advance, degrees, and the height of the brows."""
    out = {}
    for name, text in {"plain": PLAIN, **RULES}.items():
        made = perform(evaluate_expression(text).score, signer, fps=FPS, life=False)
        at = signer.coordinates.index
        q = np.degrees(made.clip.coordinates - np.asarray(signer.coordinates.idle))
        weights = made.clip.unit_weights

        def unit(prefix: str, units: tuple[str, ...], weights: Floats) -> Floats:
            found = [weights[:, u] for u, n in enumerate(units) if n.startswith(prefix)]
            return np.sum(found, axis=0) if found else np.zeros(len(weights))

        out[name] = {
            "axial": q[:, at["head.axial"]],
            "neck": q[:, at["neck.flexion"]],
            "raised": unit("browOuterUp", made.clip.units, weights),
            "lowered": unit("browDown", made.clip.units, weights),
        }
    return out


def _reversals(turn: Floats) -> int:
    """How often a turn of more than 3 degrees to one side is followed by one to the other."""
    sides = np.sign(turn[np.abs(turn) > 3.0])
    return int(np.count_nonzero(np.diff(sides)))


def test_only_a_negation_shakes_the_head(heads: dict[str, dict[str, Floats]]) -> None:
    shakes = {name: _reversals(head["axial"]) for name, head in heads.items()}
    assert shakes.pop("negation") >= 3
    assert max(shakes.values()) == 0


def test_only_questions_advance_the_chin(heads: dict[str, dict[str, Floats]]) -> None:
    advance = {name: float(np.ptp(head["neck"])) for name, head in heads.items()}
    questions = advance.pop("yes-no"), advance.pop("wh")
    assert min(questions) > 8.0
    assert max(advance.values()) < 4.0


def test_brows_tell_the_two_questions_apart(heads: dict[str, dict[str, Floats]]) -> None:
    raised = {name: float(head["raised"].max()) for name, head in heads.items()}
    lowered = {name: float(head["lowered"].max()) for name, head in heads.items()}
    assert raised["yes-no"] > 0.5
    assert lowered["wh"] > 0.5
    assert raised["wh"] < 0.1
    assert lowered["yes-no"] < 0.1
    assert max(raised["plain"], lowered["plain"]) < 0.1


def test_only_a_role_keeps_the_head_turned(heads: dict[str, dict[str, Floats]]) -> None:
    turned = {name: float(np.abs(np.mean(head["axial"]))) for name, head in heads.items()}
    assert turned.pop("role") > 5.0
    assert max(turned.values()) < 2.0
