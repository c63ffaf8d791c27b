"""The live connection: channels that open, answer in order, fail in one line and close."""

from __future__ import annotations

import threading
from typing import Any

import msgspec
import pytest
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from fdvv.errors import ModelError
from fdvv_studio.studio.contract import ChannelKind, Tell
from tests.studio.conftest import LIVE, GivenParts


class Add(msgspec.Struct, frozen=True, tag="add", forbid_unknown_fields=True):
    """Add a number."""

    number: int


class Flood(msgspec.Struct, frozen=True, tag="flood", forbid_unknown_fields=True):
    """Send so many messages at once, from another thread."""

    count: int


class Sum(msgspec.Struct, frozen=True, tag="sum"):
    """The sum so far."""

    total: int


class Adder:
    """A channel that adds."""

    closed: threading.Event

    def __init__(self, tell: Tell) -> None:
        self.tell, self.total = tell, 0

    def receive(self, ask: Any) -> None:
        if isinstance(ask, Flood):
            threading.Thread(target=lambda: [self.tell(Sum(n)) for n in range(ask.count)]).start()
            return
        if ask.number < 0:
            raise ModelError("a number below 0")
        if ask.number == 1313:
            raise RuntimeError("a fault of ours")
        self.total += ask.number
        self.tell(Sum(self.total))

    def close(self) -> None:
        self.closed.set()


@pytest.fixture(autouse=True)
def _adder(monkeypatch: pytest.MonkeyPatch) -> None:
    Adder.closed = threading.Event()
    kind = ChannelKind("adder", (Add, Flood), (Sum,), lambda _studio, tell: Adder(tell))
    monkeypatch.setattr("fdvv_studio.studio.server.PartLoader", lambda: GivenParts({}, {"adder": kind}))


def add(number: int) -> dict[str, Any]:
    return {"channel": "adder", "body": {"type": "add", "number": number}}


def test_messages_are_taken_in_order(client: TestClient) -> None:
    with client.websocket_connect(LIVE) as live:
        for number in range(50):
            live.send_json(add(number))
        sums = [live.receive_json()["body"]["total"] for _ in range(50)]
    assert sums == [n * (n + 1) // 2 for n in range(50)]
    assert Adder.closed.wait(5)


def test_a_persons_mistake_is_one_line_and_the_channel_goes_on(client: TestClient) -> None:
    with client.websocket_connect(LIVE) as live:
        live.send_json(add(-1))
        assert live.receive_json() == {"channel": "adder", "error": "a number below 0"}
        live.send_json(add(1313))
        assert live.receive_json() == {
            "channel": "adder",
            "error": "adder failed; the studio's terminal tells why",
        }
        live.send_json(add(2))
        assert live.receive_json()["body"] == {"type": "sum", "total": 2}


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        '{"channel": "adder"}',
        '{"channel": "nothing", "body": {}}',
        '{"channel": "adder", "body": {"type": "add", "number": "x"}}',
        '{"channel": "adder", "body": {"type": "other"}}',
        '{"channel": "adder", "body": {"type": "add", "number": 1, "more": 2}}',
        "[" * 10_000,
    ],
)
def test_an_invalid_message_is_reported_and_ends_the_connection(client: TestClient, text: str) -> None:
    with client.websocket_connect(LIVE) as live:
        live.send_text(text)
        assert "error" in live.receive_json()
        with pytest.raises(WebSocketDisconnect) as over:
            live.receive_json()
        assert over.value.code == 4400


def test_what_other_threads_tell_arrives_in_their_order(client: TestClient) -> None:
    with client.websocket_connect(LIVE) as live:
        live.send_json({"channel": "adder", "body": {"type": "flood", "count": 1000}})
        assert [live.receive_json()["body"]["total"] for _ in range(1000)] == list(range(1000))
