"""Connections of the server: those that ask nothing are closed."""

from __future__ import annotations

import asyncio
from typing import Any

from uvicorn.protocols.http.h11_impl import H11Protocol

CHECK_s = 4.0
"""A connection that begins no request between two checks is closed: within 8 s."""


class BoundedProtocol(H11Protocol):
    """HTTP on a connection that is closed unless it keeps asking.

    Uvicorn limits only the time between two requests. A connection that sends nothing, half of a head, or a
    refused body byte by byte would stay open, and each holds one of the few files that a process may have.
    """

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self._last_request: Any = None
        self.loop.call_later(CHECK_s, self._check)

    def _check(self) -> None:
        # a live connection belongs to another protocol by now
        if self.transport.is_closing() or self.transport.get_protocol() is not self:
            return
        request: Any = self.cycle
        answered = request is None or request.response_complete
        if answered and request is self._last_request:
            self.transport.abort()
            return
        self._last_request = request
        self.loop.call_later(CHECK_s, self._check)
