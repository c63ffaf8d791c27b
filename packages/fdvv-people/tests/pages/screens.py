"""A participant's page, as far as the kinds of studies have it in common."""

from __future__ import annotations

import secrets
from typing import Any

from starlette.testclient import WebSocketTestSession

from tests.browser.study_screens import NAME


class Page:
    """One page on a participant's channel. heard : all of it but frames. step, card : the last of each."""

    channel = "study"

    def __init__(self, socket: WebSocketTestSession) -> None:
        self._socket, self.holder = socket, secrets.token_hex(8)
        self.heard: list[dict[str, Any]] = []
        self.step: dict[str, Any] = {}
        self.card: dict[str, Any] = {}

    def say(self, kind: str, channel: str = "", **more: Any) -> None:
        """Send an ask."""
        self._socket.send_json({"channel": channel or self.channel, "body": {"type": kind, **more}})

    def hear(self, *kinds: str) -> dict[str, Any]:
        """Return the next message of these kinds, or the first error."""
        while True:
            envelope = self._socket.receive_json()
            body = {"type": "error", **envelope} if "error" in envelope else envelope["body"]
            if body["type"] != "frame":
                self.heard.append(body)
            if body["type"] == "step":
                self.step = dict(body)
            if body["type"] in (*kinds, "error"):
                return dict(body)

    def sit(self, seat: str) -> dict[str, Any]:
        """Sit down; return the card."""
        self.say("sit", study=NAME, seat=seat, holder=self.holder, language="en")
        self.card = self.hear("card")
        self.hear("step")
        return self.card

    def resume(self, card: dict[str, Any]) -> dict[str, Any]:
        """Go on with a card; return the step, or the error."""
        self.say("resume", study=NAME, person=card["person"], code=card["code"])
        return self.hear("step")
