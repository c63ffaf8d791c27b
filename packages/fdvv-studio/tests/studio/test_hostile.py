"""Strangers and broken programs: whatever is sent, the studio answers in one line or cuts the line.

The studio is a real process; what is sent is drawn from seeds. Counts are printed with -rP.
"""

from __future__ import annotations

import json
import random
import socket
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import httpx2
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin

from fdvv_studio.studio.parts import load_parts
from tests.studio.running import RunningStudio
from tests.studio.values import any_value, question
from tests.support.campaign import campaign

CALLS = sorted(load_parts().calls.values(), key=lambda c: c.name)
CHANNELS = sorted(load_parts().channels.values(), key=lambda c: c.name)
HEAVY = {"jobs.start"}
"""Calls that begin minutes of work; their own tests send them wrong questions."""


@pytest.fixture(scope="module")
def target(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningStudio]:
    folder = tmp_path_factory.mktemp("hostile")
    (folder / "secret.txt").write_text("nobody may read this")
    studio = RunningStudio(folder / "project")
    yield studio
    said = studio.stop()
    assert "Traceback" not in said, said


@pytest.fixture
def person(target: RunningStudio) -> Iterator[httpx2.Client]:
    headers = {"authorization": f"Bearer {target.token}", "origin": target.base}
    with httpx2.Client(base_url=target.base, headers=headers, timeout=30) as client:
        yield client
        assert client.post("/api/studio.about", json={}).status_code == 200, "the studio is gone"


def ask_all(person: httpx2.Client, rounds: int, seed: int) -> Counter[int]:
    """Send every call so many drawn questions; return how often each status came."""
    draw, found = random.Random(seed), Counter[int]()
    for call in CALLS:
        if call.name in HEAVY:
            continue
        for _ in range(rounds):
            value = question(call.ask, draw) if draw.random() < 0.8 else any_value(draw)
            body = json.dumps(value).encode()
            headers = {"content-type": "application/json"}
            answer = person.post(f"/api/{call.name}", content=body, headers=headers)
            found[answer.status_code] += 1
            assert answer.status_code in (200, 400, 422), f"{call.name} {body[:500]!r}: {answer.text}"
            assert "nobody may read this" not in answer.text
            if answer.status_code != 200:
                assert "\n" not in answer.json()["error"]
                assert "/tmp/" not in answer.json()["error"], answer.text
    return found


@campaign("seed", range(20), part=1)
def test_calls_refuse_what_they_cannot_use(person: httpx2.Client, seed: int) -> None:
    found = ask_all(person, rounds=15, seed=seed)
    sys.stdout.write(f"{found.total()} drawn questions to {len(CALLS)} calls: {dict(found)}\n")


def live(target: RunningStudio) -> ClientConnection:
    headers = {"authorization": f"Bearer {target.token}"}
    address = target.base.replace("http", "ws") + "/live"
    return connect(address, origin=Origin(target.base), additional_headers=headers, close_timeout=2)


def test_the_live_connection_cuts_off_who_sends_nonsense(
    person: httpx2.Client, target: RunningStudio
) -> None:
    draw, cut = random.Random(3), 0
    for _ in range(100):
        with live(target) as line:
            try:
                line.send(draw.choice((_nonsense(draw), draw.randbytes(draw.randrange(2000)))))
                while True:
                    reply = json.loads(line.recv(5))
                    assert "error" in reply
            except ConnectionClosed:
                cut += 1
    assert cut == 100
    sys.stdout.write(f"{cut} live connections cut off\n")


def _nonsense(draw: random.Random) -> str:
    return json.dumps({"channel": draw.choice(("studio", "x", "press", "")), "body": any_value(draw)})


def test_raw_bytes_do_not_stop_the_server(person: httpx2.Client, target: RunningStudio) -> None:
    port, draw = int(target.base.rpartition(":")[2]), random.Random(4)
    for number in range(200):
        with socket.create_connection(("127.0.0.1", port), timeout=5) as raw:
            raw.sendall(_raw(draw, number, port))
            if number % 10 == 1:
                raw.settimeout(0.5)
                with suppress(TimeoutError, ConnectionError):
                    assert b"nobody may read this" not in raw.recv(65536)
    sys.stdout.write("200 connections with raw bytes\n")


def _raw(draw: random.Random, number: int, port: int) -> bytes:
    path = draw.choice(
        ("/../secret.txt", "/..%2fsecret.txt", "//secret.txt", "/%2e%2e/secret.txt", "http://evil/", "*")
    )
    host = f"HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n"
    head = f"GET {path} {host}"
    return (
        draw.randbytes(draw.randrange(1, 3000)),
        head.encode() + b"\r\n",
        head.encode() + b"X: " + b"a" * 100_000 + b"\r\n\r\n",
        f"POST /api/studio.about {host}Content-Length: 999999999\r\n\r\n{{".encode(),
        head.encode() + b"Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: x\r\n\r\n",
    )[number % 5]


def test_who_hangs_up_in_the_middle_of_a_question_leaves_no_trace(
    person: httpx2.Client, target: RunningStudio
) -> None:
    port = int(target.base.rpartition(":")[2])
    head = f"POST /api/studio.about HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Type: application/json\r\n"
    for _ in range(20):
        with socket.create_connection(("127.0.0.1", port), timeout=5) as raw:
            raw.sendall(
                f"{head}Authorization: Bearer {target.token}\r\nContent-Length: 100\r\n\r\n{{".encode()
            )
    # that the server says nothing of it on standard error is seen when it ends


def test_a_message_beyond_the_limit_ends_the_connection(person: httpx2.Client, target: RunningStudio) -> None:
    with live(target) as line:
        line.send("x" * 3_000_000)
        with pytest.raises(ConnectionClosed):
            line.recv(10)


def test_the_project_is_not_left_by_any_name(person: httpx2.Client, target: RunningStudio) -> None:
    found = sorted(p.name for p in Path(target.project).parent.iterdir())
    assert set(found) <= {"project", "secret.txt"}
