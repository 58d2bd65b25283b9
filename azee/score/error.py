"""The error of blocks that cannot be laid out."""

from __future__ import annotations

from azee.score.moment import Bound


class LayoutError(Exception):
    """Blocks that cannot be laid out.

    `code` is the stable name of the mistake (docs/language). `part` is the number of the block at
    fault in the order of writing, from 0, or None if the score itself is at fault. For an unknown
    name, `name` is that name, `known` are the valid names, and `bound` is the bound of the block
    that uses it, None for a hold.
    """

    def __init__(
        self,
        code: str,
        message: str,
        part: int | None = None,
        *,
        name: str | None = None,
        known: tuple[str, ...] = (),
        bound: Bound | None = None,
    ) -> None:
        super().__init__(message)
        self.code = code
        self.part = part
        self.name = name
        self.known = known
        self.bound = bound
