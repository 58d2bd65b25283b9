"""Blocks as an outline in text: a line a block, with its path, its mark and its comments."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from azee.blocks.view import Block


def outline(blocks: Sequence[Block]) -> str:
    """Return the blocks as lines; operands without operands stay on the line of their block."""
    lines = [line for block in blocks for line in _lines(block, 0)]
    column = max((len(path) for path, _ in lines), default=0) + 2
    return "".join(f"{path:{column}}{text}".rstrip() + "\n" for path, text in lines)


def _lines(block: Block, depth: int) -> Iterator[tuple[str, str]]:
    """Yield lines, each with the path of the block that it shows."""
    path, margin = ".".join(map(str, block.path)), " " * 4 * depth
    for comment in block.above:
        yield "", f"{margin}{comment}"
    if block.kind == "mistake":
        for n, line in enumerate(block.text.splitlines()):
            yield "" if n else path, f"{margin}! {line}"
        return
    inline = all(map(_is_plain, block.children))
    words = _words(block) if inline else _title(block)
    yield path, f"{margin}{words}{''.join(f'  {text}' for text in block.beside)}"
    for child in () if inline else block.children:
        yield from _lines(child, depth + 1)


def _title(block: Block) -> str:
    slot = "" if block.slot is None else f"'{block.slot} "
    return f"{slot}{block.text}{f' [{block.mark}]' if block.mark else ''}"


def _words(block: Block) -> str:
    """Return a block with its operands on one line; those of bones and sites in parentheses."""
    operands = [*map(_words, block.children)]
    if operands and block.kind in ("bone", "site"):
        return f"{_title(block)}({', '.join(operands)})"
    return " ".join([_title(block), *operands])


def _is_plain(block: Block) -> bool:
    if block.above or block.beside:
        return False
    return not block.children or block.kind in ("bone", "site")
