"""The server's side of the worker: sends it jobs, hands its answers on, starts it again.

A worker that was killed, that crashed or that takes too long is started again, and gets the jobs
that still wait. The job that it was doing is tried once more; then it is given up, and who asked is
told so.
"""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import os
import signal
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from azee.studio.folder import RefusedError
from azee.studio.framing import LENGTHS, Header, packed, unpacked

LIMITS_S = {
    "compile": 60.0,
    "export": 600.0,
    "picture": 60.0,
    "body": 60.0,
    "pose": 60.0,
    "hang": 0.5,
}
"""How long a job may take before the worker is killed."""
START_S = 120.0
"""How long a worker may take to start: the first time on a machine it compiles the solver."""
MOST_WAITING = 64
"""Jobs that wait, of all pages together."""
TRIES = 2
PAUSE_S = 0.5
"""Before a worker that died at once is started again."""

Deliver = Callable[[Header, bytes], None]


@dataclass(slots=True, eq=False)
class _Pending:
    message: Header
    deliver: Deliver
    tries: int = 0


class Compiler:
    """The one worker of a server.

    Args: root: the open folder. libraries: where `use` looks besides.
    """

    def __init__(self, root: Path, libraries: Sequence[Path]) -> None:
        self._arguments = [str(root), *map(str, libraries)]
        self._numbers = itertools.count(1)
        self._pending: dict[int, _Pending] = {}
        self._process: asyncio.subprocess.Process | None = None
        self._task: asyncio.Task[None] | None = None
        self._watch: asyncio.TimerHandle | None = None
        self._doing: int | None = None
        self._too_long = False
        self.starts = 0

    @property
    def process_id(self) -> int | None:
        """Number of the worker's process, while there is one."""
        return self._process.pid if self._process else None

    def start(self) -> None:
        """Start the worker; it is kept alive until `close`."""
        self._task = asyncio.create_task(self._keep_alive())

    async def close(self) -> None:
        """End the worker."""
        if self._task:
            self._task.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._task
        self._kill()
        if self._process:
            await self._process.wait()

    def submit(self, message: Header, deliver: Deliver) -> None:
        """Send a job; `deliver` gets every answer, the last with `last`.

        Raises: RefusedError: too many wait.
        """
        if len(self._pending) >= MOST_WAITING:
            raise RefusedError(503, "too much is being compiled; try again in a moment")
        number = next(self._numbers)
        self._pending[number] = _Pending({**message, "job": number}, deliver)
        self._send(number)

    async def request(self, message: Header) -> tuple[Header, bytes]:
        """Send a job and return its last answer, with the bytes that came before it.

        Raises: RefusedError.
        """
        done: asyncio.Future[Header] = asyncio.get_running_loop().create_future()
        payload = b""

        def deliver(header: Header, data: bytes) -> None:
            nonlocal payload
            payload = data or payload
            if header.get("last") and not done.done():
                done.set_result(header)

        self.submit(message, deliver)
        header = await done
        if header["kind"] == "stopped":
            raise RefusedError(503, header["reason"])
        return header, payload

    def forget(self, client: int) -> None:
        """Drop the jobs of a page that is gone, but for the one that is being done."""
        for number, pending in list(self._pending.items()):
            if pending.message.get("client") == client:
                pending.deliver = lambda header, payload: None
                if number != self._doing:
                    del self._pending[number]

    def _send(self, number: int) -> None:
        if self._process and self._process.stdin and self._process.returncode is None:
            with contextlib.suppress(ConnectionError):
                self._process.stdin.write(packed(self._pending[number].message))

    async def _keep_alive(self) -> None:
        while True:
            began = asyncio.get_running_loop().time()
            await self._live()
            self._clear_up()
            if asyncio.get_running_loop().time() - began < PAUSE_S:
                await asyncio.sleep(PAUSE_S)

    async def _live(self) -> None:
        """Start a worker and hand its answers on until it ends."""
        path = os.pathsep.join(p for p in sys.path if p)
        process = await asyncio.create_subprocess_exec(
            sys.executable, "-m", "azee.studio.worker", *self._arguments,
            stdin=asyncio.subprocess.PIPE, stdout=asyncio.subprocess.PIPE,
            env=os.environ | {"PYTHONPATH": path},
        )  # fmt: skip
        self._process, self._too_long = process, False
        self.starts += 1
        assert process.stdout is not None
        self._limit(START_S)
        for number in list(self._pending):
            self._send(number)
        with contextlib.suppress(asyncio.IncompleteReadError, ConnectionError):
            while True:
                lengths = await process.stdout.readexactly(LENGTHS.size)
                head, payload = LENGTHS.unpack(lengths)
                header = unpacked(await process.stdout.readexactly(head))
                self._answered(header, await process.stdout.readexactly(payload))
        self._kill()
        await process.wait()

    def _answered(self, header: Header, payload: bytes) -> None:
        number = header.pop("job", None)
        if header["kind"] == "ready":
            self._limit(None)
            return
        pending = self._pending.get(number) if number is not None else None
        if header["kind"] == "begun":
            self._doing = number
            self._limit(LIMITS_S[pending.message["do"]] if pending else START_S)
            return
        if header.get("last") and number is not None:
            if number == self._doing:
                self._doing = None
                self._limit(None)
            self._pending.pop(number, None)
        if pending:
            number = pending.message.get("what", {}).get("number")
            pending.deliver({"number": number, **header}, payload)

    def _limit(self, seconds: float | None) -> None:
        """Kill the worker if nothing changes within some seconds."""
        if self._watch:
            self._watch.cancel()
        loop = asyncio.get_running_loop()
        self._watch = None if seconds is None else loop.call_later(seconds, self._is_too_long)

    def _is_too_long(self) -> None:
        self._too_long = True
        self._kill()

    def _kill(self) -> None:
        if self._process and self._process.returncode is None:
            with contextlib.suppress(ProcessLookupError):
                self._process.send_signal(signal.SIGKILL)

    def _clear_up(self) -> None:
        """After the end of a worker: give up the job that it was doing, if it was tried enough."""
        self._limit(None)
        number, self._doing = self._doing, None
        pending = self._pending.get(number) if number is not None else None
        if pending is None or number is None:
            return
        pending.tries += 1
        if self._too_long or pending.tries >= TRIES:
            del self._pending[number]
            limit = LIMITS_S[pending.message["do"]]
            why = f"took longer than {limit:g} s" if self._too_long else "stopped the compiler"
            answer: dict[str, Any] = {"kind": "stopped", "reason": f"this {why}", "last": True}
            answer["number"] = pending.message.get("what", {}).get("number")
            pending.deliver(answer, b"")
