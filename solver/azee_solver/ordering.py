"""Topological order with ties broken by a key; a ring of mutual needs stays together."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol, TypeVar


class _Key(Protocol):
    def __lt__(self, other: Any, /) -> bool: ...


K = TypeVar("K", bound=_Key)


def ordered(count: int, needs: Callable[[int], set[int]], key: Sequence[K]) -> list[list[int]]:
    """Order 0 … count − 1 so that each comes after what it needs.

    Of those that could come next the one with the least key does. A ring of mutual needs is one
    entry, sorted by key; all others are entries of one.
    """
    wants = [needs(i) - {i} for i in range(count)]
    rings = _rings(count, wants)
    entry = {i: r for r, ring in enumerate(rings) for i in ring}
    before = [{entry[j] for i in ring for j in wants[i]} - {r} for r, ring in enumerate(rings)]
    members = [sorted(ring, key=lambda i: key[i]) for ring in rings]
    done: set[int] = set()
    out: list[list[int]] = []
    while len(done) < len(rings):
        ready = [r for r in range(len(rings)) if r not in done and before[r] <= done]
        first = min(ready, key=lambda r: key[members[r][0]])
        done.add(first)
        out.append(members[first])
    return out


def _rings(count: int, wants: Sequence[set[int]]) -> list[list[int]]:
    """Strongly connected components, by reachability: there are tens of entries, not thousands."""
    reach = [set(w) for w in wants]
    changed = True
    while changed:
        changed = False
        for i in range(count):
            further = set().union(*(reach[j] for j in reach[i])) - reach[i]
            if further:
                reach[i] |= further
                changed = True
    seen: set[int] = set()
    rings = []
    for i in range(count):
        if i not in seen:
            ring = [i, *(j for j in range(i + 1, count) if j in reach[i] and i in reach[j])]
            seen.update(ring)
            rings.append(ring)
    return rings
