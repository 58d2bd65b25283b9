"""The pages of docs/language, and the fenced blocks that stand in them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
LANGUAGE = ROOT / "docs" / "language"

_FENCE = re.compile(r"^```(?P<info>[^\n]+)\n(?P<text>.*?)^```$", re.M | re.S)


@dataclass(frozen=True)
class Block:
    """A fenced block: `kind` is the first word behind the fence, `options` are the others."""

    line: int
    kind: str
    options: dict[str, str]
    text: str

    def __str__(self) -> str:
        return f"line {self.line}"


def page(name: str) -> str:
    """Return the text of a page of the manual."""
    return (LANGUAGE / name).read_text(encoding="utf-8")


def blocks(text: str) -> Iterator[Block]:
    """Yield the fenced blocks of a page. An option is a word such as `error=syntax` or `1:6`."""
    for m in _FENCE.finditer(text):
        kind, *words = m["info"].split()
        options = {key: value for key, _, value in (word.partition("=") for word in words)}
        yield Block(text.count("\n", 0, m.start()) + 1, kind, options, m["text"])


def pairs(found: list[Block]) -> Iterator[tuple[Block, Block | None]]:
    """Yield each block with the one that follows it."""
    yield from zip(found, [*found, None][1:], strict=True)
