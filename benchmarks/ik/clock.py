"""Time that others on the machine have little part in."""

from __future__ import annotations

import time


class Clock:
    """Starts when it is made. Reads whichever is less, time by the clock or of the processor.

    On a busy machine a long run waits for others again and again and a short one does not: by the
    clock, ratios would lie. Threads that only wait for work add up on the processor's side.
    """

    def __init__(self) -> None:
        self._wall, self._processor = time.perf_counter(), time.process_time()

    def seconds(self) -> float:
        """Time since then."""
        return min(time.perf_counter() - self._wall, time.process_time() - self._processor)
