"""`azee mcp` as clients see it: by the client of the protocol's own SDK."""

from __future__ import annotations

import asyncio
import base64
import io
import json
import os
import sys
from collections.abc import Awaitable, Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import pytest
from mcp import Client, StdioServerParameters
from mcp.types import CallToolResult, ImageContent, TextContent
from PIL import Image
from programs import Python

from azee.cli.main import run
from azee.mcp.server import make_server

T = TypeVar("T")
LOOK = "key .2 (look ^fwd)\n"


def _asked(folder: Path, ask: Callable[[Client], Awaitable[T]]) -> T:
    """Return what a client in this process learns from a server whose folder is given."""

    async def talk() -> T:
        async with Client(make_server(folder)) as client:
            return await ask(client)

    return asyncio.run(talk())


def _called(folder: Path, tool: str, **arguments: object) -> CallToolResult:
    return _asked(folder, lambda client: client.call_tool(tool, arguments))


def _data(result: CallToolResult) -> Mapping[str, Any]:
    assert not result.is_error, result.content
    data: Mapping[str, Any] | None = result.structured_content
    assert data is not None
    return data


def _refusal(result: CallToolResult) -> str:
    assert result.is_error
    (content,) = result.content
    assert isinstance(content, TextContent)
    return content.text


def test_the_tools_and_what_they_take(tmp_path: Path) -> None:
    listed = _asked(tmp_path, lambda client: client.list_tools())
    needed = {tool.name: tool.input_schema.get("required", []) for tool in listed.tools}
    assert needed == {
        "rules": [],
        "check": ["text"],
        "score": ["text"],
        "compile": ["text", "path"],
        "render": ["text"],
    }
    assert all(tool.description for tool in listed.tools)


def test_rules_are_those_of_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for arguments, options in (
        ({"name": ":info-about"}, ["info-about"]),
        ({"search": "AGE"}, ["--search", "AGE"]),
    ):
        run(["rules", "--format", "json", *options])
        expected = json.loads(capsys.readouterr().out)["rules"]
        assert expected
        assert _data(_called(tmp_path, "rules", **arguments))["rules"] == expected


def test_check_gives_the_diagnostics_of_the_command(tmp_path: Path) -> None:
    (diagnostic,) = _data(_called(tmp_path, "check", text=":arbe\n"))["diagnostics"]
    assert (diagnostic["code"], diagnostic["fixes"]) == ("unknown-rule", [":arbre"])
    (diagnostic,) = _data(_called(tmp_path, "check", text="key (\n"))["diagnostics"]
    assert diagnostic["line"] == 1
    assert _data(_called(tmp_path, "check", text=":arbre\n")) == {"diagnostics": []}


def test_score_is_the_tree_of_the_command(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run(["score", "-e", LOOK])
    expected = capsys.readouterr().out
    assert _data(_called(tmp_path, "score", text=LOOK)) == {"result": expected}
    told = json.loads(_refusal(_called(tmp_path, "score", text=":arbe\n")).partition(": ")[2])
    assert [d["code"] for d in told["diagnostics"]] == ["unknown-rule"]


@pytest.mark.parametrize("path", ["../out.glb", "", "out.txt", "out.mp4"])
def test_compile_writes_no_other_file(path: str, tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    refusal = _refusal(_called(folder, "compile", text=LOOK, path=path))
    assert "is not inside the folder" in refusal or "no format has the suffix" in refusal
    assert [*tmp_path.rglob("*")] == [folder]


def test_bodies_and_views_are_named(tmp_path: Path) -> None:
    assert "signer" in _refusal(_called(tmp_path, "compile", text=LOOK, path="a.glb", rig="/etc"))
    assert "front" in _refusal(_called(tmp_path, "render", text=LOOK, view="moon"))


@pytest.mark.slow
def test_compile_and_render(tmp_path: Path) -> None:
    made = _data(_called(tmp_path, "compile", text=LOOK, path="look.bvh"))
    assert made["met"]
    assert made["outcome"] == "1 constraint is met"
    assert (tmp_path / "look.bvh").read_text().startswith("HIERARCHY")
    told = json.loads(
        _refusal(_called(tmp_path, "compile", text=LOOK, path="no/a.bvh")).partition(": ")[2]
    )
    assert told["diagnostics"][0]["code"] == "cannot-write"
    (content,) = _called(tmp_path, "render", text=LOOK, time_s=0.1).content
    assert isinstance(content, ImageContent)
    with Image.open(io.BytesIO(base64.b64decode(content.data))) as picture:
        assert picture.size == (640, 672)


@pytest.mark.slow
def test_a_client_starts_the_command(tmp_path: Path) -> None:
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    command = StdioServerParameters(
        command=sys.executable, args=["-m", "azee", "mcp"], env=environment, cwd=tmp_path
    )

    async def talk() -> CallToolResult:
        async with Client(command) as client:
            return await client.call_tool("check", {"text": ":arbe\n"})

    (diagnostic,) = _data(asyncio.run(talk()))["diagnostics"]
    assert diagnostic["fixes"] == [":arbre"]


def test_without_the_extra_the_command_says_how_to_get_it(python: Python) -> None:
    script = "import sys; sys.modules['mcp'] = None; from azee.cli.main import run; "
    done = python("-c", f"{script}sys.exit(run(['mcp']))", expect=1)
    assert "pip install 'azee[mcp]'" in done.stderr
    assert "Traceback" not in done.stderr
