"""What a page says and hears on a channel of the studio."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from playwright.sync_api import Page


class Wire:
    """The bodies of a channel's messages, in order. texts : all messages, of every channel."""

    def __init__(self, page: Page, channel: str) -> None:
        self.channel = channel
        self.said: list[dict[str, Any]] = []
        self.heard: list[dict[str, Any]] = []
        self.texts: list[str] = []
        page.on("websocket", self._join)

    def _join(self, socket: Any) -> None:
        socket.on("framesent", lambda text: self._take(text, self.said))
        socket.on("framereceived", lambda text: self._take(text, self.heard))

    def _take(self, text: str | bytes, into: list[dict[str, Any]]) -> None:
        self.texts.append(str(text))
        message = json.loads(text)
        if message["channel"] == self.channel:
            into.append(message.get("body", {}))

    def of(self, kind: str) -> list[dict[str, Any]]:
        """Return the messages of a kind, sent or received, in order."""
        return [body for body in (*self.said, *self.heard) if body.get("type") == kind]
