"""Measures time with little influence of other processes on the machine."""

from __future__ import annotations

import time


class Clock:
    """Starts when it is made. It reads the lesser of clock time and processor time.

    On a busy machine, a long run waits for other processes again and again, and a short one does
    not. So ratios of clock times would be wrong. Processor time includes threads that only wait for
    work.
    """

    def __init__(self) -> None:
        self._wall, self._processor = time.perf_counter(), time.process_time()

    def seconds(self) -> float:
        """Time since then."""
        return min(time.perf_counter() - self._wall, time.process_time() - self._processor)
