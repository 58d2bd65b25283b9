"""Reads SiGML as XML, safely: no external entities, no network, no entity bombs."""

from __future__ import annotations

from collections.abc import Iterator

from lxml import etree

from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.source import Source, Span

SIGN_TAGS = ("hamgestural_sign", "hns_sign")
"""Elements that are signs: of gestural SiGML, and of the symbols of HamNoSys."""


def parse_xml(data: bytes, name: str) -> etree._Element:
    """Return the root of a document.

    Entities are not resolved, and libxml2 refuses documents that are deep or grow without end.

    Raises: AZeeError: bad-sigml.
    """
    parser = etree.XMLParser(
        resolve_entities=False,
        load_dtd=False,
        no_network=True,
        huge_tree=False,
        remove_comments=True,
        remove_pis=True,
    )
    try:
        return etree.fromstring(data, parser)
    except etree.XMLSyntaxError as problem:
        raise AZeeError(_not_xml(problem, data, name)) from None
    except ValueError as problem:  # an encoding that lxml refuses
        raise AZeeError(Diagnostic("bad-sigml", f"`{name}` is not XML: {problem}", None)) from None


def signs(root: etree._Element) -> Iterator[etree._Element]:
    """Yield the signs of a document, in order."""
    if root.tag in SIGN_TAGS:
        yield root
        return
    yield from root.iter(*SIGN_TAGS)


def children(element: etree._Element) -> list[etree._Element]:
    """Return the elements in one; entities that were not resolved are none."""
    return [child for child in element if isinstance(child.tag, str)]


def _not_xml(problem: etree.XMLSyntaxError, data: bytes, name: str) -> Diagnostic:
    source = Source(name, data.decode("utf-8", errors="replace"))
    line, column = problem.position
    span = None
    if 1 <= line <= source.line_count:
        start = sum(len(s) for s in source.text.splitlines(keepends=True)[: line - 1])
        at = min(start + max(column - 1, 0), len(source.text))
        span = Span(source, at, min(at + 1, len(source.text)))
    reason = (problem.msg or "it is empty").split(", line")[0]
    return Diagnostic("bad-sigml", f"`{name}` is not XML: {reason[:1].lower()}{reason[1:]}", span)
