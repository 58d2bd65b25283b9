"""`azee lsp`: answers the requests of an editor from `Texts`."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.lsp.server import LanguageServer

from azee.lsp import answers
from azee.lsp.analysis import Analysis
from azee.lsp.document import Document, path_of
from azee.lsp.messages import messages
from azee.lsp.occurrences import Occurrence
from azee.lsp.protocol import Protocol
from azee.lsp.renaming import CannotRename, places, renamed
from azee.lsp.texts import Texts
from azee_grammar.diagnostic import AZeeError
from azee_grammar.format import format_file
from azee_grammar.nearest import folded
from azee_grammar.source import Span
from azee_grammar.syntax import Definition

PAUSE_S = 0.02
"""How long typing must pause before a text is checked; keys before that are one change."""


class Server(LanguageServer):
    """The language server; `texts` has all texts that it knows."""

    def __init__(self, libraries: Sequence[Path] = ()) -> None:
        super().__init__("azee", version("azee"), protocol_cls=Protocol)
        self.texts = Texts(libraries)
        self._waiting: dict[str, asyncio.TimerHandle] = {}

    def document(self, uri: str) -> Document:
        """Return an open text, or one on the disk.

        Raises: JsonRpcException: there is none.
        """
        found = self.texts.open.get(uri)
        if found is None and (path := path_of(uri)) is not None:
            found = self.texts.at(path)
        if found is None:
            raise JsonRpcException(f"there is no text {uri}", types.ErrorCodes.InvalidParams)
        return found

    def analysis(self, uri: str) -> Analysis:
        """Return the analysis of a text."""
        return self.texts.analysis(self.document(uri))

    def located(self, span: Span) -> types.Location | None:
        """Return the location of a span of any text."""
        document = self.texts.named(span.source.name)
        if document is None or span.end > len(document.text):
            return None
        return types.Location(document.uri, document.range(span))

    def named_at(self, uri: str, position: types.Position) -> Occurrence | None:
        """Return the name at a position."""
        document = self.document(uri)
        return self.texts.analysis(document).at(document.offset(position))

    def check_soon(self, uri: str) -> None:
        """Publish the mistakes in a text, and in those that use it, once typing pauses."""
        waiting = self._waiting.pop(uri, None)
        if waiting is not None:
            waiting.cancel()
        loop = asyncio.get_running_loop()
        self._waiting[uri] = loop.call_later(PAUSE_S, self._check, uri)

    def check_all(self) -> None:
        """Publish the mistakes in every open text, once typing pauses."""
        for uri in self.texts.open:
            self.check_soon(uri)

    def check_no_more(self) -> None:
        """Forget what was to be checked: nobody can be told any more."""
        for waiting in self._waiting.values():
            waiting.cancel()
        self._waiting.clear()

    def _check(self, uri: str) -> None:
        self._waiting.pop(uri, None)
        document = self.texts.open.get(uri)
        if document is None:
            return
        self._publish(document)
        for other in self.texts.users(document):
            self._publish(other)

    def _publish(self, document: Document) -> None:
        found = self.texts.check(document)
        file = self.texts.analysis(document).program.file
        self.text_document_publish_diagnostics(
            types.PublishDiagnosticsParams(
                document.uri, messages(document, file, found, self.located), document.version
            )
        )


def make_server(libraries: Sequence[Path] = ()) -> Server:
    """Return a server that is ready to be started."""
    server = Server(libraries)
    _follow_texts(server)
    _explain(server)
    _navigate(server)
    _change(server)
    return server


def _follow_texts(server: Server) -> None:
    texts = server.texts

    @server.feature(types.INITIALIZED)
    def ready(_: types.InitializedParams) -> None:
        folders = server.workspace.folders.values()
        roots = [path_of(folder.uri) for folder in folders]
        if not roots and server.workspace.root_uri:
            roots = [path_of(server.workspace.root_uri)]
        texts.roots = tuple(root for root in roots if root is not None)

    @server.feature(types.EXIT)
    def leaving(_: None) -> None:
        server.check_no_more()

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    def opened(params: types.DidOpenTextDocumentParams) -> None:
        item = params.text_document
        texts.put(Document(item.uri, item.text, item.version))
        server.check_all()

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    def changed(params: types.DidChangeTextDocumentParams) -> None:
        item = params.text_document
        document = texts.open.get(item.uri)
        if document is not None:
            texts.put(document.edited(params.content_changes, item.version))
            server.check_soon(item.uri)

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def closed(params: types.DidCloseTextDocumentParams) -> None:
        uri = params.text_document.uri
        texts.close(uri)
        server.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, []))
        server.check_all()

    # pygls passes the server instead to a handler whose parameter may be one, such as an `object`.
    @server.feature(types.TEXT_DOCUMENT_DID_SAVE)
    def saved(_: types.DidSaveTextDocumentParams) -> None:
        texts.disk_changed()
        server.check_all()

    @server.feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def on_disk(_: types.DidChangeWatchedFilesParams) -> None:
        texts.disk_changed()
        server.check_all()


def _explain(server: Server) -> None:
    completion = types.CompletionOptions(trigger_characters=list(":.'^!@#"))

    @server.feature(types.TEXT_DOCUMENT_COMPLETION, completion)
    def complete(params: types.CompletionParams) -> types.CompletionList:
        return answers.completed(server.analysis(params.text_document.uri), params.position)

    @server.feature(types.TEXT_DOCUMENT_HOVER)
    def hover(params: types.HoverParams) -> types.Hover | None:
        return answers.hovered(server.analysis(params.text_document.uri), params.position)

    help_options = types.SignatureHelpOptions(trigger_characters=list("(, '"))

    @server.feature(types.TEXT_DOCUMENT_SIGNATURE_HELP, help_options)
    def sign(params: types.SignatureHelpParams) -> types.SignatureHelp | None:
        return answers.signed(server.analysis(params.text_document.uri), params.position)

    legend = types.SemanticTokensLegend(answers.TOKEN_TYPES, answers.TOKEN_MODIFIERS)

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, legend)
    def colour(params: types.SemanticTokensParams) -> types.SemanticTokens:
        return answers.coloured(server.analysis(params.text_document.uri))


def _navigate(server: Server) -> None:
    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    def define(params: types.DefinitionParams) -> types.Location | None:
        found = server.named_at(params.text_document.uri, params.position)
        return None if found is None else server.located(found.target.place)

    @server.feature(types.TEXT_DOCUMENT_REFERENCES)
    def refer(params: types.ReferenceParams) -> list[types.Location]:
        found = server.named_at(params.text_document.uri, params.position)
        if found is None:
            return []
        return [
            types.Location(document.uri, document.range(place.span))
            for document, place in places(server.texts, found.target)
            if params.context.include_declaration or not place.declares
        ]

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT)
    def highlight(params: types.DocumentHighlightParams) -> list[types.DocumentHighlight]:
        uri = params.text_document.uri
        found = server.named_at(uri, params.position)
        if found is None:
            return []
        analysis = server.analysis(uri)
        return [
            types.DocumentHighlight(analysis.document.range(place.span))
            for place in analysis.occurrences
            if place.target == found.target
        ]

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    def outline(params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
        return answers.outline(server.analysis(params.text_document.uri))

    @server.feature(types.WORKSPACE_SYMBOL)
    def find(params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
        wanted = folded(params.query)
        return [
            types.WorkspaceSymbol(
                types.Location(document.uri, document.range(item.name_span)),
                item.name,
                types.SymbolKind.Function,
            )
            for document in server.texts.all()
            for item in server.texts.analysis(document).program.file.items
            if isinstance(item, Definition) and wanted in folded(item.name)
        ]


def _change(server: Server) -> None:
    @server.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
    def prepare(params: types.PrepareRenameParams) -> types.PrepareRenamePlaceholder | None:
        uri = params.text_document.uri
        found = server.named_at(uri, params.position)
        if found is None or found.target.shipped:
            return None
        place = server.document(uri).range(found.span)
        return types.PrepareRenamePlaceholder(place, found.target.name)

    @server.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    def rename(params: types.RenameParams) -> types.WorkspaceEdit | None:
        found = server.named_at(params.text_document.uri, params.position)
        if found is None:
            return None
        try:
            return types.WorkspaceEdit(renamed(server.texts, found.target, params.new_name))
        except CannotRename as reason:
            code = types.LSPErrorCodes.RequestFailed
            raise JsonRpcException(str(reason), code) from None

    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    def put_in_form(params: types.DocumentFormattingParams) -> list[types.TextEdit]:
        document = server.document(params.text_document.uri)
        try:
            text = format_file(document.source)
        except AZeeError:
            return []
        if "\r\n" in document.text:
            text = text.replace("\n", "\r\n")
        return [] if text == document.text else [types.TextEdit(document.whole, text)]
