"""The text that is posed: its blocks, its rules, and its score with other words in it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path as FilePath

from azee.blocks.document import Document
from azee.blocks.tree import Node, Path, children, content
from azee.compilation import Hand, score_of
from azee.lang.program import Program, load
from azee.lang.values import PointValue, SiteValue
from azee.score.score import Score
from azee_grammar.source import Source
from azee_grammar.syntax import Application
from azee_solver.constraint import Origin
from azee_solver.geometry import Point, SitePoint


@dataclass(frozen=True, eq=False)
class PosedText:
    """A text with the options that say what of it is compiled.

    libraries, utterance, dominant: as `azee.compile` takes them. place: the file of the text, which
    need not be there yet.
    """

    document: Document
    libraries: tuple[FilePath, ...] = ()
    utterance: int | None = None
    dominant: Hand = "right"
    place: FilePath | None = None

    @property
    def source(self) -> Source:
        """The text, with its name."""
        return self.document.source

    @cached_property
    def program(self) -> Program:
        """The text with its libraries."""
        return load(self.source, self.libraries, place=self.place)

    @cached_property
    def score(self) -> Score:
        """The score with the text's own times. Raises: AZeeError: all mistakes."""
        return score_of(self.program, None, self.utterance, self.dominant)

    def with_document(self, document: Document) -> PosedText:
        """Return another text with the same options."""
        return replace(self, document=document)

    @cached_property
    def places(self) -> Mapping[str, Point]:
        """The places of the discourse that the text names."""
        out: dict[str, Point] = {}
        for name, place in self.program.scope.places.items():
            match place.value:
                case PointValue(content=point):
                    out[name] = point
                case SiteValue(content=site):
                    out[name] = SitePoint(site)
                case None:
                    pass
        return out

    def path_of(self, origin: Origin | None) -> Path | None:
        """Return the path of the application at an origin, if that is in this text."""
        if origin is None or origin.file != self.source.name:
            return None
        return self._paths.get((origin.line, origin.column))

    @cached_property
    def _paths(self) -> dict[tuple[int, int], Path]:
        return {
            (node.head.span.line, node.head.span.column): path
            for path, node in self.nodes
            if isinstance(node, Application)
        }

    @cached_property
    def nodes(self) -> Sequence[tuple[Path, Node]]:
        """All nodes of the text with their paths, outer before inner."""
        return [
            found
            for i, item in enumerate(self.document.nodes)
            if item is not None
            for found in _nodes(content(item), (i,))
        ]

    @cached_property
    def utterance_paths(self) -> Sequence[Path]:
        """The paths of the utterances, in order."""
        starts = [item.span.start for item in self.program.utterance_items()]
        return [
            (i,)
            for i, item in enumerate(self.document.nodes)
            if item is not None and item.span.start in starts
        ]


def _nodes(node: Node, path: Path) -> Iterator[tuple[Path, Node]]:
    yield path, node
    for i, child in enumerate(children(node)):
        yield from _nodes(child, (*path, i))
