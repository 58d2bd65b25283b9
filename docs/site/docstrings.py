"""Docstrings as reStructuredText: plain sentences become plain paragraphs, whatever they hold.

Ours are prose with `code` in single backticks, headings such as `Args:` at the beginning of a line,
and indented blocks that are formulas or examples. None of it is markup of Sphinx, in which a star
or an underscore of a formula would have a meaning.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import groupby

HEADING = re.compile(r"(Args|Returns|Raises|Yields|Attributes|Note|Example)s?:(?=\s|$)")
CODE = re.compile(r"`+([^`]+)`+")
SPECIAL = re.compile(r"([\\*_|`<>:\[\]])")


def as_rst(lines: Sequence[str]) -> list[str]:
    """Return the lines of a docstring, whose indentation is removed, as reStructuredText."""
    out: list[str] = []
    for empty, group in groupby(lines, key=lambda line: not line.strip()):
        if not empty:
            for indented, block in groupby(
                _headed(list(group)), key=lambda b: b[0].startswith("  ")
            ):
                for part in block:
                    out += _literal(part) if indented else [_paragraph(part)]
                    out.append("")
    return out


def _headed(lines: Sequence[str]) -> Iterator[list[str]]:
    """Split a paragraph before each heading, and where it turns from prose to an indented block."""
    block: list[str] = []
    for line in lines:
        starts = HEADING.match(line) is not None
        # A line that is indented goes on a heading's text; else it is a block of its own.
        hangs = line.startswith(" ") and bool(block) and HEADING.match(block[0]) is not None
        turns = bool(block) and line.startswith("  ") != block[0].startswith("  ") and not hangs
        if block and (starts or turns):
            yield block
            block = []
        block.append(line)
    if block:
        yield block


def _paragraph(lines: Sequence[str]) -> str:
    text = " ".join(line.strip() for line in lines)
    heading = HEADING.match(text)
    if heading is None:
        return _escaped(text)
    return f"**{heading[0]}** {_escaped(text[heading.end() :].strip())}".rstrip()


def _literal(lines: Sequence[str]) -> list[str]:
    return ["::", "", *(f"    {line}" for line in lines)]


def _escaped(text: str) -> str:
    """Return prose without any markup but code."""
    out, end = [], 0
    for m in CODE.finditer(text):
        out += [SPECIAL.sub(r"\\\1", text[end : m.start()]), f"\\ ``{m[1].strip()}``\\ "]
        end = m.end()
    return "".join([*out, SPECIAL.sub(r"\\\1", text[end:])])
