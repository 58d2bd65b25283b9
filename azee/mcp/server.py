"""The server: each tool is a command of azee, for a text that is given instead of a file.

Texts are read and bodies solved as the commands do it. A text with mistakes is answered by its
diagnostics in JSON, fixes included.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path
from threading import Lock
from typing import Any

from mcp.server import MCPServer
from mcp.server.mcpserver import Image
from mcp.server.mcpserver.exceptions import ToolError

from azee.compilation import Compilation, perform, score_of
from azee.export.pictures.scene import Look
from azee.export.pictures.shots import SHOTS
from azee.export.pictures.still import write_moments, write_sheet
from azee.export.score_text import tree
from azee.formats import FILM_SUFFIXES, WRITERS
from azee.lang.program import Program, load
from azee.lang.rule_table import rule_as_json, shipped_rules, speaks_of
from azee.quality.outcome import outcome
from azee_grammar.diagnostic import AZeeError
from azee_grammar.render import to_json
from azee_grammar.source import Source
from azee_rig.load import load_rig, shipped_rigs

INSTRUCTIONS = """\
Write texts in AZee, a formal language of sign languages, and make a body sign them. Look rules up
with `rules`, never invent names. `check` a text and put the first of a diagnostic's `fixes` in the
marked place until nothing is reported; then `score`, `compile` or `render` it. What you make is a
draft that no deaf person has judged: say so."""

PICTURE = (640, 672)
"""Pixels of a picture, and twice the height of those on a sheet."""


class Tools:
    """The tools. folder: where the server was started, in which files are written."""

    def __init__(self, folder: Path, libraries: Sequence[Path] = ()) -> None:
        self._folder = folder.resolve()
        self._libraries = tuple(libraries)
        self._one_at_a_time = Lock()

    def rules(self, search: str = "", name: str = "") -> dict[str, Any]:
        """List rules with their meaning, source, status and arguments.

        They are those that speak of `search`, or the one of a name; without either, all.
        """
        plain = name.removeprefix(":")
        return {
            "rules": [
                rule_as_json(rule)
                for found in shipped_rules().values()
                for rule in found
                if (rule.name == plain if plain else speaks_of(rule, search))
            ]
        }

    def check(self, text: str) -> dict[str, Any]:
        """Tell what is wrong with a text.

        The `fixes` of a diagnostic are texts for the marked place, the most probable first. Lines
        and columns count from 1, ends are exclusive.
        """
        try:
            found = self._program(text).check()
        except AZeeError as error:
            found = error.diagnostics
        return {"diagnostics": [to_json(diagnostic) for diagnostic in found]}

    def score(self, text: str) -> str:
        """Print the score of a text: nested blocks with their times in seconds."""
        with _mistakes_told():
            return tree(score_of(self._program(text), None, None))

    def compile(self, text: str, path: str, rig: str = "signer") -> dict[str, Any]:
        """Write the movement of a text into a file in the server's folder.

        The suffix of the path is the format, such as .glb or .bvh. The answer tells how long the
        movement is, and how well the body met the constraints.
        """
        target = self._target(path)
        with _mistakes_told():
            made = self._made(text, rig)
            made.save(target)
        return {
            "path": str(target.relative_to(self._folder)),
            "duration_s": made.clip.duration_s,
            "met": made.report.met,
            "outcome": outcome(made.report),
        }

    def render(
        self, text: str, time_s: float | None = None, view: str = "front", rig: str = "signer"
    ) -> Image:
        """Draw a text: its key postures, or the posture at a time in seconds."""
        if view not in SHOTS:
            raise ToolError(f"there is no view `{view}`; there are {', '.join(SHOTS)}")
        look = Look(PICTURE, (view,), captions=True, transparent=False)
        with _mistakes_told(), tempfile.TemporaryDirectory() as folder:
            made = self._made(text, rig)
            path = Path(folder) / "picture.png"
            if time_s is None:
                write_sheet(made.clip, made.rig, path, look, made.animation.key_times)
            else:
                write_moments(made.clip, made.rig, path, look, [time_s])
            return Image(data=path.read_bytes(), format="png")

    def _program(self, text: str) -> Program:
        return load(Source("<text>", text), self._libraries)

    def _made(self, text: str, rig: str) -> Compilation:
        if rig not in shipped_rigs():
            raise ToolError(f"there is no body `{rig}`; there are {', '.join(shipped_rigs())}")
        with self._one_at_a_time:
            return perform(score_of(self._program(text), None, None), load_rig(rig))

    def _target(self, path: str) -> Path:
        target = (self._folder / path).resolve()
        if not target.is_relative_to(self._folder) or target == self._folder:
            raise ToolError(f"`{path}` is not inside the folder in which the server was started")
        suffixes = [suffix for suffix in WRITERS if suffix not in FILM_SUFFIXES]
        if target.suffix not in suffixes:
            raise ToolError(f"no format has the suffix of `{path}`; there are {' '.join(suffixes)}")
        return target


@contextmanager
def _mistakes_told() -> Iterator[None]:
    """Answer mistakes in the text, and what cannot be written, with diagnostics in JSON."""
    try:
        yield
    except AZeeError as error:
        told = {"diagnostics": [to_json(diagnostic) for diagnostic in error.diagnostics]}
        raise ToolError(json.dumps(told, ensure_ascii=False)) from error


def make_server(folder: Path, libraries: Sequence[Path] = ()) -> MCPServer[Any]:
    """Return a server with the tools.

    Args: folder: in which `compile` may write. libraries: folders of rules that texts may use.
    """
    server: MCPServer[Any] = MCPServer(
        "azee", instructions=INSTRUCTIONS, version=version("azee"), log_level="ERROR"
    )
    tools = Tools(folder, libraries)
    for tool in (tools.rules, tools.check, tools.score, tools.compile, tools.render):
        server.add_tool(tool)
    return server
