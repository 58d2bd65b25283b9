"""The language server behind a page: messages in, messages out, in a thread of its own.

An analysis may take a tenth of a second; in a thread it keeps nobody waiting who saves or plays.
All pages share the thread, each has a server. Addresses of files outside the open folder are
refused, so that nobody reads what the page may not have.
"""

from __future__ import annotations

import asyncio
import json
import logging
import threading
from collections.abc import Callable, Coroutine, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from pygls.exceptions import JsonRpcException

from azee.lsp.document import path_of
from azee.lsp.server import Server, make_server
from azee.studio.folder import Folder

REFUSED = -32602
"""JSON-RPC's code for parameters that do not fit."""
MOST_DEEP = 40
_Result = TypeVar("_Result")

logging.getLogger("pygls").setLevel(logging.CRITICAL)


class Languages:
    """The thread with the language servers of all pages."""

    def __init__(self, folder: Folder, libraries: Sequence[Path]) -> None:
        self.folder, self.libraries = folder, libraries
        self.loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self.loop.run_forever, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End the thread."""
        self.loop.call_soon_threadsafe(self.loop.stop)
        self._thread.join(timeout=5)

    async def run(self, work: Callable[[], _Result]) -> _Result:
        """Do some work in the thread, after what waits there, and return its result."""

        async def inside() -> _Result:
            return work()

        task: Coroutine[Any, Any, _Result] = inside()
        return await asyncio.wrap_future(asyncio.run_coroutine_threadsafe(task, self.loop))


class Language:
    """The language server of one page.

    Args: send: gets every message for the page, in the event loop of who made this object.
    """

    def __init__(self, languages: Languages, send: Callable[[str], None]) -> None:
        self._languages = languages
        self._send = send
        self._writer = _Writer(asyncio.get_running_loop(), send)
        self._server: Server | None = None

    def receive(self, message: Mapping[str, Any]) -> None:
        """Take a message of the page."""
        wrong = next(_outside(message, self._languages.folder), None)
        if message.get("jsonrpc") != "2.0":
            wrong = "that is no message of JSON-RPC 2.0"
        if wrong is None:
            self._languages.loop.call_soon_threadsafe(self._handle, dict(message))
        elif isinstance(message.get("id"), str | int):
            error = {"code": REFUSED, "message": wrong}
            answer = {"jsonrpc": "2.0", "id": message["id"], "error": error}
            self._send(json.dumps(answer))

    def close(self) -> None:
        """Forget the page's texts."""
        self._languages.loop.call_soon_threadsafe(self._end)

    def _end(self) -> None:
        self._writer.close()
        if self._server is not None:
            self._server.check_no_more()
        self._server = None

    def _handle(self, message: Mapping[str, Any]) -> None:
        if self._server is None:
            self._server = make_server(self._languages.libraries)
            self._server.protocol.set_writer(self._writer, include_headers=False)
        protocol = self._server.protocol
        text = json.dumps(message)
        try:
            protocol.handle_message(json.loads(text, object_hook=protocol.structure_message))
        except SystemExit:  # the page said `exit`; the server is of all pages
            self._end()
        except JsonRpcException:
            logging.getLogger(__name__).debug("a message was not understood", exc_info=True)


class _Writer:
    """Hands what a language server says on to the page, until the page is gone; pygls uses it."""

    def __init__(self, page: asyncio.AbstractEventLoop, send: Callable[[str], None]) -> None:
        self._page, self._send, self._open = page, send, True

    def write(self, data: bytes) -> None:
        """Send a message."""
        if self._open:
            self._page.call_soon_threadsafe(self._send, data.decode("utf-8", "surrogatepass"))

    def close(self) -> None:
        """Drop what comes from now on."""
        self._open = False


def _outside(value: object, folder: Folder, depth: int = 0) -> Iterator[str]:
    """Yield what is wrong with the addresses in a message."""
    if depth > MOST_DEEP:
        yield "the message is nested too deeply"
        return
    if isinstance(value, Mapping):
        for key, inner in value.items():
            text = isinstance(inner, str)
            if text and (key in ("uri", "rootUri", "rootPath") or "://" in str(inner)[:20]):
                if key != "text" and not _inside(str(inner), folder):
                    yield "that address is outside the folder"
            else:
                yield from _outside(inner, folder, depth + 1)
    elif isinstance(value, Sequence) and not isinstance(value, str):
        for inner in value:
            yield from _outside(inner, folder, depth + 1)


def _inside(uri: str, folder: Folder) -> bool:
    path = path_of(uri)
    return path is not None and (path == folder.root or folder.name(path) is not None)
