"""Finds the known names that a misspelt name may mean."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable
from functools import lru_cache

_LONGEST = 64  # longer names get no suggestion, so that the search stays bounded


@lru_cache(maxsize=4096)
def folded(name: str) -> str:
    """Return the name without case, accents, hyphens, underscores and inner spaces."""
    parts = unicodedata.normalize("NFKD", name).casefold()
    return "".join(c for c in parts if not unicodedata.combining(c) and c not in "-_ '’$")


def nearest(name: str, known: Iterable[str], limit: int = 3) -> tuple[str, ...]:
    """Return up to `limit` names of `known`, the likeliest first; none if none is near.

    Near means that at most a third of the letters are mistyped (a swap of neighbours counts once),
    or that one name is the beginning of the other. Differences of case, accent and hyphen count
    least.
    """
    return _nearest(name, tuple(known), limit)


@lru_cache(maxsize=1024)
def _nearest(name: str, known: tuple[str, ...], limit: int) -> tuple[str, ...]:
    """Search once for a name that is misspelt a thousand times."""
    if not name or len(name) > _LONGEST:
        return ()
    wanted = folded(name)
    found: list[tuple[float, str]] = []
    for candidate in known:
        if candidate == name or len(candidate) > _LONGEST:
            continue
        cost = _cost(wanted, folded(candidate))
        if cost is not None:
            found.append((cost, candidate))
    found.sort()
    if not found:
        return ()
    best = found[0][0]
    return tuple(candidate for cost, candidate in found if cost < best + 1)[:limit]


def _cost(a: str, b: str) -> float | None:
    """Return the number of mistakes between two folded names, or None if there are too many."""
    if a == b:
        return 0.0
    allowed = max(len(a), len(b)) // 3 if min(len(a), len(b)) > 1 else 0
    if abs(len(a) - len(b)) <= allowed:
        distance = _distance(a, b, allowed)
        if distance <= allowed:
            return float(distance)
    shorter, longer = sorted((a, b), key=len)
    if len(shorter) >= 3 and longer.startswith(shorter):
        return 2.5 + (len(longer) - len(shorter)) / _LONGEST
    return None


def _distance(a: str, b: str, allowed: int) -> int:
    """Return the optimal string alignment distance: insert, delete, replace, swap neighbours.

    Stops early, with `allowed + 1`, once no alignment can stay within `allowed`.
    """
    before: list[int] = []
    above = list(range(len(b) + 1))
    for i, x in enumerate(a, 1):
        row = [i]
        for j, y in enumerate(b, 1):
            cost = min(above[j] + 1, row[j - 1] + 1, above[j - 1] + (x != y))
            if i > 1 and j > 1 and x == b[j - 2] and a[i - 2] == y:
                cost = min(cost, before[j - 2] + 1)
            row.append(cost)
        if min(row) > allowed and (not before or min(above) > allowed):
            return allowed + 1
        before, above = above, row
    return above[-1]
