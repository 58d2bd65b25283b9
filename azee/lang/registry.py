"""All native operators by name."""

from __future__ import annotations

from collections.abc import Mapping

from azee.lang.native import Native
from azee.lang.operators import (
    constraints,
    geometry,
    kinds,
    language,
    lists,
    mouthing,
    paths,
    recordings,
    rules,
    score_changes,
    scores,
    sides,
    spelling,
    texts,
)

NATIVES: Mapping[str, Native] = {
    native.name: native
    for module in (
        language,
        kinds,
        lists,
        texts,
        spelling,
        rules,
        geometry,
        paths,
        constraints,
        scores,
        score_changes,
        mouthing,
        recordings,
        sides,
    )
    for native in module.OPERATORS
}
