"""Who may come in, and what a message may be."""

from __future__ import annotations

import contextlib
import json
import signal
import socket
import stat
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from fdvv.errors import InputError
from fdvv_campaigns.serve.server import check_origin, serve
from fdvv_studio.studio.studio import Studio
from tests.serve.conftest import PAGE
from tests.serve.running import DIRECT, Client, RefusedCall, RunningServer
from tests.support.checkout import REPOSITORY


@pytest.mark.parametrize("token", ["", "wrong", "é" * 20])
def test_nothing_is_answered_without_the_token(server: RunningServer, token: str) -> None:
    with pytest.raises(RefusedCall, match="is not this server's"):
        Client(server, token)
    firsts: tuple[Any, ...] = ({"id": 1, "call": "clock"}, {"id": 1, "call": "optimize.ask", "run": "a"}, [])
    for first in firsts:
        with connect(server.address, **DIRECT) as stranger:
            stranger.send(json.dumps(first))
            assert "error" in json.loads(stranger.recv(10))
            with pytest.raises(ConnectionClosed):
                stranger.recv(10)


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "http://localhost:8001", PAGE + "/", "HTTP://LOCALHOST"]
)
def test_a_page_of_an_origin_that_is_not_named_is_refused(server: RunningServer, origin: str) -> None:
    with pytest.raises(InvalidStatus) as refused:
        Client(server, origin=origin)
    assert refused.value.response.status_code == 403


def test_a_page_whose_origin_is_named_comes_in(server: RunningServer) -> None:
    Client(server, origin=PAGE).close()


def test_a_name_of_another_site_that_points_here_is_refused(server: RunningServer) -> None:
    with socket.create_connection(("127.0.0.1", server.port)) as line:
        head = "GET /fdvv HTTP/1.1\r\nHost: evil.example\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        line.sendall(f"{head}Sec-WebSocket-Key: {'A' * 22}==\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
        assert b" 403 " in line.recv(4096).splitlines()[0]


def test_only_this_machine_is_listened_to_and_only_its_owner_reads_the_token(server: RunningServer) -> None:
    assert server.address.startswith("ws://127.0.0.1:")
    path = server.project / "serve" / ".serve-token"
    assert path.read_text() == server.token
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert ".serve-token" in (path.parent / ".gitignore").read_text()


def test_a_token_that_others_can_read_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "project" / "serve"
    folder.mkdir(parents=True)
    (folder / ".serve-token").write_text("x" * 32)
    (folder / ".serve-token").chmod(0o644)
    with pytest.raises(InputError, match="others on this machine can read it"):
        serve(Studio(folder.parent), 0, (), (), lambda _address, _token: None)


@pytest.mark.parametrize("origin", ["null", "*", "file://", "localhost:8000", "http://localhost:8000/page"])
def test_an_origin_that_no_page_of_a_server_has_is_refused(origin: str) -> None:
    with pytest.raises(InputError, match="is no origin of a page"):
        check_origin(origin)


@pytest.mark.parametrize(
    ("text", "number", "place"),
    [
        ('{"id": 7, "call": "clock", "more": 1}', 7, "whole message"),
        ('{"id": 7, "call": "nothing"}', 7, "$.call"),
        ('{"id": -1, "call": "clock"}', None, "$.id"),
        ('{"call": "clock"}', None, "whole message"),
        ('{"id": 7, "call": "optimize.tell", "run": "a", "trial": 0, "score": NaN}', None, "whole message"),
        ('{"id": 7, "call": "optimize.tell", "run": "a", "trial": 0, "score": 1e999}', 7, "$.score"),
        ('{"id": 7, "call": "optimize.tell", "run": "a", "trial": 0, "score": "1"}', 7, "$.score"),
        ('{"id": 7, "call": "hello", "token": "x"}', 7, "call"),
        ("[" * 100_000, None, "whole message"),
        ("", None, "whole message"),
        ('{"id": 7', None, "whole message"),
    ],
)
def test_a_message_that_is_none_is_refused_and_the_next_one_is_answered(
    client: Client, text: str, number: int | None, place: str
) -> None:
    client.socket.send(text)
    refused = client.receive()
    assert refused["id"] == number
    assert refused["error"]["place"] == place
    assert client.call("clock")["host_s"] == pytest.approx(time.monotonic(), abs=5.0)


def test_a_message_that_is_too_large_ends_the_connection(server: RunningServer, client: Client) -> None:
    client.socket.send(json.dumps({"id": 1, "call": "hello", "token": "x" * 3_000_000}))
    with pytest.raises(ConnectionClosed):
        client.receive()
    Client(server).close()


def test_more_calls_than_may_wait_are_refused(client: Client, run: str) -> None:
    parameters = [{"name": "a", "low": 0.0, "high": 1.0}]
    client.call("optimize.begin", run=run, parameters=parameters, engine="sobol")
    last = [client.send("optimize.ask", run=run) for _ in range(200)]
    answers = [client.receive() for _ in last]
    assert sorted(m["id"] for m in answers) == last
    assert {m["error"]["reason"] for m in answers if "error" in m} <= {"64 calls are waiting"}


def test_another_protocol_is_refused_with_what_to_do(server: RunningServer) -> None:
    with connect(server.address, **DIRECT) as client:
        client.send(json.dumps({"id": 1, "call": "hello", "token": server.token, "protocol": 2}))
        assert "fdvv serve --client" in json.loads(client.recv(10))["error"]["remedy"]


@pytest.mark.clock
@pytest.mark.slow
def test_a_stranger_who_says_nothing_is_sent_away(server: RunningServer) -> None:
    silent = socket.create_connection(("127.0.0.1", server.port))
    host = f"Host: 127.0.0.1:{server.port}"
    head = f"GET /fdvv HTTP/1.1\r\n{host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    silent.sendall(f"{head}Sec-WebSocket-Key: {'A' * 22}==\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
    silent.settimeout(8.0)
    began_s, received = time.monotonic(), b""
    while b"say hello first" not in received:
        received += silent.recv(4096)
    assert time.monotonic() - began_s > 4.0
    silent.close()


HANGS = """
import sys
from types import SimpleNamespace
from tests.serve.running import Client
client = Client(SimpleNamespace(address=sys.argv[1], token=sys.argv[2]))
client.call("device.open", device="twin")
print("open", flush=True)
sys.stdin.read()
"""


@pytest.mark.clock
@pytest.mark.slow
def test_an_owner_that_hangs_loses_the_device(server: RunningServer, client: Client) -> None:
    """It answers no ping: after 8 s at most it is taken as gone."""
    command = [sys.executable, "-c", HANGS, server.address, server.token]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=REPOSITORY) as owner:
        assert owner.stdout is not None
        owner.stdout.readline()
        owner.send_signal(signal.SIGSTOP)
        began_s, held = time.monotonic(), True
        while held:
            assert time.monotonic() - began_s < 12.0
            with contextlib.suppress(RefusedCall):
                client.call("device.open", device="twin")
                held = False
            time.sleep(0.1)
        owner.kill()


def test_hello_says_what_there_is(client: Client) -> None:
    there = {word for key in ("engines", "devices", "buttons", "programs") for word in client.welcome[key]}
    assert there >= {"gp", "twin", "host", "mx-clear", "rapid-trigger"}
    assert client.welcome["protocol"] == 1
