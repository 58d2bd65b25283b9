"""The worker: the newest text wins, and whatever happens to it, the next text is compiled."""

from __future__ import annotations

import asyncio
import os
import signal
import time
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

from azee.studio.compiler import MOST_WAITING, Compiler
from azee.studio.folder import RefusedError
from azee.studio.job import Job
from azee.studio.worker import Inbox

pytestmark = pytest.mark.slow
KEY = "key .5\n    place @I_TIP(s) @CH\n"


def job(text: str, number: int = 1) -> dict[str, Any]:
    what = Job(number, "a.azee", text, life=False, fps=10.0).as_json()
    return {"do": "compile", "client": 1, "what": what}


def with_compiler(folder: Path, work: Callable[[Compiler], Awaitable[None]]) -> None:
    async def run() -> None:
        compiler = Compiler(folder, [])
        compiler.start()
        try:
            await asyncio.wait_for(work(compiler), 280)
        finally:
            await compiler.close()

    asyncio.run(run())


def test_of_one_page_only_the_newest_text_waits() -> None:
    inbox = Inbox()
    for number in range(1, 5):
        inbox.put({"do": "compile", "client": number % 2, "job": number})
    inbox.put({"do": "export", "job": 9})
    assert [inbox.take()[0]["job"] for _ in range(3)] == [3, 4, 9]
    inbox.put({"do": "compile", "client": 0, "job": 10})
    inbox.put({"do": "compile", "client": 0, "job": 11})
    inbox.put({"do": "compile", "client": 1, "job": 16})
    inbox.put({"do": "compile", "client": 0, "job": 17})
    assert inbox.newer(0)
    message, given_up = inbox.take()
    assert (message["job"], given_up) == (17, [10, 11])  # who types on does not wait for ever
    assert inbox.take()[0]["job"] == 16
    inbox.put({"do": "picture", "job": 12})
    assert not inbox.has_urgent()
    inbox.put({"do": "compile", "client": 0, "job": 13})
    inbox.put({"do": "pose", "client": 0, "job": 14})
    inbox.put({"do": "pose", "client": 0, "job": 15})
    assert inbox.has_urgent()
    assert [inbox.take()[0]["job"] for _ in range(4)] == [14, 15, 13, 12]


def test_pictures_wait_until_nobody_has_typed_for_a_while() -> None:
    inbox = Inbox(quiet_s=0.3)
    inbox.put({"do": "picture", "job": 1})
    typed_s = time.monotonic()
    inbox.put({"do": "compile", "client": 0, "job": 2})
    inbox.put({"do": "body", "job": 3})
    assert [inbox.take()[0]["job"] for _ in range(2)] == [2, 3]
    assert inbox.take()[0]["job"] == 1
    assert time.monotonic() >= typed_s + 0.3
    inbox.put_back({"do": "picture", "job": 1})
    assert inbox.take()[0]["job"] == 1


def test_of_many_texts_the_last_is_shown_and_all_are_answered(tmp_path: Path) -> None:
    async def work(compiler: Compiler) -> None:
        kinds: dict[int, list[str]] = {}
        done = asyncio.Event()

        def deliver(header: dict[str, Any], _: bytes) -> None:
            kinds.setdefault(header["number"] or 0, []).append(header["kind"])
            if header["number"] == 20 and header.get("last"):
                done.set()

        for number in range(1, 21):
            compiler.submit(job(KEY, number), deliver)
        await done.wait()
        assert kinds[20] == ["score", "clip", "report", "done"]
        assert sum("clip" in found for found in kinds.values()) < 5

    with_compiler(tmp_path, work)


def test_a_killed_worker_is_started_again_and_does_what_it_was_doing(tmp_path: Path) -> None:
    async def work(compiler: Compiler) -> None:
        await compiler.request(job(KEY))
        answer = asyncio.create_task(compiler.request(job(f"{KEY}# other\n", 2)))
        await asyncio.sleep(0)
        assert compiler.process_id is not None
        os.kill(compiler.process_id, signal.SIGKILL)
        header, payload = await answer
        assert (header["kind"], header["number"]) == ("done", 2)
        assert payload.startswith(b"AZWC")
        assert compiler.starts == 2

    with_compiler(tmp_path, work)


def test_a_job_that_hangs_is_given_up_and_the_next_is_done(tmp_path: Path) -> None:
    async def work(compiler: Compiler) -> None:
        hanging = asyncio.create_task(compiler.request({"do": "hang"}))
        await asyncio.sleep(0)
        other = asyncio.create_task(compiler.request(job(KEY)))
        with pytest.raises(RefusedError, match="longer than"):
            await hanging
        assert (await other)[0]["kind"] == "done"

    with_compiler(tmp_path, work)


def test_too_many_jobs_are_refused(tmp_path: Path) -> None:
    async def work() -> None:
        compiler = Compiler(tmp_path, [])
        for _ in range(MOST_WAITING):
            compiler.submit({"do": "body", "client": 1}, lambda header, data: None)
        with pytest.raises(RefusedError) as refused:
            compiler.submit({"do": "body"}, lambda header, data: None)
        assert refused.value.status == 503
        compiler.forget(1)
        compiler.submit({"do": "body"}, lambda header, data: None)

    asyncio.run(work())
