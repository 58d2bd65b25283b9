"""The studio as an application: the page, its files, bodies, pictures, exports, the live socket.

docs/studio-protocol.md lists all addresses. `azee.webserver.guard` stands before all of it.
"""

from __future__ import annotations

import asyncio
import json
import time
import uuid
from collections.abc import AsyncIterator, Awaitable, Callable, Mapping
from contextlib import asynccontextmanager
from functools import partial
from pathlib import Path
from typing import Any

from starlette.applications import Starlette
from starlette.background import BackgroundTask
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect, Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.websockets import WebSocket

from azee.blocks.document import Document
from azee.blocks.edits import edit_from_json
from azee.blocks.view import as_json
from azee.formats import FILM_SUFFIXES, WRITERS
from azee.studio.folder import FILM_SUFFIXES as SHOWN_FILMS
from azee.studio.folder import LARGEST_TEXT, ConflictError, RefusedError
from azee.studio.live import Live
from azee.studio.palette import palette
from azee.studio.workspace import Workspace
from azee.web.bundle import DIST
from azee_grammar.diagnostic import AZeeError
from azee_grammar.render import to_json

_KEPT = {"Cache-Control": "max-age=86400, immutable"}
_FRESH = {"Cache-Control": "no-store"}
_MEDIA = {".mp4": "video/mp4", ".webm": "video/webm", ".ogv": "video/ogg"} | {
    ".mov": "video/quicktime"
}
Handler = Callable[[Request], Awaitable[Response]]


def studio_app(workspace: Workspace) -> Starlette:
    """Return the application; it starts the compiler, and closes the workspace at its end."""
    addresses = _Addresses(workspace)

    async def live(socket: WebSocket) -> None:
        await Live(socket, workspace).run()

    @asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        workspace.compiler.start()
        yield
        await workspace.compiler.close()
        workspace.languages.close()
        workspace.history.close()

    routes = [
        Route("/", addresses.page),
        Route("/api/files", addresses.files),
        Route("/api/file", addresses.file, methods=["GET", "PUT"]),
        Route("/api/draft", addresses.draft, methods=["DELETE"]),
        Route("/api/versions", addresses.versions),
        Route("/api/version", addresses.version),
        Route("/api/rules", addresses.rules, methods=["POST"]),
        Route("/api/blocks", addresses.blocks, methods=["POST"]),
        Route("/api/edit", addresses.edit, methods=["POST"]),
        Route("/api/picture", addresses.picture, methods=["POST"]),
        Route("/api/export", addresses.export, methods=["POST"]),
        Route("/body/{name}.glb", addresses.body),
        Route("/film", addresses.film),
        WebSocketRoute("/live", live),
        Mount("/", StaticFiles(directory=DIST)),
    ]
    handlers: Mapping[Any, Any] = {
        RefusedError: _refused, HTTPException: _problem, ClientDisconnect: _gone
    }  # fmt: skip
    return Starlette(routes=routes, exception_handlers=handlers, lifespan=lifespan)


class _Addresses:
    def __init__(self, workspace: Workspace) -> None:
        self._space = workspace
        self._bodies: dict[str, asyncio.Task[Path]] = {}

    async def page(self, request: Request) -> Response:
        """Send the page."""
        return FileResponse(DIST / "studio.html", headers=_FRESH)

    async def files(self, request: Request) -> Response:
        """List texts, films, bodies and formats."""
        space = self._space
        names = await asyncio.to_thread(space.folder.names)
        films = await asyncio.to_thread(space.folder.names, SHOWN_FILMS)
        drafts = await asyncio.to_thread(space.history.drafts)
        listed = {
            "folder": space.folder.root.name, "root": space.folder.root.as_uri(),
            "files": names, "films": films, "drafts": drafts, "first": space.first,
            "bodies": [*space.bodies], "formats": [*WRITERS], "film_formats": [*FILM_SUFFIXES],
        }  # fmt: skip
        return JSONResponse(listed, headers=_FRESH)

    async def file(self, request: Request) -> Response:
        """Send a text with its draft, or save one."""
        name = _named(request)
        if request.method == "PUT":
            return await self._save(name, await _json(request))
        history = self._space.history
        draft = await asyncio.to_thread(history.draft, name)
        try:
            stored = await asyncio.to_thread(self._space.folder.read, name)
        except RefusedError as refused:
            if refused.status != 404 or draft is None:
                raise
            stored = None
        found: dict[str, Any] = {
            "file": name,
            "text": stored.text if stored else "",
            "digest": stored.digest if stored else None,
            "draft": None,
        }
        if draft is not None and draft.text != found["text"]:
            found["draft"] = {"text": draft.text, "digest": draft.digest, "at": draft.at}
        return JSONResponse(found, headers=_FRESH)

    async def _save(self, name: str, asked: Mapping[str, Any]) -> Response:
        text, digest = asked.get("text"), asked.get("digest")
        if not isinstance(text, str) or not (digest is None or isinstance(digest, str)):
            raise RefusedError(400, "`text` or `digest` is missing")
        try:
            made = await asyncio.to_thread(self._space.folder.save, name, text, digest)
        except ConflictError as conflict:
            stored = conflict.stored
            told = {
                "message": "the file has changed on the disk",
                "text": stored.text if stored else None,
                "digest": stored.digest if stored else None,
            }
            return JSONResponse(told, 409, headers=_FRESH)
        await asyncio.to_thread(self._space.history.saved, name, text, time.time())
        return JSONResponse({"file": name, "digest": made}, headers=_FRESH)

    async def draft(self, request: Request) -> Response:
        """Forget what was typed into a text and not saved."""
        name = _named(request)
        self._space.folder.path(name)
        await asyncio.to_thread(self._space.history.drop, name)
        return JSONResponse({}, headers=_FRESH)

    async def versions(self, request: Request) -> Response:
        """List the versions of a text."""
        found = await asyncio.to_thread(self._space.history.versions, _named(request))
        rows = [
            {"number": v.number, "at": v.at, "saved": v.saved, "characters": v.characters}
            for v in found
        ]
        return JSONResponse({"versions": rows}, headers=_FRESH)

    async def version(self, request: Request) -> Response:
        """Send a version of a text."""
        number = request.query_params.get("number", "")
        if not (number.isascii() and number.isdigit() and len(number) < 16):
            raise RefusedError(400, "`number` is missing")
        name = _named(request)
        text = await asyncio.to_thread(self._space.history.version, name, int(number))
        if text is None:
            raise RefusedError(404, "there is no such version")
        return JSONResponse({"text": text}, headers=_FRESH)

    async def blocks(self, request: Request) -> Response:
        """Show a text as nested blocks."""
        name, text = _text_of(await _json(request))
        found = await self._space.languages.run(lambda: as_json(Document.of(text, name)))
        return JSONResponse(found, headers=_FRESH)

    async def edit(self, request: Request) -> Response:
        """Edit a text by its blocks: return what becomes of it, as one change."""
        asked = await _json(request)
        name, text = _text_of(asked)
        try:
            edit = edit_from_json(asked.get("edit"))
            work = partial(Document.of(text, name).apply, edit)
            edited = await self._space.languages.run(work)
        except ValueError as error:
            raise RefusedError(400, str(error)) from error
        except AZeeError as error:
            found = [to_json(d) for d in error.diagnostics]
            return JSONResponse({"diagnostics": found}, 422, headers=_FRESH)
        change = {**edited.change.as_json(text), "gone": [*edited.gone]}
        return JSONResponse(change, headers=_FRESH)

    async def rules(self, request: Request) -> Response:
        """List the rules that a text may use."""
        name, text = _text_of(await _json(request))
        path, libraries = self._space.folder.path(name), self._space.libraries
        found = await self._space.languages.run(lambda: palette(text, path, libraries))
        return JSONResponse({"rules": found}, headers=_FRESH)

    async def picture(self, request: Request) -> Response:
        """Draw the most telling posture of an expression."""
        what = self._space.job(await _json(request))
        header, data = await self._space.compiler.request({"do": "picture", "what": what})
        if header["kind"] == "refused":
            return JSONResponse({"diagnostics": header["diagnostics"]}, 422, headers=_FRESH)
        return Response(data, media_type="image/png", headers=_FRESH)

    async def export(self, request: Request) -> Response:
        """Send a text in one of the formats that azee writes."""
        asked = await _json(request)
        what, suffix = self._space.job(asked), asked.get("suffix")
        if suffix not in WRITERS:
            raise RefusedError(400, f"`suffix` is one of {' '.join(WRITERS)}")
        path = self._space.scratch / f"{uuid.uuid4().hex}{suffix}"
        message = {"do": "export", "what": what, "path": str(path)}
        header, _ = await self._space.compiler.request(message)
        if header["kind"] == "refused":
            return JSONResponse({"diagnostics": header["diagnostics"]}, 422, headers=_FRESH)
        name = f"{Path(what['file']).stem}{suffix}"
        remove = BackgroundTask(path.unlink, missing_ok=True)
        return FileResponse(path, filename=name, headers=_FRESH, background=remove)

    async def body(self, request: Request) -> Response:
        """Send a body without movement; it is made once."""
        name = request.path_params["name"]
        if name not in self._space.bodies:
            raise RefusedError(404, "there is no such body")
        if name not in self._bodies or _failed(self._bodies[name]):
            self._bodies[name] = asyncio.create_task(self._made(name))
        path = await asyncio.shield(self._bodies[name])
        return FileResponse(path, media_type="model/gltf-binary", headers=_KEPT)

    async def _made(self, name: str) -> Path:
        path = self._space.scratch / f"{uuid.uuid4().hex}.glb"
        rig = self._space.bodies[name]
        await self._space.compiler.request({"do": "body", "rig": rig, "path": str(path)})
        if not path.is_file():
            raise RefusedError(503, "the body cannot be read")
        return path

    async def film(self, request: Request) -> Response:
        """Send a film of the folder; browsers ask for parts of it."""
        path = self._space.folder.path(_named(request), SHOWN_FILMS)
        if not path.is_file():
            raise RefusedError(404, "there is no such film")
        return FileResponse(path, media_type=_MEDIA[path.suffix.lower()], headers=_FRESH)


def _failed(task: asyncio.Task[Path]) -> bool:
    return task.done() and (task.cancelled() or task.exception() is not None)


def _named(request: Request) -> str:
    name = request.query_params.get("name")
    if name is None:
        raise RefusedError(400, "`name` is missing")
    return name


def _text_of(asked: Mapping[str, Any]) -> tuple[str, str]:
    """Return file and text of a request. Raises: RefusedError."""
    name, text = asked.get("file"), asked.get("text")
    if not (isinstance(name, str) and isinstance(text, str)) or len(text) > LARGEST_TEXT:
        raise RefusedError(400, "`file` or `text` is missing")
    return name, text


async def _json(request: Request) -> Mapping[str, Any]:
    try:
        found = json.loads(await request.body())
    except (ValueError, RecursionError) as error:
        raise RefusedError(400, "the body is no JSON") from error
    if not isinstance(found, Mapping):
        raise RefusedError(400, "the body is no object")
    return found


async def _refused(request: Request, error: RefusedError) -> Response:
    return JSONResponse({"message": error.message}, error.status, headers=_FRESH)


async def _problem(request: Request, error: HTTPException) -> Response:
    return JSONResponse({"message": error.detail}, error.status_code, headers=_FRESH)


async def _gone(request: Request, error: ClientDisconnect) -> Response:
    return JSONResponse({"message": "the request is too large"}, 413, headers=_FRESH)
