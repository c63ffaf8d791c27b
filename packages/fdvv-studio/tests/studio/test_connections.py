"""Connections that ask nothing are closed; they do not keep the owner waiting."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from pathlib import Path
from statistics import median

import httpx2
import pytest

from tests.studio.running import RunningStudio

FEW_FILES = "import resource; resource.setrlimit(resource.RLIMIT_NOFILE, (1024, 1024))"
SAID = (
    b"",
    b"GET / HTTP/1.1\r\nHost: 127.0.0.1",
    b"POST /api/jobs.list HTTP/1.1\r\nHost: a\r\nContent-Length: 1000\r\n\r\n{",
    b"\x16\x03\x01\x02\x00\x01",
)
"""Nothing, half of a head, half of a body without a token, the hello of another protocol."""


@pytest.fixture
def studio(tmp_path: Path) -> Iterator[RunningStudio]:
    found = RunningStudio(tmp_path / "project", first=FEW_FILES)
    yield found
    found.stop()


def is_closed(line: socket.socket) -> bool:
    """Read what there is, and return whether the other end has closed."""
    line.setblocking(False)
    try:
        while line.recv(4096):
            pass
    except BlockingIOError:
        return False
    except ConnectionResetError:
        pass
    return True


def trickle(line: socket.socket) -> None:
    """Send another byte of a body, as a connection does that wants to stay."""
    line.setblocking(True)
    with suppress(OSError):
        line.send(b"x")


@pytest.mark.clock
@pytest.mark.slow
def test_five_hundred_half_open_connections_are_closed_within_ten_seconds(studio: RunningStudio) -> None:
    where = studio.base.removeprefix("http://").split(":")
    times_ms = []
    with ExitStack() as stack, httpx2.Client(base_url=studio.base) as person:
        person.get("/", params={"token": studio.token})
        lines = []
        for i in range(500):
            line = stack.enter_context(socket.create_connection((where[0], int(where[1]))))
            line.sendall(SAID[i % len(SAID)])
            lines.append(line)
        until = time.monotonic() + 10.0
        while time.monotonic() < until and lines:
            begun = time.perf_counter()
            assert person.get("/").status_code == 200
            times_ms.append(1e3 * (time.perf_counter() - begun))
            lines = [line for line in lines if not is_closed(line)]
            for line in lines[2 :: len(SAID)]:
                trickle(line)
            time.sleep(0.2)
    assert not lines
    assert median(times_ms) < 200.0
    assert len(studio.stop()) < 100_000


def test_a_person_who_asks_now_and_then_is_answered_each_time(studio: RunningStudio) -> None:
    with httpx2.Client(base_url=studio.base) as person:
        person.get("/", params={"token": studio.token})
        for pause_s in (0.0, 1.0, 4.5):
            time.sleep(pause_s)
            assert person.get("/").status_code == 200
