"""The blocks of docs/language/syntax.md parse, or have the mistake they say they have."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import azee_grammar
from azee_grammar.parser import parse
from azee_grammar.source import Source

PAGE = Path(__file__).parents[2] / "docs" / "language" / "syntax.md"
BLOCK = re.compile(r"^```azee(?: error=(?P<code>[a-z-]+))?\n(?P<text>.*?)^```$", re.M | re.S)


def blocks() -> list[object]:
    text = PAGE.read_text(encoding="utf-8")
    return [
        pytest.param(m["text"], m["code"], id=f"line {text.count(chr(10), 0, m.start()) + 1}")
        for m in BLOCK.finditer(text)
    ]


@pytest.mark.parametrize(("text", "code"), blocks())
def test_block(text: str, code: str | None) -> None:
    found = {diagnostic.code for diagnostic in parse(Source("syntax.md", text)).diagnostics}
    assert found == ({code} if code else set())


def test_every_code_of_the_parser_is_listed() -> None:
    package = Path(azee_grammar.__file__).parent
    code = "".join(file.read_text(encoding="utf-8") for file in package.glob("*.py"))
    used = set(re.findall(r'Diagnostic\(\s*"([a-z0-9-]+)"', code))
    listed = set(re.findall(r"`([a-z0-9-]+)`", PAGE.read_text("utf-8").split("## Mistakes")[1]))
    assert len(used) > 10
    assert used <= listed
