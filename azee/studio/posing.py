"""Drags of a page: a session of `azee.posing` for each page, in the worker that compiles.

A page opens a session at an instant of the movement that it shows, drags, lets go and asks what
could be written. It sends a drag when the one before is answered, so that none waits.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Mapping
from typing import Any

from azee.compilation import Compilation
from azee.posing.grips import morph_handles
from azee.posing.session import PosingSession
from azee.posing.text import PosedText

MOST_SESSIONS = 4
"""Of all pages together; a page whose session is gone opens it again."""
MOST_PROPOSALS = 40


class NoSessionError(Exception):
    """There is no such session any more: the worker is another, or too many pages pose."""


class Posing:
    """The sessions of pages, the newest last."""

    def __init__(self) -> None:
        self._sessions: OrderedDict[int, tuple[int, PosingSession]] = OrderedDict()

    def act(
        self, message: Mapping[str, Any], compiled: Callable[[], tuple[PosedText, Compilation]]
    ) -> dict[str, Any]:
        """Do what a page asks for and return the fields of the answer.

        Args: message: `client`, `session`, `act` and what that needs. compiled: returns the text of
            the message and its movement.
        Raises: NoSessionError. AZeeError: the text has mistakes, or nothing can be dragged so.
        """
        client, number, act = message["client"], message["session"], message["act"]
        if act == "open":
            text, made = compiled()
            session = PosingSession(text, made, message["at_s"])
            self._sessions[client] = number, session
            self._sessions.move_to_end(client)
            while len(self._sessions) > MOST_SESSIONS:
                self._sessions.popitem(last=False)
            bends, shapes = morph_handles(session.instant.evaluator)
            return {
                **_shown(session),
                "fingers": [str(handle) for handle in bends],
                "face": [str(handle) for handle in shapes],
            }
        if act == "close":
            self._sessions.pop(client, None)
            return {}
        session = self._session(client, number)
        if act == "drag":
            frame = session.drag(message["handle"], message["target"])
            return {**frame.as_json(), "grips": _grips(session)}
        if act == "release":
            session.release(message["handle"])
            return _shown(session)
        missed = [frame.summary for frame in session.drop() if frame.summary]
        found = session.proposals(message["handle"])[:MOST_PROPOSALS]
        return {
            **_shown(session),
            "missed": missed,
            "proposals": [proposal.as_json() for proposal in found],
        }

    def _session(self, client: int, number: int) -> PosingSession:
        known, session = self._sessions.get(client, (None, None))
        if session is None or known != number:
            raise NoSessionError
        self._sessions.move_to_end(client)
        return session


def _shown(session: PosingSession) -> dict[str, Any]:
    return {**session.still(), "grips": _grips(session)}


def _grips(session: PosingSession) -> list[dict[str, object]]:
    return [grip.as_json() for grip in session.grips]
