"""Finds the rule that a name means in a text."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, MutableMapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from azee.lang.lazy_rules import LazyRules

if TYPE_CHECKING:
    from azee.lang.places import NamedPlace
    from azee.lang.rule import Rule


@dataclass(eq=False)
class Namespace:
    """The rules of one text or one library, by name.

    `name` is None for the text itself. Rules of a library may be read when they are named.
    """

    name: str | None
    rules: MutableMapping[str, Rule] = field(default_factory=dict)

    @property
    def read(self) -> MutableMapping[str, Rule]:
        """The rules that were read so far."""
        return self.rules.read if isinstance(self.rules, LazyRules) else self.rules


class AmbiguousRule(Exception):  # noqa: N818 - not an error of ours: the caller reports it
    """A name that several libraries define, with their rules."""

    def __init__(self, rules: tuple[Rule, ...]) -> None:
        super().__init__(rules[0].name)
        self.rules = rules


@dataclass(eq=False)
class Scope:
    """The namespaces that are visible in a text: its own, those it uses, then the core.

    `libraries` is filled after its rules are made, since libraries may use each other. `siblings`
    are the rules of the library that the text is a file of, if it is read alone. `dropped` is the
    default library where the text uses others instead. `shipped` finds a library that ships.
    `places` are the points that the text names.
    """

    own: Namespace
    core: Namespace
    libraries: list[Namespace] = field(default_factory=list)
    siblings: Namespace | None = None
    dropped: Namespace | None = None
    shipped: Callable[[str], Namespace | None] = lambda name: None
    places: dict[str, NamedPlace] = field(default_factory=dict)

    def find(self, name: str) -> Rule | None:
        """Return the rule that a name means here.

        Raises: AmbiguousRule: two libraries in use define it, and the text itself does not.
        """
        if name in self.own.rules:
            return self.own.rules[name]
        if self.siblings is not None and name in self.siblings.rules:
            return self.siblings.rules[name]
        found = tuple(library.rules[name] for library in self._used() if name in library.rules)
        if len(found) > 1:
            raise AmbiguousRule(found)
        return found[0] if found else self.core.rules.get(name)

    def _used(self) -> Iterator[Namespace]:
        for library in dict.fromkeys(self.libraries):
            if library is not self.core:
                yield library

    def names(self) -> tuple[str, ...]:
        """Return all names that have a meaning here."""
        beside = () if self.siblings is None else (self.siblings,)
        spaces = (self.own, *beside, *self._used(), self.core)
        visible: Mapping[str, None] = dict.fromkeys(
            name for space in spaces for name in space.rules
        )
        return tuple(visible)
