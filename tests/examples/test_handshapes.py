"""Hand shapes on the signer: every contact is met, and no finger passes through another."""

from __future__ import annotations

import runpy
from pathlib import Path
from typing import Any

import pytest

from azee_rig.rig import Rig
from azee_solver.penetration import mesh_penetration

SHEET: dict[str, Any] = runpy.run_path(
    str(Path(__file__).parents[2] / "docs" / "rig" / "handshapes.py")
)
SHAPES: list[str] = list(SHEET["shapes"]())
DEEPEST_M = 0.003
FOLD_M = 0.0047
"""The thumb's base folds the palm's own flesh, which skin that follows bones shows as depth."""


@pytest.mark.slow
@pytest.mark.parametrize("shape", SHAPES)
def test_a_shape_is_met_and_no_finger_passes_through_another(shape: str, signer: Rig) -> None:
    report = SHEET["formed"](signer, shape)
    assert [c.kind for c in report.constraints if not c.met] == []
    for found in mesh_penetration(signer, report.coordinates):
        palm = (found.limb, found.body) == ("thumb_R", "arm_R")
        assert found.depth_m < (FOLD_M if palm else DEEPEST_M), found
