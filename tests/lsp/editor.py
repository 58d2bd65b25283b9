"""An editor for tests: a real server in a process of its own, spoken to over the protocol."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import AsyncIterator, Sequence
from concurrent.futures import Future
from contextlib import asynccontextmanager
from itertools import count
from pathlib import Path

from lsprotocol import types
from pygls.lsp.client import LanguageClient

SOON_S = 60.0


class Editor:
    """What a person does in an editor; positions count UTF-16 code units."""

    def __init__(self, client: LanguageClient, folder: Path) -> None:
        self.client, self.folder = client, folder
        self.texts: dict[str, str] = {}
        self.messages: dict[str, types.PublishDiagnosticsParams] = {}
        self.complaints: list[str] = []
        """What the server told the person beside mistakes in texts, such as a fault of its own."""
        self._told = asyncio.Condition()
        self._versions: dict[str, int] = {}
        self._numbers = count()

        @client.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)  # type: ignore[untyped-decorator]
        async def told(params: types.PublishDiagnosticsParams) -> None:
            async with self._told:
                self.messages[params.uri] = params
                self._told.notify_all()

        @client.feature(types.WINDOW_SHOW_MESSAGE)  # type: ignore[untyped-decorator]
        async def complained(params: types.ShowMessageParams) -> None:
            self.complaints.append(params.message)

    def uri(self, name: str) -> str:
        return (self.folder / name).as_uri()

    def item(self, name: str) -> types.TextDocumentIdentifier:
        return types.TextDocumentIdentifier(self.uri(name))

    def at(self, name: str, word: str, skip: int = 0) -> types.Position:
        """Position where a word begins, `skip` code units further."""
        text = self.texts[name].replace("\r\n", "\n")
        found = _position(text, text.index(word))
        return types.Position(found.line, found.character + skip)

    def range(self, name: str, word: str) -> types.Range:
        start = self.at(name, word)
        units = len(word.encode("utf-16-le")) // 2
        return types.Range(start, types.Position(start.line, start.character + units))

    async def open(self, name: str, text: str) -> Sequence[str]:
        """Open a text; returns the codes of what is wrong with it."""
        self.texts[name] = text
        item = types.TextDocumentItem(self.uri(name), "azee", 1, text)
        self._versions[name] = 1
        self.client.text_document_did_open(types.DidOpenTextDocumentParams(item))
        return await self.codes(name)

    async def replace(self, name: str, old: str, new: str) -> Sequence[str]:
        """Type over words, as one change of a range; returns the codes that then hold."""
        text = self.texts[name].replace("\r\n", "\n")
        start, end = (_position(text, text.index(old) + n) for n in (0, len(old)))
        place = types.Range(start, end)
        self.texts[name] = self.texts[name].replace(old, new, 1)
        self._versions[name] += 1
        item = types.VersionedTextDocumentIdentifier(self._versions[name], self.uri(name))
        change = types.TextDocumentContentChangePartial(place, new)
        self.client.text_document_did_change(types.DidChangeTextDocumentParams(item, [change]))
        return await self.codes(name)

    async def ask(self, method: str, parameters: dict[str, object]) -> object:
        """Send a request as it is, right or wrong, and return the answer."""
        number = f"raw {next(self._numbers)}"
        answer: Future[object] = Future()
        protocol = self.client.protocol
        protocol._request_futures[number] = answer
        protocol._send_data(
            {"jsonrpc": "2.0", "id": number, "method": method, "params": parameters}
        )
        return await asyncio.wrap_future(answer)

    async def codes(self, name: str) -> Sequence[str]:
        """Wait for the messages on the newest version; returns their codes."""
        return [str(message.code) for message in (await self.wait(name)).diagnostics]

    async def wait(self, name: str) -> types.PublishDiagnosticsParams:
        def is_there() -> bool:
            found = self.messages.get(self.uri(name))
            return found is not None and found.version == self._versions[name]

        async with self._told:
            await asyncio.wait_for(self._told.wait_for(is_there), SOON_S)
        return self.messages[self.uri(name)]

    async def wait_for_codes(self, name: str, codes: Sequence[str]) -> None:
        """Wait until exactly these messages hold; another text may have brought them about."""

        def are_there() -> bool:
            found = self.messages.get(self.uri(name))
            return found is not None and [m.code for m in found.diagnostics] == list(codes)

        async with self._told:
            await asyncio.wait_for(self._told.wait_for(are_there), SOON_S)


def _position(text: str, offset: int) -> types.Position:
    """Count as the protocol says, independently of the server."""
    before = text[:offset]
    column = before[before.rfind("\n") + 1 :]
    return types.Position(before.count("\n"), len(column.encode("utf-16-le")) // 2)


@asynccontextmanager
async def editor(folder: Path) -> AsyncIterator[Editor]:
    """Start `azee lsp` in a folder, and end it as editors do."""
    client = LanguageClient("tests", "1")
    one = Editor(client, folder)
    path = os.pathsep.join(p for p in sys.path if p)
    environment = os.environ | {"PYTHONPATH": path, "PYTHONUTF8": "1"}
    command = "from azee.cli.main import main; main(['lsp'])"
    await client.start_io(sys.executable, "-c", command, env=environment, cwd=folder)
    root = types.WorkspaceFolder(folder.as_uri(), "tests")
    await client.initialize_async(
        types.InitializeParams(types.ClientCapabilities(), workspace_folders=[root])
    )
    client.initialized(types.InitializedParams())
    try:
        yield one
    finally:
        await client.shutdown_async(None)
        client.exit(None)
        await client.stop()  # type: ignore[no-untyped-call]
