"""The process that compiles: `python -m azee.studio.worker ROOT [LIBRARY…]`, started by a server.

It reads jobs from standard input and writes answers to standard output, as `framing` says. While it
works, a thread goes on reading: of one page only the newest text waits, and a text that is being
compiled is given up when a newer one of the same page comes. It ends when its input does.
"""

from __future__ import annotations

import gc
import os
import sys
import threading
import time
from collections import deque
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from azee.studio.compiling import (
    SupersededError,
    compiled,
    evaluated,
    performed,
    posed,
    still,
)
from azee.studio.framing import Header, packed, read_message
from azee.studio.job import Job
from azee.studio.posing import NoSessionError, Posing
from azee.studio.postures import Postures
from azee_grammar.diagnostic import AZeeError
from azee_grammar.render import to_json

if TYPE_CHECKING:
    from azee.compilation import Compilation
    from azee.posing.text import PosedText

_PICTURE = (168, 210)
QUIET_S = 1.0
"""So long after the last key or drag pictures wait."""


class Inbox:
    """Jobs that wait: acts of posing, then the newest text of each page, then the rest.

    Pictures wait until nobody has typed or dragged for a while: one that is being drawn keeps the
    next text waiting.

    Args: quiet_s: for so long.
    """

    def __init__(self, quiet_s: float = QUIET_S) -> None:
        self._changed = threading.Condition()
        self._texts: dict[int, Header] = {}
        self._acts: deque[Header] = deque()
        self._others: deque[Header] = deque()
        self._pictures: deque[Header] = deque()
        self._quiet_s, self._quiet_from = quiet_s, 0.0
        self.given_up: list[int] = []

    def put(self, message: Header) -> None:
        """Take a message in; a text of the same page gives up its place in the queue for it."""
        with self._changed:
            if message["do"] in ("compile", "pose"):
                self._quiet_from = time.monotonic() + self._quiet_s
            if message["do"] == "compile":
                if older := self._texts.get(message["client"]):
                    self.given_up.append(older["job"])
                self._texts[message["client"]] = message
            elif message["do"] == "pose":
                self._acts.append(message)
            elif message["do"] == "picture":
                self._pictures.append(message)
            else:
                self._others.append(message)
            self._changed.notify()

    def take(self) -> tuple[Header, list[int]]:
        """Wait for a job; return it, with those that were given up before they began."""
        with self._changed:
            while (message := self._next()) is None:
                quiet_in = self._quiet_from - time.monotonic()
                self._changed.wait(quiet_in if self._pictures else None)
            gone, self.given_up = self.given_up, []
            return message, gone

    def _next(self) -> Header | None:
        """Return the job whose turn it is, if there is one now."""
        if self._acts:
            return self._acts.popleft()
        if self._texts:
            return self._texts.pop(next(iter(self._texts)))
        if self._others:
            return self._others.popleft()
        if self._pictures and time.monotonic() >= self._quiet_from:
            return self._pictures.popleft()
        return None

    def put_back(self, message: Header) -> None:
        """Take back a picture that a text or an act interrupted; it is the next one."""
        with self._changed:
            self._pictures.appendleft(message)

    def newer(self, client: int) -> bool:
        """Whether a newer text of a page waits."""
        with self._changed:
            return client in self._texts

    def has_urgent(self) -> bool:
        """Whether an act of posing or a text waits."""
        with self._changed:
            return bool(self._acts or self._texts)


class Worker:
    """Does one job after the other."""

    def __init__(self, root: Path, libraries: Sequence[Path], out: BinaryIO) -> None:
        self._root, self._libraries, self._out = root, libraries, out
        self._postures, self._posing = Postures(), Posing()
        self.inbox = Inbox()

    def read(self, stream: BinaryIO) -> None:
        """Read jobs until the input ends; then end the process, whatever it does."""
        while (message := read_message(stream)) is not None:
            self.inbox.put(message[0])
        os._exit(0)

    def run(self) -> None:
        """Work for ever."""
        self._warm_up()
        self._tell({"kind": "ready"})
        while True:
            message, gone = self.inbox.take()
            for job in gone:
                self._tell({"kind": "superseded", "job": job, "last": True})
            self._tell({"kind": "begun", "job": message["job"]})
            try:
                self._do(message)
            except SupersededError:
                if message["do"] == "compile":
                    self._end(message, {"kind": "superseded"})
                else:
                    self.inbox.put_back(message)
            except AZeeError as error:
                found = [to_json(d) for d in error.diagnostics]
                self._end(message, {"kind": "refused", "diagnostics": found})
            else:
                self._end(message, {"kind": "done"})

    def _do(self, message: Header) -> None:
        work = {
            "compile": self._compile,
            "export": self._export,
            "picture": self._picture,
            "body": self._body,
            "pose": self._pose,
            "hang": self._hang,
        }
        work[message["do"]](message)

    def _hang(self, message: Header) -> None:
        """Do nothing for ever: what tests of the server ask for, and no page can."""
        threading.Event().wait()

    def _compile(self, message: Header) -> None:
        def check() -> None:
            if self.inbox.newer(message["client"]):
                raise SupersededError

        job = Job(**message["what"])
        answers = compiled(job, self._root, self._libraries, check, self._postures)
        for header, payload in answers:
            self._tell({**header, "job": message["job"]}, payload)

    def _picture(self, message: Header) -> None:
        """Draw a still; drags and texts that are typed go first, for somebody waits for them."""

        def check() -> None:
            if self.inbox.has_urgent():
                raise SupersededError

        job = Job(**message["what"])
        data = still(job, self._root, self._libraries, _PICTURE, check, self._postures)
        self._tell({"kind": "picture", "job": message["job"]}, data)

    def _pose(self, message: Header) -> None:
        """Do an act of posing; what cannot be dragged is told in the answer."""

        def made() -> tuple[PosedText, Compilation]:
            return posed(Job(**message["what"]), self._root, self._libraries, self._postures)

        answer: dict[str, Any] = {name: message[name] for name in ("act", "session", "serial")}
        try:
            answer |= self._posing.act(message, made)
        except NoSessionError:
            answer["lost"] = True
        except AZeeError as error:
            answer["message"] = error.diagnostics[0].message
        self._tell({**answer, "kind": "posed", "job": message["job"]})

    def _export(self, message: Header) -> None:
        job, path = Job(**message["what"]), Path(message["path"])
        found, score, program = evaluated(job, self._root, self._libraries)
        if score is None:
            raise AZeeError(*found)
        performed(job, score, program, lambda: None, self._postures).save(path)

    def _body(self, message: Header) -> None:
        from azee.export.formats.glb import write_body
        from azee_rig.load import load_rig

        write_body(load_rig(message["rig"]), message["path"])

    def _warm_up(self) -> None:
        """Load language, body and solver, so that the first text is as quick as others."""
        job = Job(0, "warm.azee", "key 1\n    place @I_TIP(s) @CH\n")
        for _ in compiled(job, self._root, self._libraries, lambda: None, self._postures):
            pass
        gc.freeze()
        gc.set_threshold(50_000, 20, 20)

    def _end(self, message: Header, answer: dict[str, Any]) -> None:
        self._tell({**answer, "job": message["job"], "last": True})

    def _tell(self, header: Header, payload: bytes = b"") -> None:
        self._out.write(packed(header, payload))
        self._out.flush()


def main(arguments: Sequence[str]) -> None:
    """Run a worker on this process' own input and output."""
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what libraries print goes where errors go
    root, *libraries = map(Path, arguments)
    worker = Worker(root, libraries, out)
    threading.Thread(target=worker.read, args=(sys.stdin.buffer,), daemon=True).start()
    worker.run()


if __name__ == "__main__":
    main(sys.argv[1:])
