"""All native operators by name."""

from __future__ import annotations

from collections.abc import Mapping

from azee.lang.native import Native
from azee.lang.operators import constraints, geometry, language, lists, mouthing, scores, sides

NATIVES: Mapping[str, Native] = {
    native.name: native
    for module in (language, lists, geometry, constraints, scores, mouthing, sides)
    for native in module.OPERATORS
}
