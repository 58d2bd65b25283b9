"""The server of the player page: bodies, idle loops, and what is typed as movement.

`Guard` stands before it (`azee.webserver`). One text is solved at a time.
"""

from __future__ import annotations

import asyncio
import json
import os
import signal
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, PlainTextResponse, Response
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles

from azee.export.files import replace_file
from azee.export.formats.glb import write_body
from azee.export.formats.web_clip import web_clip
from azee.player.idle import idle_loop
from azee.player.performing import LONGEST_TEXT, Source
from azee.web.bundle import DIST
from azee_grammar.diagnostic import AZeeError
from azee_grammar.render import to_json
from azee_rig.rig import Rig

MOST_WAITING = 8
"""Texts that wait to be solved; more are refused."""
CLIP = "application/octet-stream"
FRESH = {"Cache-Control": "no-store"}
SAME = {"Cache-Control": "no-cache"}
"""A browser asks each time whether a file has changed."""


@dataclass(frozen=True, eq=False)
class Offer:
    """What the page of a server offers.

    bodies: loads each, by name. body, source, text: what is chosen and typed at first.
    """

    bodies: Mapping[str, Callable[[], Rig]]
    sources: Sequence[Source]
    body: str
    source: str
    text: str = ""

    def catalogue(self) -> dict[str, Any]:
        """Return what the page reads first."""
        return {
            "live": True,
            "bodies": [*self.bodies],
            "body": self.body,
            "sources": [{"id": s.id, "kind": s.kind, "title": s.title} for s in self.sources],
            "source": self.source,
            "text": self.text,
        }


def player_app(offer: Offer, scratch: Path) -> Starlette:
    """Return the application. Args: scratch: an empty folder, for files that are made once."""
    page = _Page(offer, scratch)
    routes = [
        Route("/", page.page),
        Route("/catalogue.json", page.catalogue),
        Route("/body/{name}.glb", page.body),
        Route("/idle/{name}.azwc", page.idle),
        Route("/perform", page.perform, methods=["POST"]),
        Route("/quit", page.quit, methods=["POST"]),
        Mount("/", StaticFiles(directory=DIST)),
    ]
    return Starlette(routes=routes, exception_handlers={HTTPException: _problem})


class _Page:
    def __init__(self, offer: Offer, scratch: Path) -> None:
        self._offer, self._scratch = offer, scratch
        self._solver = asyncio.Lock()
        self._waiting = 0

    async def page(self, request: Request) -> Response:
        """Send the page."""
        return FileResponse(DIST / "player.html", headers=SAME)

    async def catalogue(self, request: Request) -> Response:
        """Say what there is to choose."""
        return JSONResponse(self._offer.catalogue(), headers=FRESH)

    async def body(self, request: Request) -> Response:
        """Send a body in its bind pose."""
        return await self._once(request, ".glb", "model/gltf-binary", write_body)

    async def idle(self, request: Request) -> Response:
        """Send the idle loop of a body."""

        def write(rig: Rig, path: Path) -> None:
            data = web_clip(idle_loop(rig), rig)
            with replace_file(path) as file:
                file.write(data)

        return await self._once(request, ".azwc", CLIP, write)

    async def perform(self, request: Request) -> Response:
        """Send what is typed as a movement, or why it is none."""
        text, source, load = await self._asked(request)
        if self._waiting >= MOST_WAITING:
            raise HTTPException(503, "Too much is being solved; try again in a moment.")
        self._waiting += 1
        try:
            async with self._solver:
                data = await asyncio.to_thread(_performed, text, source, load)
        except AZeeError as error:
            found = [to_json(d) for d in error.diagnostics]
            return JSONResponse({"diagnostics": found}, 422, headers=FRESH)
        finally:
            self._waiting -= 1
        return Response(data, media_type=CLIP, headers=FRESH)

    async def quit(self, request: Request) -> Response:
        """End the server, as an interruption of its process does."""
        asyncio.get_running_loop().call_later(0.1, os.kill, os.getpid(), signal.SIGINT)
        return PlainTextResponse("The player ends.\n", headers=FRESH)

    async def _asked(self, request: Request) -> tuple[str, Source, Callable[[], Rig]]:
        try:
            asked = json.loads(await request.body())
        except (ValueError, RecursionError) as error:
            raise HTTPException(400, "The request is no JSON.") from error
        found = asked if isinstance(asked, dict) else {}
        text, body = found.get("text"), found.get("body")
        source = next((s for s in self._offer.sources if s.id == found.get("source")), None)
        load = self._offer.bodies.get(body) if isinstance(body, str) else None
        if not isinstance(text, str) or source is None or load is None:
            raise HTTPException(400, "The request needs `text`, and a known `source` and `body`.")
        if len(text) > LONGEST_TEXT:
            raise HTTPException(413, f"A text has at most {LONGEST_TEXT} characters.")
        return text, source, load

    async def _once(
        self, request: Request, suffix: str, kind: str, write: Callable[[Rig, Path], None]
    ) -> Response:
        """Send a file of a body; it is made when it is first asked for."""
        name = request.path_params["name"]
        load = self._offer.bodies.get(name)
        if load is None:
            raise HTTPException(404, "There is no such body.")
        path = self._scratch / f"{[*self._offer.bodies].index(name)}{suffix}"
        async with self._solver:
            if not path.exists():
                await asyncio.to_thread(lambda: write(load(), path))
        return FileResponse(path, media_type=kind, headers=SAME)


def _performed(text: str, source: Source, load: Callable[[], Rig]) -> bytes:
    rig = load()
    made = source.play(text, rig)
    return web_clip(made.clip, rig, {"told": [d.message for d in made.told]})


async def _problem(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    return PlainTextResponse(f"{error.detail}\n", error.status_code, headers=FRESH)
