"""AZee's names: 44 bones, 292 body sites and the morphs, known without any rig.

Tables have the full names (`index_L_2`, `I_TIP_R`, `AU12_L`). A text writes the unsided name and
gives side and phalanx as operands (`!index s 2`); `bone_names`, `site` and `morph` say which
operands a name takes. docs/language/vocabulary.md lists corrections of published descriptions that
contradict each other. The tables are read on first use.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TypeVar

from azee_grammar.nearest import folded, nearest

__all__ = [
    "BONES",
    "MORPHS",
    "SITES",
    "WITHOUT_MORPH",
    "MorphEntry",
    "Name",
    "SiteEntry",
    "bone_names",
    "morph",
    "morph_names",
    "nearest",
    "nearest_site",
    "site",
    "site_names",
]

_DATA = Path(__file__).parent / "data"
_SIDED = re.compile(r"(?P<name>.+?)_(?P<side>[LR])(?:_(?P<phalanx>[123]))?", re.ASCII)

V = TypeVar("V")


@dataclass(frozen=True, slots=True)
class SiteEntry:
    """A site: the bone that carries it and its place on the body."""

    bone: str
    description: str


@dataclass(frozen=True, slots=True)
class MorphEntry:
    """A morph.

    `kind` is skeletal, own-skeletal, facial, facial-alternative, legacy-skeletal or legacy-facial.
    """

    kind: str
    description: str


@dataclass(frozen=True, slots=True)
class Name:
    """An unsided name, as a text writes it, and the operands that complete it.

    `takes_side`: sided variants exist; then `side_optional` says whether the bare name exists too.
        `phalanges`: the numbers that may follow the side, none for most.
    """

    name: str
    takes_side: bool = False
    side_optional: bool = False
    phalanges: tuple[int, ...] = ()

    @property
    def takes_phalanx(self) -> bool:
        """Whether a phalanx number follows the side."""
        return bool(self.phalanges)


class _Table(Mapping[str, V]):
    """A mapping that reads its data on first use."""

    def __init__(self, read: Callable[[], dict[str, V]]) -> None:
        self._read = cache(read)

    def __getitem__(self, key: str) -> V:
        return self._read()[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._read())

    def __len__(self) -> int:
        return len(self._read())


def _rows(file: str) -> list[list[str]]:
    with (_DATA / file).open(encoding="utf-8", newline="") as stream:
        return list(csv.reader(stream))[1:]


BONES: Mapping[str, str | None] = _Table(
    lambda: {name: parent or None for name, parent in _rows("bones.csv")}
)
"""Full bone name to its parent's; the root `back_1` has none."""

SITES: Mapping[str, SiteEntry] = _Table(
    lambda: {name: SiteEntry(bone, text) for name, bone, text in _rows("sites.csv")}
)
"""Full site name to its bone and description."""

MORPHS: Mapping[str, MorphEntry] = _Table(
    lambda: {n: MorphEntry(kind, text) for n, kind, text in _rows("morphs.csv") if kind != "none"}
)
"""Full morph name to its kind and description."""

WITHOUT_MORPH: Mapping[str, str] = _Table(
    lambda: {n: text for n, kind, text in _rows("morphs.csv") if kind == "none"}
)
"""Action units without a morph, with what to use instead."""


@cache
def bone_names() -> Mapping[str, Name]:
    """Unsided bone names, as they are written after `!`."""
    return _unsided(BONES)


@cache
def site_names() -> Mapping[str, Name]:
    """Unsided site names, as they are written after `@`."""
    return _unsided(SITES)


@cache
def morph_names() -> Mapping[str, Name]:
    """Morph names without their sides, as in `morph 'name side weight`."""
    return _unsided(MORPHS)


def site(name: str) -> Name | None:
    """Return the unsided site name, as it is written after `@`, if AZee has it."""
    return site_names().get(name)


def morph(name: str) -> Name | None:
    """Return the morph name, with or without its side suffix, if AZee has it.

    A name with its suffix (`index_bend_L`) takes no side operand.
    """
    found = morph_names().get(name)
    if found is None and name in MORPHS:
        return Name(name)
    return found


def _unsided(full: Iterable[str]) -> dict[str, Name]:
    bare: set[str] = set()
    sided: dict[str, set[int]] = {}
    order: dict[str, None] = {}
    for name in full:
        match = _SIDED.fullmatch(name)
        unsided = match["name"] if match else name
        order[unsided] = None
        if match is None:
            bare.add(name)
            continue
        phalanges = sided.setdefault(unsided, set())
        if match["phalanx"]:
            phalanges.add(int(match["phalanx"]))
    return {
        name: Name(
            name, name in sided, name in sided and name in bare, tuple(sorted(sided.get(name, ())))
        )
        for name in order
    }


def nearest_site(name: str) -> tuple[str, ...]:
    """Return unsided sites that `name` may mean: by spelling, or by a word of the description.

    So `CHIN_TIP` finds `CH`, whose description is "Chin".
    """
    words = {folded(word) for word in re.split(r"[\W_]+", name)}
    scored: dict[str, int] = {}
    for full, entry in SITES.items():
        described = [folded(word) for word in re.findall(r"\w+", entry.description)]
        hits = sum(word in described for word in words if len(word) > 2)
        if hits:
            match = _SIDED.fullmatch(full)
            unsided = match["name"] if match else full
            scored.setdefault(unsided, len(described) - 100 * hits)
    best = min(scored.values(), default=0)
    close = [unsided for unsided, score in scored.items() if score <= best + 1]
    by_meaning = sorted(close, key=lambda unsided: (scored[unsided], len(unsided)))
    return tuple(dict.fromkeys((*nearest(name, site_names()), *by_meaning)))[:3]
