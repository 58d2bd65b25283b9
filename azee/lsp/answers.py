"""Answers in the terms of the protocol: completion, hover, signatures, outlines, colours."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from lsprotocol import types

from azee.assist.completion import completions
from azee.assist.description import Description, What
from azee.assist.hover import hover
from azee.assist.pieces import Category, pieces
from azee.assist.signature import signature
from azee.lang.arguments import flattened
from azee.lang.places import declares_places
from azee.lang.sync_shape import ShapeReader
from azee.lsp.analysis import Analysis
from azee.lsp.document import Document
from azee_grammar.syntax import Application, Definition, Expr, OperatorName, Utterance

_KINDS = {
    What.RULE: types.CompletionItemKind.Function,
    What.OPERATOR: types.CompletionItemKind.Operator,
    What.BONE: types.CompletionItemKind.Class,
    What.SITE: types.CompletionItemKind.EnumMember,
    What.MORPH: types.CompletionItemKind.Value,
    What.CONSTANT: types.CompletionItemKind.Constant,
    What.SIDE: types.CompletionItemKind.Keyword,
    What.SYNC_RULE: types.CompletionItemKind.Keyword,
    What.ARGUMENT: types.CompletionItemKind.Property,
    What.OPTION: types.CompletionItemKind.Keyword,
    What.WORD: types.CompletionItemKind.Keyword,
    What.BLOCK: types.CompletionItemKind.Field,
    What.LOCAL: types.CompletionItemKind.Variable,
    What.LIBRARY: types.CompletionItemKind.Module,
    What.ENTRY: types.CompletionItemKind.Property,
}

TOKEN_TYPES = (
    "comment", "keyword", "function", "operator", "class", "enumMember",
    "number", "string", "property", "parameter",
)  # fmt: skip
TOKEN_MODIFIERS = ("declaration", "defaultLibrary")

_TOKENS = {
    Category.COMMENT: "comment",
    Category.KEYWORD: "keyword",
    Category.DEFINED: "function",
    Category.RULE: "function",
    Category.REFERENCE: "function",
    Category.POSTURE: "function",
    Category.OPERATOR: "operator",
    Category.BONE: "class",
    Category.SITE: "enumMember",
    Category.NUMBER: "number",
    Category.TEXT: "string",
    Category.SYMBOL: "property",
    Category.PARAMETER: "parameter",
    Category.HOLE: "parameter",
    Category.SIDE: "keyword",
}


def completed(analysis: Analysis, position: types.Position) -> types.CompletionList:
    """Return the names that may stand at a position, the likeliest first."""
    document = analysis.document
    offset = document.offset(position)
    items = []
    for order, found in enumerate(completions(document.text, offset, analysis.knowledge)):
        place = types.Range(document.position(found.start), document.position(found.end))
        items.append(
            types.CompletionItem(
                label=found.described.title,
                kind=_KINDS[found.described.what],
                detail=found.described.signature,
                documentation=_markdown(found.described),
                sort_text=f"{order:05}",
                filter_text=document.text[found.start : found.end] or found.insert,
                text_edit=types.TextEdit(place, found.insert),
            )
        )
    return types.CompletionList(is_incomplete=True, items=items)


def hovered(analysis: Analysis, position: types.Position) -> types.Hover | None:
    """Return the meaning of the word at a position."""
    document = analysis.document
    found = hover(document.text, document.offset(position), analysis.knowledge)
    if found is None:
        return None
    place = types.Range(document.position(found.start), document.position(found.end))
    return types.Hover(_markdown(found.described), place)


def signed(analysis: Analysis, position: types.Position) -> types.SignatureHelp | None:
    """Return the signature of the application around a position, and the next operand."""
    document = analysis.document
    found = signature(document.text, document.offset(position), analysis.knowledge)
    if found is None:
        return None
    operands = [types.ParameterInformation(place) for place in found.operands]
    line = types.SignatureInformation(found.text, found.meaning, operands, found.active)
    return types.SignatureHelp([line], active_signature=0, active_parameter=found.active)


def outline(analysis: Analysis) -> list[types.DocumentSymbol]:
    """Return the rules and utterances of a text, with the blocks of their `sync`."""
    document = analysis.document
    found = []
    for item in analysis.program.file.items:
        if isinstance(item, Definition):
            meaning = next((text.text for name, text in item.entries if name.name == "meaning"), "")
            found.append(
                types.DocumentSymbol(
                    name=item.name,
                    kind=types.SymbolKind.Function,
                    range=document.range(item.span),
                    selection_range=document.range(item.name_span),
                    detail=meaning,
                    children=list(_blocks(document, item.body)),
                )
            )
        elif isinstance(item, Utterance) and not declares_places(item):
            found.append(
                types.DocumentSymbol(
                    name=" ".join(item.expr.span.text.split())[:60],
                    kind=types.SymbolKind.Event,
                    range=document.range(item.span),
                    selection_range=document.range(item.expr.span),
                    detail="utterance",
                    children=list(_blocks(document, item.expr)),
                )
            )
    return found


def _blocks(document: Document, expr: Expr | None) -> Iterator[types.DocumentSymbol]:
    """Yield the blocks of the outermost `sync`s of an expression."""
    if not isinstance(expr, Application):
        return
    operands = flattened(expr)
    if expr.head != OperatorName(expr.head.span, "sync"):
        for operand in operands:
            yield from _blocks(document, operand)
        return
    for name, score, _, _ in ShapeReader(expr, operands).blocks():
        yield types.DocumentSymbol(
            name=name.name,
            kind=types.SymbolKind.Field,
            range=document.range(name.span.to(score.span)),
            selection_range=document.range(name.span),
            detail="block",
            children=list(_blocks(document, score)),
        )


def coloured(analysis: Analysis) -> types.SemanticTokens:
    """Return the class of every word of a text; shipped rules are marked."""
    document = analysis.document
    shipped = {f.span.end for f in analysis.occurrences if f.target.shipped}
    data: list[int] = []
    line, start = 0, 0
    for piece in pieces(document.text):
        kind = _TOKENS.get(piece.category)
        if kind is None:
            continue
        at, end = document.position(piece.start), document.position(piece.end)
        modifiers = int(piece.category is Category.DEFINED) | 2 * int(
            kind == "function" and piece.end in shipped
        )
        before = start if at.line == line else 0
        data += (
            at.line - line, at.character - before, end.character - at.character,
            TOKEN_TYPES.index(kind), modifiers,
        )  # fmt: skip
        line, start = at.line, at.character
    return types.SemanticTokens(data)


def _markdown(described: Description) -> types.MarkupContent:
    lines = [f"```azee\n{described.signature}\n```"]
    if described.meaning:
        lines.append(described.meaning)
    lines.append("\n".join(_facts(described.facts)))
    return types.MarkupContent(types.MarkupKind.Markdown, "\n\n".join(filter(None, lines)))


def _facts(facts: Sequence[tuple[str, str]]) -> Iterator[str]:
    for label, text in facts:
        yield (
            f"- *{label}*: `{text}`" if label in ("argument", "example") else f"- *{label}*: {text}"
        )
