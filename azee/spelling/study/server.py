"""The study's pages over HTTP, for this machine only. Needs Starlette (extra `study`)."""

from __future__ import annotations

import secrets
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader
from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware
from starlette.middleware.trustedhost import TrustedHostMiddleware
from starlette.requests import Request
from starlette.responses import FileResponse, HTMLResponse, RedirectResponse, Response
from starlette.routing import Route

from azee.spelling.study.answers import Answers, Participant
from azee.spelling.study.design import Comparison, comparisons
from azee.spelling.study.manifest import MEDIA, Manifest
from azee.spelling.study.questions import AGES, CHOICES, FLUENCIES, OPEN, WHICH
from azee.spelling.study.sample_size import sentence

COOKIE = "azee-study"
COOKIE_S = 90 * 24 * 3600
LARGEST_FORM = 100_000
"""Bytes; five open questions take less."""
LONGEST_TEXT, LONGEST_NAME = 10_000, 200
SECURITY = {
    "Content-Security-Policy": "default-src 'none'; media-src 'self'; img-src 'self'; "
    "style-src 'unsafe-inline'; form-action 'self'; frame-ancestors 'none'; base-uri 'none'",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "Cache-Control": "no-store",
}


def study_app(manifest: Manifest, answers: Answers) -> Starlette:
    """Return the application: who you are, instructions, the pages, open questions, thanks.

    A browser is known by a cookie, so that whoever comes back goes on where the last answer was.
    """
    pages = _Pages(manifest, answers)
    routes = [
        Route("/", pages.home),
        Route("/begin", pages.begin, methods=["POST"]),
        Route("/instructions", pages.instructions),
        Route("/page/{number:int}", pages.page, methods=["GET", "POST"]),
        Route("/clip/{number:int}/{place:int}", pages.clip),
        Route("/sample", pages.sample),
        Route("/closing", pages.closing, methods=["GET", "POST"]),
        Route("/done", pages.done),
    ]
    hosts = Middleware(TrustedHostMiddleware, allowed_hosts=["127.0.0.1", "localhost"])
    return Starlette(
        routes=routes, middleware=[hosts], exception_handlers={HTTPException: pages.problem}
    )


class _Pages:
    def __init__(self, manifest: Manifest, answers: Answers) -> None:
        self._manifest, self._answers = manifest, answers
        self._templates = Environment(
            loader=PackageLoader("azee.spelling.study"), autoescape=True, trim_blocks=True
        )
        self._count = manifest.design.page_count

    async def home(self, request: Request) -> Response:
        """Show who begins the first page, and lead others to where they left."""
        participant = self._participant(request)
        if participant is None:
            return self._show(
                "home.html", 1, ages=AGES, fluencies=FLUENCIES, size=sentence(self._words)
            )
        return _to(self._next(participant))

    async def begin(self, request: Request) -> Response:
        """Take a participant in."""
        form = await _form(request)
        age, fluency = form.get("age", ""), form.get("fluency", "")
        if age not in AGES or fluency not in FLUENCIES:
            raise HTTPException(400, "Please choose your age and how fluent you are.")
        key = secrets.token_urlsafe(24)
        name, mail = (form.get(field, "")[:LONGEST_NAME] for field in ("name", "mail"))
        self._answers.begin(key, age, fluency, name, mail)
        response = _to("/instructions")
        response.set_cookie(COOKIE, key, COOKIE_S, httponly=True, samesite="strict")
        return response

    async def instructions(self, request: Request) -> Response:
        """Say what is to be done, with a sample clip."""
        self._known(request)
        sample = self._manifest.sample
        return self._show("instructions.html", 2, sample=sample and _kind(sample), next="/page/1")

    async def page(self, request: Request) -> Response:
        """Show two clips, or keep which of them was chosen."""
        participant = self._known(request)
        number, compared = self._compared(request, participant)
        choices = CHOICES if self._manifest.design.no_difference else CHOICES[:2]
        if request.method == "POST":
            chosen = (await _form(request)).get("choice")
            choice = next((known for known in choices if known == chosen), None)
            if choice is None:
                raise HTTPException(400, "Please choose a clip, then go on.")
            self._answers.choose(participant, number, choice)
            return _to(f"/page/{number + 1}" if number < self._count else "/closing")
        kinds = [
            _kind(self._manifest.clips[compared.word, kind])
            for kind in (compared.first, compared.second)
        ]
        chosen = self._answers.choices(participant).get(number)
        return self._show(
            "page.html", number + 2, question=WHICH, number=number, kinds=kinds,
            choices=choices, chosen=chosen,
        )  # fmt: skip

    async def clip(self, request: Request) -> Response:
        """Send the first or second clip of a page; its address does not say what it is."""
        _, compared = self._compared(request, self._known(request))
        kinds = {1: compared.first, 2: compared.second}
        kind = kinds.get(request.path_params["place"])
        if kind is None:
            raise HTTPException(404, "There is no such clip.")
        return _file(self._manifest.clips[compared.word, kind])

    async def sample(self, request: Request) -> Response:
        """Send the sample clip."""
        if self._manifest.sample is None:
            raise HTTPException(404, "There is no sample.")
        return _file(self._manifest.sample)

    async def closing(self, request: Request) -> Response:
        """Ask the open questions, or keep their answers; only after all pages."""
        participant = self._known(request)
        if len(self._answers.choices(participant)) < self._count:
            return _to(self._next(participant))
        if request.method == "POST":
            form = await _form(request)
            texts = [form.get(f"remark-{i}", "")[:LONGEST_TEXT] for i in range(len(OPEN))]
            self._answers.finish(participant, texts)
            return _to("/done")
        return self._show("closing.html", self._count + 3, questions=OPEN, back=self._count)

    async def done(self, request: Request) -> Response:
        """Thank."""
        return self._show("done.html", self._count + 3)

    async def problem(self, request: Request, error: Exception) -> Response:
        """Say what is wrong, in words."""
        assert isinstance(error, HTTPException)
        page = self._show("problem.html", 0, message=error.detail)
        page.status_code = error.status_code
        return page

    @property
    def _words(self) -> int:
        return len(self._manifest.design.words)

    def _participant(self, request: Request) -> Participant | None:
        return self._answers.participant(request.cookies.get(COOKIE, ""))

    def _known(self, request: Request) -> Participant:
        participant = self._participant(request)
        if participant is None:
            raise HTTPException(403, "Please begin on the first page.")
        return participant

    def _compared(self, request: Request, participant: Participant) -> tuple[int, Comparison]:
        number = request.path_params["number"]
        if not 1 <= number <= self._count:
            raise HTTPException(404, "There is no such page.")
        return number, comparisons(self._manifest.design, participant.number)[number - 1]

    def _next(self, participant: Participant) -> str:
        """Return where a participant goes on: the first page without an answer."""
        if participant.finished:
            return "/done"
        chosen = self._answers.choices(participant)
        if not chosen:
            return "/instructions"
        left = [number for number in range(1, self._count + 1) if number not in chosen]
        return f"/page/{left[0]}" if left else "/closing"

    def _show(self, template: str, step: int, **values: Any) -> HTMLResponse:
        text = self._templates.get_template(template).render(
            title=self._manifest.title, language=self._manifest.language, step=step,
            steps=self._count + 3, count=self._count, **values,
        )  # fmt: skip
        return HTMLResponse(text, headers=SECURITY)


async def _form(request: Request) -> dict[str, str]:
    """Read a form. Raises: HTTPException: it is too large, or is sent by another site's page."""
    if int(request.headers.get("content-length") or LARGEST_FORM + 1) > LARGEST_FORM:
        raise HTTPException(413, "That is too much text.")
    origin = request.headers.get("origin")
    if origin not in (None, "null", str(request.base_url).rstrip("/")):
        raise HTTPException(403, "This form comes from another site.")
    form = await request.form(max_files=0)
    return {name: value for name, value in form.items() if isinstance(value, str)}


def _to(path: str) -> RedirectResponse:
    return RedirectResponse(path, status_code=303, headers=SECURITY)


def _file(path: Path) -> FileResponse:
    return FileResponse(path, media_type=MEDIA[path.suffix.lower()], headers=SECURITY)


def _kind(path: Path) -> str:
    return MEDIA[path.suffix.lower()].partition("/")[0]
