"""The studio as a process: it opens, ends, and says in one line why it cannot."""

from __future__ import annotations

import asyncio
import signal
import socket
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import httpx2
import pytest
from starlette.requests import Request

from fdvv.errors import InputError
from fdvv_studio.studio.contract import Call
from fdvv_studio.studio.server import address_of, answer_call, bind_socket, reachable_hosts
from fdvv_studio.studio.studio import Studio
from tests.studio.running import RunningStudio


@pytest.mark.parametrize(
    ("how", "status", "words"),
    [
        (signal.SIGINT, 0, ["Ctrl-C ends it", "the studio is closed; everything is kept"]),
        (signal.SIGTERM, -signal.SIGTERM, ["Ctrl-C ends it"]),
    ],
)
def test_it_opens_and_ends_quietly(tmp_path: Path, how: int, status: int, words: list[str]) -> None:
    studio = RunningStudio(tmp_path / "project")
    with httpx2.Client(base_url=studio.base, follow_redirects=True) as person:
        answer = person.get("/", params={"token": studio.token})
        assert answer.status_code == 200
        assert "fdvv studio" in answer.text
    said = studio.stop(how)
    assert studio.process.returncode == status
    assert said.splitlines() == words


def test_ctrl_c_during_a_long_call_ends_it_without_a_traceback(own_studio: Studio) -> None:
    begun, over = threading.Event(), threading.Event()

    def slow(_studio: Studio, _ask: dict[str, Any]) -> None:
        begun.set()
        over.wait(30)

    async def cut() -> int:
        async def receive() -> dict[str, Any]:
            return {"type": "http.request", "body": b"{}"}

        headers = [(b"content-type", b"application/json")]
        request = Request({"type": "http", "method": "POST", "headers": headers}, receive)
        answering = asyncio.create_task(answer_call(own_studio, Call("slow", dict, dict, slow), request))
        while not begun.is_set():
            await asyncio.sleep(0.01)
        answering.cancel()  # what uvicorn does once it has waited
        try:
            return (await answering).status_code
        finally:
            over.set()

    assert asyncio.run(cut()) == 503


def test_it_makes_no_project_before_something_is_kept(tmp_path: Path) -> None:
    RunningStudio(tmp_path / "project").stop()
    assert not (tmp_path / "project").exists()


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "fdvv", "studio", "--no-browser", *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=30)


def test_a_port_that_is_taken_is_refused_in_one_line(tmp_path: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        ended = run("--port", port, "--project", str(tmp_path / "p"))
    assert ended.returncode == 2
    assert ended.stderr.count("\n") == 1
    assert port in ended.stderr
    assert "another --port" in ended.stderr


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["--host", "0.0.0.0"], "--share"),
        (["--host", "example"], "is no address"),
        (["nowhere"], "nowhere"),
        (["--port", "70000"], "65535"),
    ],
)
def test_what_it_cannot_do_is_refused_in_one_line(arguments: list[str], word: str) -> None:
    ended = run(*arguments)
    assert ended.returncode == 2
    assert ended.stderr.count("\n") == 1
    assert word in ended.stderr


def test_a_studio_for_other_machines_prints_addresses_that_they_can_open() -> None:
    try:
        first, *others = reachable_hosts("0.0.0.0")
    except InputError:
        pytest.skip("this machine has no address that others could reach")
    assert first == "127.0.0.1"
    for name in others:
        # what others can reach is an address of this machine
        bind_socket(name, 0).close()
        assert f"{name}:8377" in address_of((first, *others), 8377, "").hosts
    assert reachable_hosts("127.0.0.1") == ("127.0.0.1",)


def test_what_is_answered_is_sent_at_once() -> None:
    async def delays() -> int:
        found = asyncio.get_running_loop().create_future()

        async def met(_reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            found.set_result(
                writer.get_extra_info("socket").getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)
            )
            writer.close()

        taken = bind_socket("127.0.0.1", 0)
        async with await asyncio.start_server(met, sock=taken):
            with socket.create_connection(taken.getsockname()):
                return int(await found)

    assert asyncio.run(delays()) != 0
