"""Why blocks cannot be laid out."""

from __future__ import annotations


class LayoutError(Exception):
    """Blocks that cannot be laid out as asked.

    `code` is the stable name of the mistake (docs/language/errors), `part` the number of the
    block at fault in the order of writing, from 0, or None where the score itself is; `known` are
    the block names that would have been valid, where a name was not.
    """

    def __init__(
        self, code: str, message: str, part: int | None = None, known: tuple[str, ...] = ()
    ) -> None:
        super().__init__(message)
        self.code = code
        self.part = part
        self.known = known
