"""The protocol of the server: every request gets an answer, also one that nobody can read."""

from __future__ import annotations

from typing import Any

from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.protocol import LanguageServerProtocol


class Protocol(LanguageServerProtocol):
    """The protocol of pygls, which only logs a request whose parameters do not fit."""

    def structure_message(self, data: dict[str, Any]) -> Any:
        """Return a message; None for a request that was answered because it cannot be read.

        Raises: JsonRpcException: a notification or an answer cannot be read.
        """
        try:
            return super().structure_message(data)
        except JsonRpcException as error:
            number, method = data.get("id"), data.get("method")
            if method is None or not isinstance(number, str | int):
                raise
            code = types.ErrorCodes.InvalidParams
            message = f"the parameters of {method} do not fit: {_innermost(error.__cause__)}"
            if not (isinstance(method, str) and self.get_message_type(method)):
                code, message = types.ErrorCodes.MethodNotFound, f"there is no method {method}"
            self._send_response(number, error=types.ResponseError(code, message))
            return None

    def handle_message(self, message: Any) -> None:
        """Handle a message, if it is one that still waits for an answer."""
        if message is not None:
            super().handle_message(message)


def _innermost(error: BaseException | None) -> str:
    """Return the first reason inside a group of errors, which names a field and its value."""
    while isinstance(error, BaseExceptionGroup):
        error = error.exceptions[0]
    return str(error) if error is not None else "they are malformed"
