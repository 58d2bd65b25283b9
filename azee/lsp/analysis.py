"""The analysis of one version of a text: its tree, scope, names and mistakes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from azee.assist.knowledge import Knowledge
from azee.lang.places import declares_places
from azee.lang.program import Program, load
from azee.lsp.document import Document
from azee.lsp.occurrences import Occurrence, occurrences
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.mentions import mentions
from azee_grammar.source import Source
from azee_grammar.syntax import Definition, Item, Use, Utterance


@dataclass(frozen=True, slots=True, eq=False)
class Sound:
    """Items without mistakes, with everything that this result depends on."""

    rules: Mapping[str, tuple[Definition, ...]] = field(default_factory=dict)
    uses: tuple[Item, ...] = ()
    read: tuple[Source, ...] = ()
    items: frozenset[Item] = frozenset()


@dataclass(frozen=True, eq=False)
class Analysis:
    """A parsed text; its mistakes are computed on request.

    `read` are the texts of libraries that it depends on.
    """

    document: Document
    program: Program
    read: tuple[Source, ...]
    folders: Sequence[Path]

    @cached_property
    def knowledge(self) -> Knowledge:
        """What is in scope."""
        path = self.document.path
        beside = () if path is None else (path.parent,)
        return Knowledge(self.program.scope, (*beside, *self.folders))

    @cached_property
    def occurrences(self) -> Sequence[Occurrence]:
        """All names of the text, in order."""
        return occurrences(self.program.file, self.program.scope)

    def at(self, offset: int) -> Occurrence | None:
        """Return the name at an offset, its sigil and its end included."""
        for found in self.occurrences:
            if found.span.start - len(found.sigil) <= offset <= found.span.end:
                return found
        return None

    def check(self, before: Sound) -> tuple[tuple[Diagnostic, ...], Sound]:
        """Return all mistakes, and the data for checking the next version.

        An item without mistakes stays so while no rule that it uses changes. Only the other items
        are resolved and evaluated again, which takes most of the time.
        """
        known = self._still_sound(before)
        diagnostics = self.program.check(sound=known)
        spoiled = {d.span.source.name for d in diagnostics if d.span}
        rules = {rule.definition: rule for rule in self.program.scope.own.rules.values()}
        sound = {
            item
            for item in self.program.file.items
            if item in known
            or (
                isinstance(item, Utterance)
                and not declares_places(item)
                and not self.program.problems(item)
            )
            or (item in rules and not rules[item].diagnostics)
        }
        if len(spoiled) > 1:  # a mistake in a library may show anywhere
            sound.clear()
        return diagnostics, Sound(self._rules, self._uses, self.read, frozenset(sound))

    @property
    def _uses(self) -> tuple[Item, ...]:
        """The items on which all others may depend: libraries and places."""
        items = self.program.file.items
        return tuple(item for item in items if isinstance(item, Use) or declares_places(item))

    @cached_property
    def _rules(self) -> Mapping[str, tuple[Definition, ...]]:
        """Definitions by name; a second definition of the same name is a mistake."""
        found: dict[str, tuple[Definition, ...]] = {}
        for item in self.program.file.items:
            if isinstance(item, Definition):
                found[item.name] = (*found.get(item.name, ()), item)
        return found

    def _still_sound(self, before: Sound) -> frozenset[Item]:
        if (before.uses, before.read) != (self._uses, self.read):
            return frozenset()
        names = {*self._rules, *before.rules}
        changed = {name for name in names if self._rules.get(name) != before.rules.get(name)}
        if not changed:
            return before.items
        return frozenset(
            item
            for item in before.items
            if (reached := self._reached(item)).isdisjoint(_FINDERS) and changed.isdisjoint(reached)
        )

    def _reached(self, item: Item) -> set[str]:
        """Return the names of all rules that an item mentions, and that those mention in turn."""
        waiting = [self._mentions(item)]
        reached: set[str] = set()
        while waiting:
            new = waiting.pop() - reached
            reached |= new
            waiting += (self._mentions(rule) for name in new for rule in self._rules.get(name, ()))
        return reached

    def _mentions(self, item: Item) -> frozenset[str]:
        if id(item) not in self._mentioned:
            self._mentioned[id(item)] = item, frozenset(mentions(item))
        return self._mentioned[id(item)][1]

    @cached_property
    def _mentioned(self) -> dict[int, tuple[Item, frozenset[str]]]:
        return {}


_FINDERS = ("rule", "has-rule")
"""Operators that find a rule by a text, which may be the name of any."""


def analyse(
    document: Document, folders: Sequence[Path], read: Callable[[Path], Source]
) -> Analysis:
    """Read a text and the libraries it uses. `read` reads their texts."""
    texts: dict[Path, Source] = {}

    def noted(path: Path) -> Source:
        texts[path] = read(path)
        return texts[path]

    program = load(document.source, folders, read=noted, place=document.path)
    return Analysis(document, program, tuple(texts.values()), tuple(folders))
