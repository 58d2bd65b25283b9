"""The live connection of one page: texts in; mistakes, scores and movements out.

docs/studio-protocol.md lists the messages. What is sent waits in a queue; a page that does not take
what it is sent is disconnected, and gets everything again when it comes back.
"""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import json
import struct
import time
from collections.abc import Mapping
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from azee.studio.drag import read_act
from azee.studio.folder import LARGEST_TEXT, RefusedError
from azee.studio.framing import Header
from azee.studio.language import Language
from azee.studio.workspace import Workspace

LOOKS_S = 1.0
"""How often the disk is looked at for texts that other programs have changed."""
MOST_UNSENT = 400
MOST_WATCHED = 50
_CLIENTS = itertools.count(1)


class Live:
    """One page's connection, from its opening to its end."""

    def __init__(self, socket: WebSocket, workspace: Workspace) -> None:
        self._socket, self._workspace = socket, workspace
        self._client = next(_CLIENTS)
        self._out: asyncio.Queue[str | bytes] = asyncio.Queue()
        self._language = Language(workspace.languages, self._tell_language)
        self._watched: dict[str, str | None] = {}

    async def run(self) -> None:
        """Serve the page until it is gone."""
        await self._socket.accept()
        self._tell({"kind": "hello", "root": self._workspace.folder.root.as_uri()})
        tasks = [asyncio.create_task(work()) for work in (self._send, self._look, self._receive)]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
            self._workspace.compiler.forget(self._client)
            self._language.close()
            if self._socket.application_state is WebSocketState.CONNECTED:
                with contextlib.suppress(RuntimeError, WebSocketDisconnect):
                    await self._socket.close(1011)

    async def _receive(self) -> None:
        with contextlib.suppress(WebSocketDisconnect):
            while True:
                received = await self._socket.receive()
                if received["type"] == "websocket.disconnect":
                    return
                try:
                    await self._handle(_message(received.get("text")))
                except RefusedError as refused:
                    self._tell({"kind": "refused", "message": refused.message})

    async def _handle(self, message: Mapping[str, Any]) -> None:
        match message.get("kind"):
            case "compile":
                what = self._workspace.job(message)
                job = {"do": "compile", "client": self._client, "what": what}
                self._workspace.compiler.submit(job, self._tell)
            case "pose":
                self._pose(message)
            case "lsp":
                inner = message.get("message")
                if not isinstance(inner, Mapping):
                    raise RefusedError(400, "`message` is missing")
                self._language.receive(inner)
            case "draft":
                await self._keep(message)
            case "watch":
                file, digest = _text(message, "file"), message.get("digest")
                self._workspace.folder.path(file)
                if len(self._watched) >= MOST_WATCHED and file not in self._watched:
                    self._watched.pop(next(iter(self._watched)))
                self._watched[file] = digest if isinstance(digest, str) else None
            case _:
                raise RefusedError(400, "there is no such kind of message")

    def _pose(self, message: Mapping[str, Any]) -> None:
        """Hand an act of posing to the worker. Raises: RefusedError."""
        act = read_act(message)
        job: Header = {"do": "pose", "client": self._client, **act}
        if act["act"] == "open":
            job["what"] = self._workspace.job(message)
        self._workspace.compiler.submit(job, self._tell)

    async def _keep(self, message: Mapping[str, Any]) -> None:
        file, text, digest = _text(message, "file"), _text(message, "text"), message.get("digest")
        self._workspace.folder.path(file)
        if len(text) > LARGEST_TEXT or not (digest is None or isinstance(digest, str)):
            raise RefusedError(413, "that is no text to be kept")
        keep = self._workspace.history.keep
        await asyncio.to_thread(keep, file, _whole(text), digest and digest[:64], time.time())
        self._tell({"kind": "kept", "file": file, "number": message.get("number")})

    async def _look(self) -> None:
        """Tell the page about texts that have changed on the disk."""
        while True:
            await asyncio.sleep(LOOKS_S)
            for file, digest in list(self._watched.items()):
                try:
                    stored = await asyncio.to_thread(self._workspace.folder.read, file)
                except RefusedError:
                    stored = None
                now = stored.digest if stored else None
                if now != digest and self._watched.get(file) == digest:
                    self._watched[file] = now
                    text = stored.text if stored else None
                    self._tell({"kind": "disk", "file": file, "digest": now, "text": text})

    def _tell_language(self, text: str) -> None:
        self._put(f'{{"kind":"lsp","message":{text}}}')

    def _tell(self, header: Header, payload: bytes = b"") -> None:
        head = json.dumps(header, separators=(",", ":"), ensure_ascii=True)
        if payload:
            self._put(struct.pack("<I", len(head)) + head.encode() + payload)
        else:
            self._put(head)

    def _put(self, message: str | bytes) -> None:
        if self._out.qsize() < MOST_UNSENT:
            self._out.put_nowait(message)

    async def _send(self) -> None:
        with contextlib.suppress(WebSocketDisconnect, RuntimeError):
            while self._out.qsize() < MOST_UNSENT:
                message = await self._out.get()
                if isinstance(message, bytes):
                    await self._socket.send_bytes(message)
                else:
                    await self._socket.send_text(message)


def _message(text: str | None) -> Mapping[str, Any]:
    try:
        found = json.loads(text or "")
    except (ValueError, RecursionError) as error:
        raise RefusedError(400, "the message is no JSON") from error
    if not isinstance(found, Mapping):
        raise RefusedError(400, "the message is no object")
    return found


def _text(message: Mapping[str, Any], name: str) -> str:
    value = message.get(name)
    if not isinstance(value, str):
        raise RefusedError(400, f"`{name}` is missing")
    return value


def _whole(text: str) -> str:
    """Return a text without halves of characters, which no file can hold."""
    return text.encode("utf-16-le", "surrogatepass").decode("utf-16-le", "replace")
