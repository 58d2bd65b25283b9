"""Why blocks cannot be laid out."""

from __future__ import annotations

from azee.score.moment import Bound


class LayoutError(Exception):
    """Blocks that cannot be laid out as asked.

    `code` is the stable name of the mistake (docs/language), `part` the number of the block at
    fault in the order of writing, from 0, or None where the score itself is. Where a name means
    nothing, `name` is that name, `known` are those that would have been valid, and `bound` says
    which bound of the block names it, None if it is a hold.
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
